"""What things on a site's map are called: names that people give, and ids that are made of them."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Collection
from dataclasses import dataclass
from itertools import count

from django.utils.text import slugify

from registry.errors import RegistryError
from vipo_device.protocol.texts import find_unfit, normal

MOST_NAME = 60
_ID = re.compile(r"[A-Za-z0-9_]{1,60}")


@dataclass(frozen=True, slots=True)
class Naming:
    """The rules for one sort of thing (`place`): at most so many at a site, and what is raised by what is not so."""

    thing: str
    most: int
    unfit: type[RegistryError]
    taken: type[RegistryError]

    def checked_name(self, name: str, others: Collection[str]) -> str:
        """Return a name in its normal form that none of the others has, whatever their letters' case."""
        name = normal(" ".join(name.split()))
        if not 1 <= len(name) <= MOST_NAME or find_unfit(name, is_line=True):
            text = f"A {self.thing}'s name has 1 to {MOST_NAME} characters that can be printed. Enter one."
            raise self.unfit(text, {"why": "name", "most": MOST_NAME})
        if name.casefold() in {other.casefold() for other in others}:
            text = f"There is already a {self.thing} {name!r} at this site. Choose another name."
            raise self.taken(text, {"why": "taken_name", "name": name})
        return name

    def new_key(self, wished: str, name: str, taken: Collection[str], devices: Collection[str] = ()) -> str:
        """Return the id of a new thing, made of its name if none is wished; whoever asks holds the site's row.

        `taken` are the ids of the site's other things, `devices` of its devices, if those may not have one of these.
        """
        if len(taken) >= self.most:
            text = f"A site has at most {self.most} {self.thing}s. Remove one that nobody needs."
            raise self.unfit(text, {"why": "many", "most": self.most})
        if wished in taken:
            text = f"There is already a {self.thing} with the id {wished!r} at this site."
            raise self.taken(text, {"why": "taken_id", "id": wished})
        if wished in devices:
            text = f"A device of this site has the id {wished!r}. Make the {self.thing} without an id: it gets another."
            raise self.taken(text, {"why": "taken_device", "id": wished})
        if wished and not _ID.fullmatch(wished):
            text = f"A {self.thing}'s id has 1 to 60 of the letters a to z, digits and underscores."
            raise self.unfit(text, {"why": "id"})
        if wished:
            return wished
        plain = unicodedata.normalize("NFKD", name).encode("ascii", "ignore").decode()
        stem = slugify(plain)[:40].replace("-", "_") or self.thing
        return next(key for number in count(1) if (key := _numbered(stem, number)) not in taken and key not in devices)


def _numbered(stem: str, number: int) -> str:
    return stem if number == 1 else f"{stem}_{number}"
