"""JSON read with suspicion: every field has a path, and a refusal says where it is and what it needs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from math import isfinite
from typing import Any, NoReturn

from vipo_device.descriptions.forms import refuse
from vipo_device.protocol.description import Pose, Size


@dataclass(frozen=True, slots=True)
class Fields:
    """An object of a description; `places` says on which line and column a path stands, where that is known."""

    body: Mapping[str, Any]
    path: str = ""
    places: Mapping[str, tuple[int, int]] = field(default_factory=dict)

    def path_of(self, key: str) -> str:
        """Return the path of a field, written as a JSON pointer."""
        return f"{self.path}/{key.replace('~', '~0').replace('/', '~1')}"

    def refuse(self, key: str, code: str, **args: str) -> NoReturn:
        """Say what is wrong with a field. Raises BadDescription."""
        path = self.path_of(key)
        line, column = self.places.get(path) or self.places.get(self.path) or (0, 0)
        refuse(code, line, column, path, key=key, **args)

    def has(self, key: str) -> bool:
        """Tell whether the field is given and not null."""
        return self.body.get(key) is not None

    def text(self, key: str) -> str:
        """Return a text, empty when it is not given."""
        value = self.body.get(key)
        if value is None:
            return ""
        if not isinstance(value, str):
            self.refuse(key, "need_text")
        return value

    def number(self, key: str) -> float | None:
        """Return a number, None when it is not given."""
        value = self.body.get(key)
        if value is None:
            return None
        if (number := _number(value)) is None:
            self.refuse(key, "need_number")
        return number

    def whole(self, key: str) -> int:
        """Return a whole number, 0 when it is not given."""
        value = self.number(key) or 0.0
        if not value.is_integer():
            self.refuse(key, "need_whole")
        return int(value)

    def truth(self, key: str, *, default: bool) -> bool:
        """Return true or false."""
        value = self.body.get(key)
        if value is None:
            return default
        if not isinstance(value, bool):
            self.refuse(key, "need_truth")
        return value

    def numbers(self, key: str) -> list[float]:
        """Return a list of numbers, empty when it is not given."""
        values = self.body.get(key)
        if values is None:
            return []
        read = [_number(value) for value in values] if isinstance(values, list) else [None]
        numbers = [number for number in read if number is not None]
        if len(numbers) < len(read):
            self.refuse(key, "need_numbers")
        return numbers

    def words(self, key: str) -> tuple[str, ...]:
        """Return a list of texts, empty when it is not given."""
        values = self.body.get(key)
        if values is None:
            return ()
        if not isinstance(values, list) or not all(isinstance(value, str) for value in values):
            self.refuse(key, "need_words")
        return tuple(values)

    def inside(self, key: str) -> Fields:
        """Return an object within this one, empty when it is not given."""
        value = self.body.get(key)
        if value is None:
            value = {}
        if not isinstance(value, dict):
            self.refuse(key, "need_object")
        return Fields(value, self.path_of(key), self.places)

    def named(self, key: str) -> Iterator[tuple[str, Fields]]:
        """Return the objects of an object by their names, in the order in which they stand."""
        group = self.inside(key)
        for name in group.body:
            yield name, group.inside(name)

    def each(self, key: str) -> Iterator[Fields]:
        """Return the objects of a list."""
        values = self.body.get(key)
        if values is None:
            values = []
        if not isinstance(values, list):
            self.refuse(key, "need_list")
        group = Fields({str(i): value for i, value in enumerate(values)}, self.path_of(key), self.places)
        for position, value in enumerate(values):
            if not isinstance(value, dict):
                group.refuse(str(position), "need_object")
            yield group.inside(str(position))


def read_pose(fields: Fields, key: str) -> Pose:
    """Return a pose of two to four numbers. Raises BadDescription."""
    numbers = fields.numbers(key)
    if len(numbers) not in (2, 3, 4):
        fields.refuse(key, "need_pose")
    return Pose(*numbers)


def read_size(fields: Fields, key: str, radius: float) -> Size:
    """Return a size of three numbers; a robot's may follow from its radius. Raises BadDescription."""
    numbers = fields.numbers(key)
    if not numbers and radius:
        return Size(2 * radius, 2 * radius, 2 * radius)
    if len(numbers) != 3:
        fields.refuse(key, "need_size")
    return Size(*numbers)


def _number(value: object) -> float | None:
    """Return a number that can be worked with, whichever form it came in; None for what is none, or has no end."""
    if not isinstance(value, int | float) or isinstance(value, bool):
        return None
    try:
        number = float(value)
    except OverflowError:
        return None
    return number if isfinite(number) else None
