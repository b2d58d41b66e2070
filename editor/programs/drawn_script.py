"""A script drawn over a document: what its program would be. Pure."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from editor.language import Diagnostic, Surroundings, compile_document, parse_script, tree_to_document
from editor.language.messages.phrases import LANGUAGES, Refusal
from vipo_device.protocol.texts import cleaned_json

_POSITION_ARGUMENTS = ("end_line", "end_column", "found", "instead")


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


@dataclass(frozen=True, slots=True)
class Drawing:
    """A text that is to be drawn over a document; `shown` is the script from which it was edited."""

    document: dict[str, Any]
    surroundings: Surroundings
    text: str
    shown: str | None

    def done(self) -> DrawnScript:
        """Draw it; when the document prints as another script than `shown`, nothing is drawn."""
        document, surroundings = self.document, self.surroundings
        before = compile_document(document, surroundings)
        if self.shown is not None and self.shown != before.script:
            return DrawnScript(False, True, None, before.script, before.lines)
        parsed = parse_script(self.text, surroundings)
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
