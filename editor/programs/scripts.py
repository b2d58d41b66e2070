"""A program's script, edited: what drawing its program would be. Nothing is changed by it; browsers apply the rest."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any
from uuid import UUID

from editor.documents import work
from editor.documents.store import get_document
from editor.errors import EditorError
from editor.programs.checking import build_surroundings
from editor.programs.drawn_script import Drawing, DrawnScript
from editor.programs.programs import get_program

LONGEST_SCRIPT = 400_000


class ScriptTooLong(EditorError):
    """The text is longer than any program."""

    code = "script_too_long"
    status = 413


def draw_script(
    *, program_id: UUID | str, text: str, base: Mapping[str, Any] | None = None, shown: str | None = None
) -> DrawnScript:
    """Draw a script over a document, which is the program's own where none is given.

    `shown` is the script from which the text was edited; when the base prints otherwise, nothing is drawn.
    Raises NoSuchProgram, ScriptTooLong.
    """
    if len(text) > LONGEST_SCRIPT:
        raise ScriptTooLong(f"A script has at most {LONGEST_SCRIPT:,} characters. Make functions, or two programs.")
    surroundings = build_surroundings(site=get_program(program_id=program_id).site)
    document = get_document(program_id=program_id) if base is None else dict(base)
    size = max(work.size_of(document), text.count("\n"))
    return work.do(Drawing(document, surroundings, text, shown), size)
