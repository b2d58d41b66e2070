"""What is said of a line that is no value, in each language."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

LINE_TEXTS: Final[Mapping[str, Mapping[str, str]]] = {
    "too_long": {"en": "The line is too long.", "de": "Die Zeile ist zu lang."},
    "not_complete": {
        "en": "Something is missing, or too much, here. Write for example: oven.temperature > 60.",
        "de": "Hier fehlt etwas, oder etwas ist zu viel. Schreiben Sie zum Beispiel: oven.temperature > 60.",
    },
    "open_bracket": {"en": "A bracket is not closed.", "de": "Eine Klammer ist nicht geschlossen."},
    "open_text": {
        "en": "A text is not closed with a quotation mark.",
        "de": "Ein Text ist nicht mit einem Anführungszeichen geschlossen.",
    },
    "closing_bracket": {
        "en": "A bracket is closed that was never opened.",
        "de": "Eine Klammer wird geschlossen, die nie geöffnet wurde.",
    },
    "bad_braces": {"en": "A value in braces is not complete.", "de": "Ein Wert in Klammern { } ist nicht vollständig."},
    "not_in_value": {"en": "{found} cannot stand here. {instead}", "de": "{found} kann hier nicht stehen. {instead}"},
    "unknown_name": {
        "en": "There is nothing called “{name}” here.",
        "de": "Hier gibt es nichts mit dem Namen „{name}“.",
    },
    "unknown_name_like": {
        "en": "There is nothing called “{name}” here. Do you mean {options}?",
        "de": "Hier gibt es nichts mit dem Namen „{name}“. Meinen Sie {options}?",
    },
}
