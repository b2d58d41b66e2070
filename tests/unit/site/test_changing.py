"""docs/changing.md names files that exist, and no table lacks a kind of step."""

import json
import re
from dataclasses import fields
from pathlib import Path
from typing import get_args

from editor.language import compile_document, parse_script
from editor.language.checks.checks import CHECKS
from editor.language.document.outline import BRANCHES, COMMENT
from editor.language.drawing.steps import ENCODERS
from editor.language.expressions.names import snake_case
from editor.language.plan.compiler import COMPILERS
from editor.language.plan.instructions import Action
from editor.language.plan.json_form import ACTIONS
from editor.language.printing.steps import PRINTERS
from editor.language.reading.steps import READERS
from editor.language.tree.nodes import COMPOSITES, Node
from editor.language.tree.variables import VALUES
from editor.shapes import StepKind
from scripts.checks_page import read_site
from scripts.construct_programs import pictures
from vipo_device.descriptions.forms import FORMS
from vipo_site.cli.describe import _NAMES as FORM_NAMES

ROOT = Path(__file__).resolve().parents[3]
PAGE = ROOT / "docs" / "changing.md"
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


def kinds_of(nodes):
    """Return what the kinds of steps would be called that are drawn from these nodes; Python's own words end in `_`."""
    return {snake_case(node.__name__).removesuffix("_") for node in nodes}


def fields_with(types):
    """Return the nodes that have a field of one of these types, as their annotations name them."""
    return {node for node in NODES if any(re.search(types, str(field.type)) for field in fields(node))}


def test_every_kind_stands_in_every_table_of_the_language():
    nodes = kinds_of(NODES)
    assert [
        *lacking("READERS in editor/language/reading/steps.py", KINDS - {"on_event"}, READERS),
        *lacking("Node in editor/language/tree/nodes.py", KINDS - {"pick_and_drop", "on_event"}, nodes),
        *lacking("PRINTERS in editor/language/printing/steps.py", nodes, kinds_of(PRINTERS)),
        *lacking("ENCODERS in editor/language/drawing/steps.py", nodes, kinds_of(ENCODERS)),
        *lacking("CHECKS in editor/language/checks/checks.py", nodes, kinds_of(CHECKS)),
        *lacking("COMPILERS in editor/language/plan/compiler.py", nodes, kinds_of(COMPILERS)),
        *lacking("COMPOSITES in editor/language/tree/nodes.py", kinds_of(fields_with("Block")), kinds_of(COMPOSITES)),
        *lacking(
            "VALUES in editor/language/tree/variables.py",
            kinds_of(fields_with("Expression|PlaceRef|Arguments")),
            kinds_of(VALUES),
        ),
    ] == []


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
    shape = (ROOT / "docs" / "shapes" / "document.md").read_text()
    images = {path.stem for path in (ROOT / "docs" / "language" / "images").glob("*.png")}
    assert [
        *lacking("tests/cases", KINDS, re.findall(r'"kind": ?"(\w+)"', cases)),
        *lacking("docs/language/README.md", DRAWN, re.findall(r"\(images/(\w+)\.png\)", manual)),
        *lacking("docs/language/images", DRAWN, images),
        *lacking("docs/shapes/document.md", DRAWN, re.findall(r"`(\w+)`", shape[: shape.index("`role` defaults")])),
    ] == []


def names_in(file, begin, end, pattern):
    """Return what a pattern finds in the part of a file of the frontend between two marks."""
    text = (FRONTEND / file).read_text()
    start = text.index(begin)
    return re.findall(pattern, text[start : text.index(end, start)], re.MULTILINE)


def test_every_kind_stands_in_every_table_of_the_browser():
    key = r"^  (\w+)(?::|,)"
    tables = {
        "StepKind in editor/shapes.py": get_args(StepKind.__value__),
        "LOOKS in program/kinds.ts": names_in("program/kinds.ts", "LOOKS:", "};", key),
        "WRITERS in program/words/stepWords.ts": names_in("program/words/stepWords.ts", "WRITERS:", "};", key),
        "FORMS in editor/inspector/Inspector.tsx": names_in("editor/inspector/Inspector.tsx", "FORMS:", "};", key),
    }
    for language in ("en", "de"):
        words = json.loads((FRONTEND / "i18n" / language / "editor.json").read_text())
        tables |= {f"{part} in i18n/{language}/editor.json": words[part] for part in ("kind", "about")}
    missing = [sentence for table, found in tables.items() for sentence in lacking(table, DRAWN, found)]
    icons = names_in("program/kinds.ts", "LOOKS:", "};", r'icon: "(\w+)"')
    assert [*missing, *lacking("icons", icons, (path.stem for path in (FRONTEND / "icons").glob("*.svg")))] == []


def test_every_form_of_a_description_has_its_names():
    catalogues = {
        language: json.loads((FRONTEND / "i18n" / language / "pages.json").read_text())["devices"]["form"]
        for language in ("en", "de")
    }
    tables = {"_NAMES in vipo_site/cli/describe.py": FORM_NAMES}
    tables |= {f"devices.form in i18n/{language}/pages.json": words for language, words in catalogues.items()}
    assert [sentence for table, found in tables.items() for sentence in lacking(table, FORMS, found)] == []
