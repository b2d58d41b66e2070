"""A vehicle's JSON, read with suspicion: every value is checked, and a refusal says where it stands."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NoReturn

from vipo_device.protocol.messages import MAX_DEPTH, BadMessage, parse_plain_json
from vipo_device.protocol.texts import cleaned_json

MAX_BYTES = 256 * 1024
MAX_ITEMS = 1000
MAX_TEXT = 512


@dataclass(frozen=True, slots=True)
class Fields:
    """An object of a message; `path` says where it stands in it."""

    body: Mapping[str, Any]
    path: str

    def refuse(self, name: str, must: str) -> NoReturn:
        """Raise BadMessage about a field."""
        raise BadMessage(f"{self.path}/{name} must be {must}."[:300])

    def text(self, name: str, *, needed: bool = False) -> str:
        """Return a text, empty when it is left out."""
        value = self.body.get(name)
        if value is None and not needed:
            return ""
        if not isinstance(value, str) or len(value) > MAX_TEXT or (needed and not value):
            self.refuse(name, f"text of 1 to {MAX_TEXT} characters" if needed else f"text of at most {MAX_TEXT}")
        return value

    def lenient_text(self, name: str) -> str:
        """Return a text for people, cut where it is too long; it may be left out."""
        value = self.body.get(name)
        return value[:MAX_TEXT] if isinstance(value, str) else ""

    def number(self, name: str) -> float | None:
        """Return a number, None when it is left out."""
        value = self.body.get(name)
        if value is None:
            return None
        if not isinstance(value, int | float) or isinstance(value, bool) or abs(value) > 1e12:
            self.refuse(name, "a number")
        return float(value)

    def need_number(self, name: str) -> float:
        """Return a number that must be there."""
        value = self.number(name)
        if value is None:
            self.refuse(name, "a number")
        return value

    def whole(self, name: str, *, default: int | None = None) -> int:
        """Return a whole number from 0; without a default it must be there."""
        value = self.body.get(name, default)
        if not isinstance(value, int) or isinstance(value, bool) or not 0 <= value < 2**32:
            self.refuse(name, "a whole number from 0 to 4294967295")
        return value

    def truth(self, name: str) -> bool | None:
        """Return true or false, None when it is left out."""
        value = self.body.get(name)
        if value is not None and not isinstance(value, bool):
            self.refuse(name, "true or false")
        return value

    def inner(self, name: str) -> Fields | None:
        """Return an object inside, None when it is left out."""
        value = self.body.get(name)
        if value is None:
            return None
        if not isinstance(value, dict):
            self.refuse(name, "an object")
        return Fields(value, f"{self.path}/{name}")

    def each(self, name: str, *, needed: bool = False) -> list[Fields]:
        """Return the objects of a list, none when it is left out."""
        items = self._items(name, needed=needed)
        if not all(isinstance(item, dict) for item in items):
            self.refuse(name, "a list of objects")
        return [Fields(item, f"{self.path}/{name}/{at}") for at, item in enumerate(items)]

    def words(self, name: str) -> list[str]:
        """Return the texts of a list, none when it is left out."""
        items = self._items(name, needed=False)
        if not all(isinstance(item, str) and len(item) <= MAX_TEXT for item in items):
            self.refuse(name, "a list of texts")
        return items

    def _items(self, name: str, *, needed: bool) -> list[Any]:
        value = self.body.get(name)
        if value is None and not needed:
            return []
        if not isinstance(value, list) or len(value) > MAX_ITEMS:
            self.refuse(name, f"a list of at most {MAX_ITEMS}")
        return value


def read_fields(payload: bytes, topic: str) -> Fields:
    """Read a message of a vehicle; `topic` is the name it is refused under. Raises BadMessage.

    Texts are cleaned, not refused: one code of a load with a separator of GS1 would take the whole state along.
    """
    body = cleaned_json(parse_plain_json(payload, max_bytes=MAX_BYTES, max_depth=MAX_DEPTH))
    if not isinstance(body, dict):
        raise BadMessage(f"{topic} must be a JSON object.")
    return Fields(body, topic)
