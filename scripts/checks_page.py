"""docs/language/checks.md, written from the code: `python -m scripts.checks_page > docs/language/checks.md`."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from textwrap import dedent
from typing import Any

import numpy as np

from editor.language.compiler import compile_document
from editor.language.messages.de import FIX_TEXTS_DE, TEXTS_DE
from editor.language.messages.diagnostics import Diagnostic
from editor.language.messages.en import FIX_TEXTS, NOT_NOW, TEXTS
from editor.language.parsing.script import parse_script
from editor.language.site.json_form import surroundings_from_json
from editor.language.site.surroundings import DeviceFacts, FloorFacts, Surroundings
from registry.floorplan.plan import FREE, OCCUPIED, FloorPlan, Grid
from scripts.check_explanations import EXPLANATIONS, GROUPS
from vipo_device.protocol.description import description_from_json, description_to_json

ROOT = Path(__file__).resolve().parents[1]
CASES = ROOT / "tests" / "cases" / "checks"
SITE = ROOT / "examples" / "painting-factory.json"
RESOLUTION_M = 0.1
LONGEST_EXCERPT = 14
_HEAD = """# The checks

This page is written from the code (`make checks-page`). Every check has a code, a severity and one sentence in each
language of the screens; where one click helps, a fix. Errors keep a program from running, never from being edited.
Most hold until the program changes; those marked *for now* hold only as the site is at present.

The examples are the programs of [tests/cases/checks](../../tests/cases/checks) in the painting factory: the first
is told of, the second is not.
"""


@dataclass(frozen=True, slots=True)
class Case:
    """What the checks say of one example."""

    script: str
    diagnostics: tuple[Diagnostic, ...]
    note: str = ""
    """What the script does not show."""

    def tells(self, code: str) -> list[Diagnostic]:
        """Return the diagnostics with that code."""
        return [diagnostic for diagnostic in self.diagnostics if diagnostic.code == code]


def read_case(code: str, kind: str, site: Surroundings) -> Case:
    """Return what comes of the example `<code>.<kind>.json`; kind is bad or good."""
    body = json.loads((CASES / f"{code}.{kind}.json").read_text(encoding="utf-8"))
    changed, note = _site_of(body, site), body.get("note", "")
    if "script" in body:
        return Case(body["script"], parse_script(body["script"], changed).diagnostics, note)
    compiled = compile_document(body["document"], changed)
    return Case(compiled.script, compiled.diagnostics, note)


def _site_of(body: Mapping[str, Any], site: Surroundings) -> Surroundings:
    devices = {name: _changed(site.devices[name], facts) for name, facts in body.get("devices", {}).items()}
    library = surroundings_from_json(body).library if "library" in body else None
    known = {**site.devices, **devices}
    return replace(site, devices=known, library=library, floor=_floor(body.get("floor"), known))


def _changed(facts: DeviceFacts, change: Mapping[str, Any]) -> DeviceFacts:
    given = dict(change)
    body = description_to_json(facts.description)
    silent = {*given.pop("silent", []), *(each["name"] for each in given.get("reports", []))}
    told = [each for each in body["properties"] if each["name"] not in silent] + given.pop("reports", [])
    said = description_from_json({**body, "properties": told, "methods": given.pop("with", [])})
    others = said.methods
    without = [*given.pop("without", []), *(method.name for method in others)]
    methods = (*(method for method in facts.description.methods if method.name not in without), *others)
    return replace(facts, description=replace(said, methods=methods), **given)


def _floor(body: Mapping[str, Any] | None, devices: Mapping[str, DeviceFacts]) -> FloorFacts | None:
    """Return a hall with its corner at (0, 0), `size` metres to the right and down, with boxes as walls."""
    if body is None:
        return None
    width, height = (round(length / RESOLUTION_M) for length in body["size"])
    cells = np.full((height, width), FREE, dtype=np.uint8)
    for left, bottom, right, top in body["walls"]:
        rows = slice(height + round(bottom / RESOLUTION_M), height + round(top / RESOLUTION_M))
        cells[rows, round(left / RESOLUTION_M) : round(right / RESOLUTION_M)] = OCCUPIED
    machines = [facts.description for facts in devices.values() if facts.description.kind == "machine"]
    return FloorPlan(Grid(width, height, RESOLUTION_M, 0.0, -body["size"][1], cells.tobytes()), machines)


def read_site() -> Surroundings:
    """Return the painting factory of the examples, without its map."""
    return surroundings_from_json(json.loads(SITE.read_text(encoding="utf-8")))


def write_page() -> str:
    """Return the whole page."""
    site = read_site()
    parts = [_HEAD]
    for title, codes in GROUPS:
        parts.append(f"\n## {title}\n")
        parts.extend(_section(code, site) for code in codes)
    return "".join(parts)


def _section(code: str, site: Surroundings) -> str:
    severity, english = TEXTS[code]
    bad, good = read_case(code, "bad", site), read_case(code, "good", site)
    lines = [
        f"\n### `{code}`",
        f"{severity.capitalize()}{', *for now*' if code in NOT_NOW else ''}. {EXPLANATIONS[code]}",
        "",
        f"- English: {english}",
        f"- Deutsch: {TEXTS_DE[code]}",
    ]
    fixes = dict.fromkeys(d.fix.label_code for d in bad.tells(code) if d.fix is not None)
    lines.extend(f"- Fix: {FIX_TEXTS[fix]} · {FIX_TEXTS_DE[fix]}" for fix in fixes)
    said = next((diagnostic.message for diagnostic in bad.tells(code)), "")
    told = [*_excerpt(bad, f"“{said}” is told here"), *_excerpt(good, "Nothing is told here")]
    return "\n".join([*lines, "", *told]) + "\n"


def _excerpt(case: Case, title: str) -> Iterator[str]:
    lines = _methods(case.script)
    yield f"{title}{'. ' + case.note if case.note else ':'}"
    yield "```python"
    yield from lines[:LONGEST_EXCERPT]
    if len(lines) > LONGEST_EXCERPT:
        yield "    …"
    yield "```"


def _methods(script: str) -> list[str]:
    """Return the methods of a script without the class around them and, where it says nothing else, without `run`."""
    inner = dedent("\n".join(script.splitlines()[1:])).splitlines()
    end = next((index for index, line in enumerate(inner) if line.startswith("def run(")), len(inner))
    return [line for line in inner[:end] if line]


def main() -> None:
    """Write the page to standard output."""
    sys.stdout.write(write_page())


if __name__ == "__main__":
    main()
