"""docs/changing.md names files that exist, and no table lacks a kind of step."""

import json
import re
from typing import get_args

import pytest

from editor.language import compile_document, parse_script
from editor.language.checks.checks import CHECKS
from editor.language.constructs.json_form import write_constructs
from editor.language.constructs.record import Construct, Field, Form, Look
from editor.language.constructs.table import COMMENT, CONSTRUCTS, FORMS
from editor.language.document.outline import BRANCHES
from editor.language.drawing.steps import ENCODERS
from editor.language.plan.compiler import COMPILERS
from editor.language.plan.instructions import Action
from editor.language.plan.json_form import ACTIONS
from editor.language.printing.steps import PRINTERS
from editor.language.reading.steps import READERS
from editor.language.tree.nodes import Node
from registry.alerts.causes import CAUSES
from registry.api.devices import show_rdf
from scripts.checks_page import read_site
from scripts.construct_programs import pictures
from tests.kit.files import ROOT
from vipo_device.descriptions.forms import FORMS as DESCRIPTION_FORMS
from vipo_device.descriptions.forms import DescriptionForm
from vipo_site.management.commands import constructs

PAGE = ROOT / "docs" / "changing.md"
PROTOCOL = ROOT / "docs" / "protocol.md"
FRONTEND = ROOT / "frontend" / "src"
KINDS = frozenset(BRANCHES)
NODES = frozenset(get_args(Node))
DRAWN = KINDS | {COMMENT}


def test_every_path_of_the_page_exists():
    named = [name for name in re.findall(r"`([^`\s]+)`", PAGE.read_text()) if re.fullmatch(r"[\w.*/-]+/[\w.*-]+", name)]
    assert len(named) > 80
    assert [name for name in named if not [*ROOT.glob(name)]] == []


def lacking(table, wanted, found):
    """Return a sentence for each kind of step that a table lacks."""
    return [f"{table} lacks “{kind}”" for kind in sorted(set(wanted) - set(found))]


def test_a_table_that_lacks_a_kind_is_named_with_the_kind():
    assert lacking("READERS", {"move", "pick"}, {"pick"}) == ["READERS lacks “move”"]


def names_of(nodes):
    """Return the names of some classes of nodes."""
    return {node.__name__ for node in nodes}


def code_lacking():
    """Return a sentence for each construct that lacks code of its own."""
    nodes = frozenset(FORMS)
    told = {node for node, (_, form) in FORMS.items() if any(field.type != "role" for field in form.fields)}
    return [
        *lacking("Node in editor/language/tree/nodes.py", nodes - {"Event"}, names_of(NODES)),
        *lacking("CHECKS in editor/language/checks/checks.py", told - {"Event"}, names_of(CHECKS)),
        *lacking("COMPILERS in editor/language/plan/compiler.py", nodes - {"Event"}, names_of(COMPILERS)),
        *lacking("_OWN in editor/language/reading/steps.py", KINDS - {"on_event"}, READERS),
        *lacking("_OWN in editor/language/drawing/steps.py", nodes, names_of(ENCODERS)),
        *lacking("script in editor/language/constructs/table.py", nodes - {"Event"}, names_of(PRINTERS)),
        *lacking("editor/language/constructs/table.py", names_of(NODES), nodes),
    ]


def test_every_construct_of_the_table_has_the_code_that_is_its_own():
    assert code_lacking() == []


def test_what_the_records_are_written_into_is_up_to_date():
    renew = "run `make constructs` and commit what it writes"
    assert constructs.FILE.read_text() == write_constructs(), renew
    assert constructs.UNIT_SIGNS.read_text(encoding="utf-8") == constructs.write_units(), renew
    assert constructs.PAGE.read_text() == constructs.with_table(constructs.PAGE.read_text()), renew


def test_every_kind_has_a_program_that_is_printed_and_parsed_again():
    parsed = set()
    for name, picture in pictures().items():
        compiled = compile_document(picture.document(), read_site())
        if parse_script(compiled.script, read_site()).tree == compiled.tree:
            parsed |= {step["kind"] for step in picture.steps.values()} & {name}
    assert lacking("editor/language/parsing/steps.py, or scripts/construct_programs.py,", KINDS, parsed) == []


def test_every_instruction_has_its_json_and_a_place_in_the_run_machine():
    names = {action.__name__ for action in get_args(Action)}
    machine = "".join(path.read_text() for path in sorted((ROOT / "execution" / "machine").glob("*.py")))
    assert [
        *lacking("ACTIONS in editor/language/plan/json_form.py", names, ACTIONS),
        *lacking("execution/machine", names, re.findall(r"\bp\.([A-Z]\w+)", machine)),
    ] == []


def test_every_kind_has_a_case_a_section_and_a_picture():
    cases = "".join(path.read_text() for path in sorted((ROOT / "tests" / "cases").rglob("*.json")))
    manual = (ROOT / "docs" / "language" / "README.md").read_text()
    images = {path.stem for path in (ROOT / "docs" / "language" / "images").glob("*.png")}
    assert [
        *lacking("tests/cases", KINDS, re.findall(r'"kind": ?"(\w+)"', cases)),
        *lacking("docs/language/README.md", DRAWN, re.findall(r"\(images/(\w+)\.png\)", manual)),
        *lacking("docs/language/images", DRAWN, images),
    ] == []


def worded(construct):
    """Return the words that the editor needs for a construct, by their keys in the catalogue."""
    fields = [field for field in construct.fields if field.type in {"place", "value", "variable", "choice", "text"}]
    own = re.search(r"FORMS.*?};", (FRONTEND / "editor/inspector/forms/StepForm.tsx").read_text(), re.DOTALL)
    keys = {f"kind.{construct.kind}", f"about.{construct.kind}"}
    if not re.search(rf"^  {construct.kind}: ", own[0], re.MULTILINE):
        labelled = [field for field in fields if field.wanted != "boolean"]
        keys |= {f"form.{construct.kind}.{field.name}" for field in labelled}
        keys |= {f"form.{construct.kind}.{choice}" for field in fields for choice in field.choices}
        keys |= {f"form.{construct.kind}.{one}_means" for field in fields if field.explained for one in field.choices}
    if construct.kind not in SAID_BY_OTHERS:
        keys |= {
            f"chip.{construct.kind}",
            *(f"chip.{construct.kind}_{form.marked_by}" for form in construct.forms[:-1]),
        }
    return keys


SAID_BY_OTHERS = {"operate", "call"}
"""A device or a function says what stands on their chips."""


def keys_of(words, before=""):
    """Return the keys of a catalogue, as `chip.move`."""
    for name, value in words.items():
        yield from keys_of(value, f"{before}{name}.") if isinstance(value, dict) else [before + name]


def words_lacking():
    """Return a sentence for each word and symbol that a construct lacks."""
    wanted = {key for construct in CONSTRUCTS.values() for key in worded(construct)}
    catalogues = {
        f"frontend/src/i18n/{language}/editor.json": [
            *keys_of(json.loads((FRONTEND / "i18n" / language / "editor.json").read_text()))
        ]
        for language in ("en", "de")
    }
    icons = [construct.look.icon for construct in CONSTRUCTS.values()]
    return [
        *(sentence for file, found in catalogues.items() for sentence in lacking(file, wanted, found)),
        *lacking("frontend/src/icons", icons, (path.stem for path in (FRONTEND / "icons").glob("*.svg"))),
    ]


def test_every_construct_has_its_words_and_its_symbol():
    assert words_lacking() == []


def test_what_a_new_construct_lacks_is_named_with_the_file(monkeypatch):
    form = Form("Beep", (Field("times", wanted="number"),), "self.beep(times)")
    beep = Construct("beep", (form,), Look("beep", "machine", "pill"))
    monkeypatch.setitem(CONSTRUCTS, "beep", beep)
    monkeypatch.setitem(FORMS, "Beep", (beep, form))
    assert words_lacking() + code_lacking() == LACKED_BY_BEEP


LACKED_BY_BEEP = [
    *(
        f"frontend/src/i18n/{language}/editor.json lacks “{part}.beep{field}”"
        for language in ("en", "de")
        for part, field in (("about", ""), ("chip", ""), ("form", ".times"), ("kind", ""))
    ),
    "frontend/src/icons lacks “beep”",
    "Node in editor/language/tree/nodes.py lacks “Beep”",
    "CHECKS in editor/language/checks/checks.py lacks “Beep”",
    "COMPILERS in editor/language/plan/compiler.py lacks “Beep”",
    "_OWN in editor/language/drawing/steps.py lacks “Beep”",
    "script in editor/language/constructs/table.py lacks “Beep”",
]


def test_a_new_step_means_at_most_ten_files():
    page = PAGE.read_text()
    table = page[page.index("## A kind of step") : page.index("## A form of descriptions")]
    always = [row for row in table.splitlines() if row.startswith("| `") and "| only if" not in row]
    assert 8 <= sum(len(re.findall(r"`[\w.*/-]+/[\w.*-]+`", row.split("|")[1])) for row in always) <= 10


def test_every_form_of_a_description_has_its_names():
    catalogues = {
        language: json.loads((FRONTEND / "i18n" / language / "screens" / "pages.json").read_text())["devices"]["form"]
        for language in ("en", "de")
    }
    tables = {
        "FORMS in vipo_device/descriptions/forms.py": DESCRIPTION_FORMS,
        "the docstring of show_rdf in registry/api/devices.py": re.findall(r"`([\w-]+)`", show_rdf.__doc__),
        "the table of forms in docs/protocol.md": re.findall(r"(?m)^\| `([\w-]+)`: ", PROTOCOL.read_text()),
    }
    tables |= {f"devices.form in i18n/{language}/screens/pages.json": words for language, words in catalogues.items()}
    forms = get_args(DescriptionForm)
    assert [sentence for table, found in tables.items() for sentence in lacking(table, forms, found)] == []


def test_the_words_by_which_the_library_finds_steps_are_those_of_the_editor():
    assert constructs.WORDS.read_text() == constructs.write_words()
    assert set(json.loads(constructs.WORDS.read_text())) >= DRAWN


@pytest.mark.parametrize("language", ["en", "de"])
def test_each_reason_to_wait_has_its_sentence_in_every_language(language):
    traffic = "".join(path.read_text() for path in sorted((ROOT / "execution" / "traffic").glob("*.py")))
    codes = re.findall(r"""\.wait\(\s*task,\s*"(\w+)\"""", traffic)
    words = json.loads((FRONTEND / "i18n" / language / "run.json").read_text())["waits"]
    assert len(codes) > 10
    assert lacking(f"waits in i18n/{language}/run.json", codes, words) == []


@pytest.mark.parametrize("language", ["en", "de"])
def test_each_alert_has_its_sentence_on_pages_and_those_for_viewers_on_wall_screens(language):
    words = FRONTEND / "i18n" / language
    on_pages = json.loads((words / "alerts.json").read_text())["what"]
    on_walls = json.loads((words / "screens" / "wall.json").read_text())["what"]
    assert lacking("alerts.json", CAUSES, on_pages) == []
    assert lacking("wall.json", [code for code, cause in CAUSES.items() if cause.role == "viewer"], on_walls) == []
