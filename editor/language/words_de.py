"""The fixed words inside sentences in German, by their English."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

WORDS_DE: Final[Mapping[str, str]] = {
    "and": "und",
    "or": "oder",
    "nothing": "nichts",
    "there is nothing here": "hier gibt es nichts",
    "objects": "Objekte",
    # types of values
    "a number": "eine Zahl",
    "a text": "ein Text",
    "yes or no": "ja oder nein",
    "a list": "eine Liste",
    "a kind of object": "eine Objektart",
    "a device": "ein Gerät",
    "a place": "ein Ort",
    "a robot": "ein Roboter",
    "a zone": "eine Zone",
    "a point": "ein Punkt",
    # what a sentence speaks of
    "A condition": "Eine Bedingung",
    "The quantity": "Die Menge",
    "The object": "Das Objekt",
    "The time to wait": "Die Wartezeit",
    "The time limit": "Die Zeitgrenze",
    "How many times": "Wie oft",
    "A value": "Ein Wert",
    "The variable": "Die Variable",
    "The question": "Die Frage",
    "The message": "Die Nachricht",
    "The result": "Das Ergebnis",
    "The first value": "Der erste Wert",
}
