"""A document as its shape says it is (docs/shapes/document.md), whatever is written in it, and what was odd. Pure.

The one place where what has a wrong shape is left out: the reading of the language passes over the same by itself, so a
program means the same before and after. Browsers do it in `frontend/src/program/document/wellFormed.ts`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Final

from editor.language.document.outline import mapping, place_of
from editor.language.expressions.values import is_number, read_point

START: Final = "start_pos"
ROOTS: Final = ("steps", "functions", "roles", "parameters", "zones")
Json = dict[str, Any]
Shape = Callable[[object], object]
"""Returns a value as it fits: the same object where it does, None where nothing of it does."""


@dataclass(frozen=True, slots=True)
class Odd:
    """Something of a wrong shape that is read as if it were not there; `part` is its name in the root, `field` in it.

    Both are empty where the whole root is odd, `field` where the whole part is.
    """

    root: str
    part: str = ""
    field: str = ""

    @property
    def path(self) -> str:
        """Return where it stands, such as `roles.r.can`."""
        return ".".join(filter(None, (self.root, self.part, self.field)))


def well_formed(document: object) -> Json:
    """Return a document in which each part has its shape; parts that have it are the same objects."""
    steps = mapping(document).get("steps")
    others, _ = well_formed_parts(document)
    return {**others, "steps": {name: _step(step) for name, step in mapping(steps).items()}}


def well_formed_parts(document: object) -> tuple[Json, tuple[Odd, ...]]:
    """Return all of a document in its shape but for the steps, which stay as they are, and what was odd in it."""
    whole = mapping(document)
    made: Json = dict(whole)
    odd: list[Odd] = []
    if whole.get(START) is not None and _point(whole[START]) is None:
        made[START] = None
        odd.append(Odd(START))
    for root in ROOTS:
        if whole.get(root) is not None and not isinstance(whole[root], Mapping):
            odd.append(Odd(root))
        if root != "steps":
            made[root] = {name: _part(root, name, part, odd) for name, part in mapping(whole.get(root)).items()}
        else:
            made[root] = mapping(whole.get(root))
    return made, tuple(odd)


def well_formed_function(function: object) -> Mapping[str, Any]:
    """Return a function by itself in its shape, as the library keeps it."""
    return _part("functions", "", function, [])


def _part(root: str, name: str, part: object, odd: list[Odd]) -> Mapping[str, Any]:
    if not isinstance(part, Mapping):
        odd.append(Odd(root, name))
    return _fitting(mapping(part), _FIELDS[root], lambda field: odd.append(Odd(root, name, field)))


def _fitting(part: Mapping[str, Any], fields: Mapping[str, Shape], note: Callable[[str], None]) -> Mapping[str, Any]:
    """Return a part in which these fields have their shapes; fields that nobody knows stay as they are."""
    changed: Json = {}
    for field, shape in fields.items():
        value = part.get(field)
        fitting = None if value is None else shape(value)
        if fitting is not value:
            changed[field] = fitting
            note(field)
    kept = {field: value for field, value in part.items() if field not in changed} if changed else part
    return {**kept, **{field: value for field, value in changed.items() if value is not None}} if changed else kept


def _step(step: object) -> Mapping[str, Any]:
    """Return a step with its four fields, each of its shape."""
    given = mapping(step)
    kind, place, pos = given.get("kind"), given.get("place"), given.get("pos")
    is_known = isinstance(kind, str) and isinstance(given.get("params"), Mapping)
    is_placed = (place is None or place_of(place) is not None) and (pos is None or _point(pos) is not None)
    if is_known and is_placed:
        return given
    return {
        "kind": kind if isinstance(kind, str) else "",
        "place": place if place_of(place) is not None else None,
        "pos": _point(pos),
        "params": mapping(given.get("params")),
    }


def _point(value: object) -> object:
    return value if read_point(value) is not None else None


def _number(value: object) -> object:
    return value if is_number(value) else None


def _text(value: object) -> object:
    return value if isinstance(value, str) else None


def _list_of(shape: Shape) -> Shape:
    """Return the shape of a list; what does not fit in it is left out of it."""

    def fit(value: object) -> object:
        if not isinstance(value, list | tuple):
            return None
        fitting = [shape(each) for each in value]
        is_whole = all(made is each for made, each in zip(fitting, value, strict=True))
        return value if is_whole else [each for each in fitting if each is not None]

    return fit


def _object_of(**fields: Shape) -> Shape:
    """Return the shape of an object; fields that do not fit are left out of it."""

    def fit(value: object) -> object:
        return _fitting(value, fields, lambda field: None) if isinstance(value, Mapping) else None

    return fit


def _source(value: object) -> object:
    """Return where a function was copied from, if both that and the version are said."""
    given = mapping(value)
    return value if isinstance(given.get("library"), str) and is_number(given.get("version")) else None


_FIELDS: Final[Mapping[str, Mapping[str, Shape]]] = {
    "functions": {
        "name": _text,
        "parameters": _list_of(_object_of(name=_text, type=_text, unit=_text)),
        "result": _object_of(type=_text, unit=_text),
        "source": _source,
    },
    "roles": {"name": _text, "device": _text, "can": _list_of(_text)},
    "parameters": {"name": _text, "type": _text, "unit": _text},
    "zones": {"name": _text, "rule": _text, "points": _list_of(_point), "speed_m_s": _number, "door": _text},
}
