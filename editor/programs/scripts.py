"""A program's script, edited: what drawing its program would be. Nothing is changed by it; browsers apply the rest."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any
from uuid import UUID

from editor.documents.store import get_document
from editor.errors import EditorError
from editor.language import Diagnostic, compile_document, parse_script, tree_to_document
from editor.language.messages.phrases import LANGUAGES, Refusal
from editor.programs.checking import build_surroundings
from editor.programs.programs import get_program
from vipo_device.protocol.texts import cleaned_json

LONGEST_SCRIPT = 400_000
_POSITION_ARGUMENTS = ("end_line", "end_column", "found", "instead")


class ScriptTooLong(EditorError):
    """The text is longer than any program."""

    code = "script_too_long"
    status = 413


@dataclass(frozen=True, slots=True)
class DrawnScript:
    """What a script came to.

    `document` is None while the text leaves the language, or when `stale`: the base document does not print as the
    script that was shown. `script` is then the base's script, else the new document's; `lines` has the step of each
    of its lines.
    """

    ok: bool
    stale: bool
    document: dict[str, Any] | None
    script: str
    lines: tuple[str, ...]
    diagnostics: tuple[dict[str, Any], ...] = ()


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
    before = compile_document(document, surroundings)
    if shown is not None and shown != before.script:
        return DrawnScript(False, True, None, before.script, before.lines)
    parsed = parse_script(text, surroundings)
    if parsed.tree is None:
        found = tuple(diagnostic_shape(diagnostic) for diagnostic in parsed.diagnostics)
        return DrawnScript(False, False, None, before.script, before.lines, found)
    drawn = cleaned_json(tree_to_document(parsed.tree, surroundings, document))
    after = compile_document(drawn, surroundings)
    return DrawnScript(True, False, drawn, after.script, after.lines)


def diagnostic_shape(diagnostic: Diagnostic) -> dict[str, Any]:
    """Return where a script leaves the language, as JSON."""
    details = {name: diagnostic.args.get(name) for name in _POSITION_ARGUMENTS}
    expected = str(details["instead"] or diagnostic.args.get("detail", ""))
    return {
        "code": diagnostic.code,
        "line": diagnostic.line or 1,
        "column": diagnostic.column or 1,
        "end_line": details["end_line"],
        "end_column": details["end_column"],
        "message": diagnostic.message,
        "messages": diagnostic.messages,
        "found": str(details["found"] or ""),
        "expected": expected,
        "hints": {language: Refusal(expected).say(language) for language in LANGUAGES},
    }
