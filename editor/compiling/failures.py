"""What is said of a program that could not be checked. Pure."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from editor.programs.compiled_patch import make_patch

Form = Mapping[str, Any]
TEXTS: Mapping[str, Mapping[str, str]] = {
    "check_took_too_long": {
        "en": "Checking this program took too long and was ended. Make it smaller, or a second program of a part.",
        "de": "Dieses Programm zu prüfen dauerte zu lange und wurde abgebrochen. "
        "Verkleinern Sie es, oder machen Sie aus einem Teil ein zweites Programm.",
    },
    "check_broke_off": {
        "en": "Checking this program broke off twice. Undo the last change, or change the program once more.",
        "de": "Dieses Programm zu prüfen brach zweimal ab. "
        "Nehmen Sie die letzte Änderung zurück, oder ändern Sie das Programm noch einmal.",
    },
}
_NOTHING: Form = {
    "script": "",
    "lines": [],
    "numbers": {},
    "diagnostics": [],
    "added_moves": [],
    "order": [],
    "depth": {},
}


def failed_form(before: Form | None, revision: int, code: str) -> Form:
    """Return what to tell of a check that failed: all stays as it was before, but for the diagnostics."""
    texts = TEXTS[code]
    told = {
        "code": code,
        "severity": "error",
        "step": "",
        "field": "",
        "message": texts["en"],
        "messages": dict(texts),
        "when": "ever",
        "args": {},
        "line": None,
        "fix": None,
    }
    form = {**(_NOTHING if before is None else before), "revision": revision, "diagnostics": [told]}
    return form if before is None else make_patch(before, form)
