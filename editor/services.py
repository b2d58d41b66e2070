"""What the other apps may ask of the editor; everything else in this app is its own affair."""

from editor.comments.mail import COMMENT_MAIL
from editor.comments.threads import Moment, Words, start_thread_at
from editor.documents.repair import Mending, mend_program, restore_rows, show_mending
from editor.documents.store import Change, get_document
from editor.errors import BadRequest, EditorError, NoSuchProgram, NotApproved
from editor.library.functions import Said, change_function, save_function
from editor.library.queries import LibraryView, get_function, search_library
from editor.library.seeds import seed_library
from editor.library.updates import get_updated_content
from editor.programs.checking import build_surroundings, find_zones, zone_facts
from editor.programs.contents import (
    ContentView,
    VersionToTestView,
    compile_content,
    find_numbers,
    get_content,
    has_versions_to_test,
    list_versions_to_test,
    lock_program,
    take_version_to_test,
)
from editor.programs.drawn_script import DrawnScript
from editor.programs.floor_use import ProgramTrouble, list_program_troubles
from editor.programs.one_line import ExpressionView, print_expression, read_expression
from editor.programs.programs import (
    create_program,
    delete_program,
    get_compiled,
    get_program,
    keep_existing,
    list_programs,
    rename_program,
    seed_programs,
)
from editor.programs.scripts import draw_script
from editor.programs.versions import (
    compile_version,
    compile_version_to_json,
    find_misfit,
    find_version,
    get_version,
    list_versions,
    name_version,
    pin_version,
)
from editor.programs.views import AuthorView, ProgramView, VersionView, WholeVersionView
from editor.reviews.gate import Permit, admit_start, is_admitted

__all__ = [
    "COMMENT_MAIL",
    "AuthorView",
    "BadRequest",
    "Change",
    "ContentView",
    "DrawnScript",
    "EditorError",
    "ExpressionView",
    "LibraryView",
    "Mending",
    "Moment",
    "NoSuchProgram",
    "NotApproved",
    "Permit",
    "ProgramTrouble",
    "ProgramView",
    "Said",
    "VersionToTestView",
    "VersionView",
    "WholeVersionView",
    "Words",
    "admit_start",
    "build_surroundings",
    "change_function",
    "compile_content",
    "compile_version",
    "compile_version_to_json",
    "create_program",
    "delete_program",
    "draw_script",
    "find_misfit",
    "find_numbers",
    "find_version",
    "find_zones",
    "get_compiled",
    "get_content",
    "get_document",
    "get_function",
    "get_program",
    "get_updated_content",
    "get_version",
    "has_versions_to_test",
    "is_admitted",
    "keep_existing",
    "list_program_troubles",
    "list_programs",
    "list_versions",
    "list_versions_to_test",
    "lock_program",
    "mend_program",
    "name_version",
    "pin_version",
    "print_expression",
    "read_expression",
    "rename_program",
    "restore_rows",
    "save_function",
    "search_library",
    "seed_library",
    "seed_programs",
    "show_mending",
    "start_thread_at",
    "take_version_to_test",
    "zone_facts",
]
