"""The compiled form of a room's program, the same in all processes, and which edits it does not show yet.

One process checks after an edit: the one at which it was made. What it finds goes into the room's stream, mostly as a
patch, and holds for everybody, the writer too, as soon as it is read from there: so all agree, in one order. A patch
that begins from another form than the last one is dropped by all, and its writer checks anew. No I/O.
"""

from __future__ import annotations

import json
from collections import deque
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from editor.programs.compiled_patch import apply_patch, make_patch
from editor.rooms.stream import BEGINNING, Entry, Note, is_after

_RECENT = 20
"""So many changes are kept for a child process that knows the form of some checks ago."""


def encode_check(said: Mapping[str, Any], *, after: str, more: bool, against: str) -> Note:
    """Return the note of a check that looked when the stream was heard up to `after`.

    `more` tells that the document has changed since where it was checked; `against` is the surroundings' fingerprint.
    """
    told = {"form": said, "after": after, "more": more, "against": against}
    return Note("compiled", json.dumps(told, separators=(",", ":")).encode())


@dataclass(frozen=True, slots=True)
class _Shown:
    """Where the present form came from: who checked, its entry, and what had been heard before that look."""

    origin: str = ""
    entry: str = BEGINNING
    after: str = BEGINNING
    more: bool = False


class CompiledForm:
    """What a process knows of the compiled form."""

    def __init__(self) -> None:
        """Know nothing yet."""
        self.now: Mapping[str, Any] | None = None
        self.change: Mapping[str, Any] | None = None
        """What made the form of the one before, if there was one."""
        self.against = ""
        """The fingerprint of the surroundings that were checked against."""
        self._recent: deque[Mapping[str, Any]] = deque(maxlen=_RECENT)
        self._updates: dict[str, str] = {}
        self._shown = _Shown()

    @property
    def revision(self) -> int | None:
        """The number of the present form."""
        return None if self.now is None else int(self.now["revision"])

    def way_from(self, known: Collection[int]) -> Sequence[Mapping[str, Any]]:
        """Return what leads to the present form from one of these revisions: patches, or all of it."""
        if self.now is None:
            return ()
        way: list[Mapping[str, Any]] = []
        revision = self.revision
        for change in reversed(self._recent):
            if revision in known:
                return way[::-1]
            if change["revision"] == revision and "base" in change:
                way.append(change)
                revision = change["base"]
        return way[::-1] if revision in known else (self.now,)

    def hear_update(self, entry: Entry) -> None:
        """Take in that a process has changed the document."""
        self._updates[entry.origin] = entry.id

    def hear(self, entry: Entry) -> bool:
        """Take in a check; tell whether it holds, which one does not that begins from a form that is not here."""
        told = json.loads(entry.note.data)
        form: Mapping[str, Any] = told["form"]
        base = form.get("base")
        if base is not None and (self.now is None or self.now["revision"] != base):
            return False
        before = self.now
        self.now = form if base is None or before is None else apply_patch(before, form)
        self.change = form if base is not None or before is None else make_patch(before, form)
        self._recent.append(self.change)
        self.against = told["against"]
        self._shown = _Shown(entry.origin, entry.id, told["after"], told["more"])
        return True

    def forget(self) -> None:
        """Know nothing any more: a part of the stream was missed."""
        self.now = None

    def not_shown(self) -> set[str]:
        """Return the processes of whose edits the form may not show the last."""
        shown = self._shown
        return {
            origin
            for origin, at in self._updates.items()
            if (origin == shown.origin and shown.more)
            or is_after(at, shown.entry if origin == shown.origin else shown.after)
        }
