"""The file of kinds: read with suspicion, lifted to this version, and each refusal names the kind and the word."""

from __future__ import annotations

import os
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import fields
from functools import cache
from pathlib import Path
from typing import Any, Final, get_args

from simulation.behaviour import Behaviour, Condition, Kind, Law, ReadingLaw
from vipo_device.protocol.errors import VipoError
from vipo_device.protocol.units import UNITS

VERSION: Final = 1
LADDER: Final[Mapping[int, Callable[[dict[str, Any]], dict[str, Any]]]] = {}
"""For each older version what makes the next one of it; the first version has none before it."""
MOST_KINDS: Final = 500
MOST: Final = 1e6
_FILE = Path(__file__).resolve().parent / "kinds.toml"
_POSITIVE = {"job_s", "speed_m_s", "driving_h", "standing_h", "charging_h", "rising_s", "falling_s"}
_PARTS = {"spread", "odds"}
_COUNTS = {"slots", "stock"}
_TABLES = {"readings", "uses", "needs", "fails"}
_SAYS = {f.name for f in fields(Behaviour)}
_ASKS = {f.name for f in fields(Condition)}
_LAW_WORDS = {f.name for f in fields(ReadingLaw)}
_LAW_NEEDS: Final[Mapping[str, tuple[str, ...]]] = {"drawn": ("after", "usual")}
"""Words without which a law says nothing."""


class BadKinds(VipoError):
    """A file of kinds that cannot be read."""

    code = "bad_kinds"
    status = 422


OWN_FILE = "VIPO_KINDS"
"""The setting that names a file of more kinds; processes without Django have it in their environment, too."""


@cache
def default_kinds() -> tuple[Kind, ...]:
    """Return the kinds that VIPO comes with, and after them, so that they know better, those of the server's own file.

    Raises BadKinds with the setting's name where that file cannot be read.
    """
    return (*read_kinds(_FILE.read_text()), *_own_kinds(os.environ.get(OWN_FILE, "")))


def _own_kinds(path: str) -> tuple[Kind, ...]:
    if not path:
        return ()
    try:
        return read_kinds(Path(path).read_text())
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "it is no text"
        raise BadKinds(f"{OWN_FILE} names {path}, which cannot be read: {reason}.") from error
    except BadKinds as error:
        raise BadKinds(f"{OWN_FILE} names {path}. {error.detail}") from error


def read_kinds(text: str) -> tuple[Kind, ...]:
    """Read a file of kinds; raises BadKinds with the kind and the word that cannot be understood."""
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise BadKinds(f"The kinds are no TOML: {error}.") from error
    data = _lift(data)
    _refuse_unknown("The file", "", data, {"version", "kinds"})
    kinds = data.get("kinds", [])
    if not isinstance(kinds, list) or len(kinds) > MOST_KINDS:
        raise BadKinds(f"Write at most {MOST_KINDS} kinds, each under [[kinds]].")
    return tuple(_kind(entry, number) for number, entry in enumerate(kinds, 1))


def _lift(data: dict[str, Any]) -> dict[str, Any]:
    version = data.get("version")
    if type(version) is not int or not 1 <= version <= VERSION:
        raise BadKinds(f"The kinds have the version {version!r}; write version = {VERSION} in the first line.")
    for step in range(version, VERSION):
        data = LADDER[step](data)
    return data


def _kind(entry: object, number: int) -> Kind:
    if not isinstance(entry, dict):
        raise BadKinds(f"Kind {number} is no table: write [[kinds]] above it.")
    name = entry.get("name")
    if not isinstance(name, str) or not name:
        raise BadKinds(f"Kind {number} has no name: write name = followed by a text.")
    when = entry.get("when", {})
    says = {word: value for word, value in entry.items() if word not in {"name", "when"}}
    _refuse_unknown(name, "when", when, _ASKS)
    _refuse_unknown(name, "", says, _SAYS)
    asked = {word: _asked(name, word, value) for word, value in when.items()}
    return Kind(name, Condition(**asked), {word: _said(name, word, value) for word, value in says.items()})


def _asked(name: str, word: str, value: object) -> Any:
    if word == "reaches_c":
        return _number(name, word, value)
    if word != "kind":
        return _words(name, word, value)
    if value not in {"machine", "robot"}:
        raise BadKinds(f'{name}: kind is "machine" or "robot", not {value!r}.')
    return value


def _said(name: str, word: str, value: object) -> object:
    if word in _TABLES:
        table = _table(name, word, value)
        return {key: _in_table(name, word, key, held) for key, held in table.items()}
    if word == "hands_over":
        return _words(name, word, value)
    return _number(name, word, value)


def _in_table(name: str, word: str, key: str, value: object) -> object:
    if word == "readings":
        return _law(name, key, value)
    if word == "fails":
        return _number(name, "odds", value)
    goods = _table(name, f"{word}.{key}", value)
    return {thing: _number(name, "stock", count) for thing, count in goods.items()}


def _law(name: str, key: str, value: object) -> ReadingLaw:
    table = _table(name, f"readings.{key}", value)
    _refuse_unknown(name, f"readings.{key}", table, _LAW_WORDS)
    if table.get("law") not in get_args(Law):
        raise BadKinds(f"{name}: the law of {key} is one of {', '.join(get_args(Law))}, not {table.get('law')!r}.")
    for word in _LAW_NEEDS.get(table["law"], ()):
        if not table.get(word):
            raise BadKinds(f"{name}: {key} is {table['law']} and needs {word}.")
    return ReadingLaw(**{word: _law_word(name, word, held) for word, held in table.items()})


def _law_word(name: str, word: str, value: object) -> Any:
    if word == "after":
        return _words(name, word, value)
    if word not in {"law", "unit", "usual", "other"}:
        return _number(name, word, value)
    if not isinstance(value, str):
        raise BadKinds(f"{name}: {word} must be a text, not {value!r}.")
    if word == "unit" and value and value not in UNITS:
        raise BadKinds(f"{name}: the unit {value[:40]!r} is not known. Known are: {', '.join(UNITS)}.")
    return value


def _number(name: str, word: str, value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) <= MOST:
        raise BadKinds(f"{name}: {word} must be a number of at most {MOST:g}, not {repr(value)[:40]}.")
    if word in _POSITIVE and value < 0.001:
        raise BadKinds(f"{name}: {word} must be at least 0.001, not {value!r}.")
    if word in _PARTS and not 0 <= value <= 1:
        raise BadKinds(f"{name}: {word} must be from 0 to 1, not {value!r}.")
    if word in _COUNTS and (not isinstance(value, int) or value < 0):
        raise BadKinds(f"{name}: a count must be a whole number of at least 0, not {value!r}.")
    return value


def _words(name: str, word: str, value: object) -> tuple[str, ...]:
    if not isinstance(value, list) or not all(isinstance(held, str) for held in value):
        raise BadKinds(f'{name}: {word} must be a list of texts, such as ["heat"].')
    return tuple(value)


def _table(name: str, word: str, value: object) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise BadKinds(f"{name}: {word} must be a table.")
    return value


def _refuse_unknown(name: str, where: str, table: object, known: set[str]) -> None:
    for word in _table(name, where or "a kind", table):
        if word not in known:
            place = f" in {where}" if where else ""
            raise BadKinds(f"{name}: {word}{place} is not known. Known are: {', '.join(sorted(known))}.")
