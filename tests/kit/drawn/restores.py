"""A restore while five people draw, part of whose edits the server has not heard yet: whose edit is lost?"""

from __future__ import annotations

import random
from typing import Any

from pycrdt import Doc, Map

from editor.documents.shared_document import ROOTS, SharedDocument, empty_document, encode_document
from editor.language.comparison.changes import ValueChange, apply_changes, find_changes
from editor.language.comparison.difference import name_of
from editor.language.comparison.needs import restore_all, restore_some

EDITORS = 5
Json = dict[str, Any]


class _Editor:
    """A person with a copy of the document; each writes fields of their own name, so that no two want the same."""

    def __init__(self, number: int, room: SharedDocument) -> None:
        self.field, self.document = f"by{number}", Doc[Any]()
        self.made: dict[tuple[str, ...], int] = {}
        for root in ROOTS:
            self.document.get(root, type=Map)
        self.hear(room)

    @property
    def _steps(self) -> Any:
        return self.document.get("steps", type=Map)

    def hear(self, room: SharedDocument) -> None:
        self.document.apply_update(room.encode(self.document.get_state()))

    def tell(self, room: SharedDocument) -> None:
        room.apply(self.document.get_update(room.state()))

    def edit(self, chance: random.Random, number: int) -> None:
        """Set a value of a step, or draw a new one, inside another now and then."""
        known = [name for name in self._steps if isinstance(self._steps[name], Map)]
        if known and chance.random() < 0.7:
            name = chance.choice(known)
            self._steps[name]["params"][self.field] = number
            self.made["steps", name, "params", self.field] = number
            return
        name, parent = f"{self.field}-{number}", chance.choice(["program", *known])
        place, params = [parent, "body", f"{number:04d}V"], {self.field: number}
        self._steps[name] = Map({"kind": "while", "place": place, "pos": [0, 0], "params": Map(params)})
        self.made["steps", name, "params", self.field] = number


def lost_in_a_restore(seed: int) -> list[str]:
    """Let five people draw, restore a part of an earlier version meanwhile, and return whose edits are not there.

    A restore may take what it was asked for: the values that it changes. Everything else has to stand at the end, in
    all copies alike, and what it restored is what it was, unless somebody changed just that at the same time.
    """
    chance = random.Random(seed)
    room = SharedDocument([encode_document(empty_document())])
    editors = [_Editor(number, room) for number in range(EDITORS)]
    versions = [room.to_json()]
    for number in range(40):
        editor = chance.choice(editors)
        editor.edit(chance, number)
        if chance.random() < 0.6:
            editor.tell(room)
            chance.choice(editors).hear(room)
        if chance.random() < 0.2:
            versions.append(room.to_json())
    changes = _restore(room, chance.choice(versions), chance)
    for number in range(40, 50):
        chance.choice(editors).edit(chance, number)
    for editor in editors * 2:
        editor.tell(room)
        editor.hear(room)
    copies = {SharedDocument([each.document.get_update()]).digest() for each in editors} | {room.digest()}
    return [*_lost(room.to_json(), editors, changes), *(["the copies differ"] if len(copies) > 1 else [])]


def _restore(room: SharedDocument, then: Json, chance: random.Random) -> tuple[ValueChange, ...]:
    now = room.to_json()
    differing = sorted({name_of(change.path) for change in find_changes(now, then)})
    wanted = chance.sample(differing, min(len(differing), chance.randrange(1, 4)))
    restoring = restore_all(now, then) if chance.random() < 0.2 else restore_some(now, then, wanted)
    room.change_to(apply_changes(now, restoring.changes))
    return restoring.changes


def _lost(document: Json, editors: list[_Editor], changes: tuple[ValueChange, ...]) -> list[str]:
    taken = {change.path for change in changes}
    lost = []
    for editor in editors:
        for path, value in editor.made.items():
            if any(path[: len(each)] == each for each in taken):
                continue  # it was asked to change just this
            step = document["steps"].get(path[1], {})
            if step.get("params", {}).get(path[3]) != value:
                lost.append(f"{'.'.join(path)} = {value}")
    return lost
