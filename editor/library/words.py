"""The words by which a library function is found: what it is called, what is said of it, and what it does.

Words are folded: small letters without accents, names taken apart (`mixPaint` also as `mix paint`), and what steps,
methods and devices are called in both languages of the screens. `step_words.json` is what the editor's catalogues say
of each kind of step; a test holds that it is the same.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any, Final
from unicodedata import normalize

from editor.language.document.outline import mapping
from editor.language.site.signature import ABILITIES, Signature
from editor.language.site.surroundings import DeviceFacts

MOST_WORDS: Final = 10
MOST_LETTERS: Final = 8_000
_WORD = re.compile(r"\w+")
_HUMP = re.compile(r"(?<=[a-z0-9])(?=[A-Z])|_")
_ENDINGS = ("ies", "ing", "ed", "es", "en", "er", "st", "s", "e", "t", "n")
_SHORTEST_STEM: Final = 3
_GERMAN: Mapping[str, str] = {
    "accept": "annehmen",
    "battery": "akku batterie",
    "booth": "kabine lackierkabine",
    "box": "kiste karton",
    "blink": "blinken",
    "can": "dose",
    "cans": "dosen",
    "charge": "laden aufladen",
    "clean": "reinigen",
    "close": "schließen",
    "conveyor": "förderband",
    "cool": "kühlen",
    "cure": "aushärten trocknen härten",
    "cut": "schneiden",
    "dispense": "ausgeben",
    "door": "tür",
    "drill": "bohren",
    "dry": "trocknen",
    "glue": "kleben",
    "heat": "heizen erwärmen",
    "honk": "hupen",
    "inspect": "prüfen",
    "inventory": "lager vorrat",
    "lift": "heben anheben",
    "lifter": "heber hubwagen",
    "machine": "maschine",
    "measure": "messen",
    "mill": "fräsen",
    "mix": "mischen",
    "mixer": "mischer",
    "open": "öffnen",
    "oven": "ofen",
    "pack": "packen verpacken",
    "paint": "farbe lack lackieren streichen",
    "painting": "lackieren",
    "pallet": "palette",
    "press": "presse pressen",
    "print": "drucken",
    "quality": "qualität güte",
    "rollers": "rollenbahn",
    "saw": "säge sägen",
    "scan": "scannen",
    "shelf": "regal",
    "sort": "sortieren",
    "stock": "bestand vorrat",
    "temperature": "temperatur",
    "wash": "waschen",
    "weigh": "wiegen",
    "weld": "schweißen",
}
"""What usual words of methods and devices are in German; people's own words are found as they are."""


def words_of(
    name: str,
    description: str,
    definition: Mapping[str, Any],
    signature: Signature,
    devices: Mapping[str, DeviceFacts],
) -> str:
    """Return what a function is found by, each word once, each behind a space."""
    texts = [name, description, *_of_steps(definition), *_of_needs(signature, devices)]
    texts += [port.name for port in signature.parameters]
    found: dict[str, None] = {}
    for text in texts:
        for word in _taken_apart(text):
            found[word] = None
            found.update(dict.fromkeys(_folded(_GERMAN.get(word, "")).split()))
    return f" {' '.join(filter(None, found))}"[:MOST_LETTERS]


def _of_steps(definition: Mapping[str, Any]) -> Iterator[str]:
    kinds = {mapping(step).get("kind") for step in mapping(definition.get("steps")).values()}
    for kind in sorted(str(kind) for kind in kinds):
        yield from _step_words().get(kind, {}).values()
    for function in mapping(definition.get("functions")).values():
        yield str(mapping(function).get("name", ""))


@cache
def _step_words() -> Mapping[str, Mapping[str, str]]:
    words: dict[str, dict[str, str]] = json.loads((Path(__file__).parent / "step_words.json").read_text())
    return words


def _of_needs(signature: Signature, devices: Mapping[str, DeviceFacts]) -> Iterator[str]:
    for need in signature.needs:
        known = devices.get(need.device)
        yield {"robot": "robot Roboter", "machine": "machine Maschine"}.get(need.of, "")
        yield need.name
        yield known.description.device_class if known else ""
        for ability in ABILITIES:
            yield from getattr(need, ability)


def _taken_apart(text: str) -> Iterable[str]:
    """Return a text's words, and those that are names also in their parts."""
    for word in _WORD.findall(text):
        yield _folded(word)
        parts = _HUMP.sub(" ", word).split()
        yield from (_folded(part) for part in parts if len(parts) > 1)


def _folded(text: str) -> str:
    """Return a text in small letters without accents: ä is a, ß is ss."""
    plain = normalize("NFKD", text.casefold())
    return "".join(letter for letter in plain if not "\u0300" <= letter <= "\u036f")


def stems_of(query: str) -> list[str]:
    """Return what must stand in the words of whatever is looked for: its words without their usual endings."""
    return [_stem(_folded(word)) for word in _WORD.findall(query)[:MOST_WORDS]]


def _stem(word: str) -> str:
    for ending in _ENDINGS:
        if word.endswith(ending) and len(word) - len(ending) >= _SHORTEST_STEM:
            return word.removesuffix(ending)
    return word
