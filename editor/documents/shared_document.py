"""The shared document: a Yjs document and its plain JSON form. The one importer of pycrdt.

pycrdt integrates updates wrongly when they come out of order (it passes over holes), so whatever may be out of order
is merged into one update first, which is right; and an update that fails half-way is undone.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping
from functools import partial
from typing import Any

from pycrdt import Array, Doc, Map, Text, TransactionEvent, merge_updates

from editor.documents.knowledge import Knowledge, read_deletions
from editor.documents.plain_form import digest_of as digest_of
from editor.documents.plain_form import plain
from editor.documents.slices import Slice
from editor.documents.yjs_encoding import Reader, decode_state_vector, is_within
from editor.documents.yjs_updates import ROOTS as ROOTS
from editor.documents.yjs_updates import ROOTS_AS_BYTES as ROOTS_AS_BYTES
from editor.documents.yjs_updates import clients_of as clients_of
from editor.documents.yjs_updates import read_update as read_update
from editor.language.document.format_migrations import FIRST_FORMAT, FORMAT, format_of, migrate
from editor.language.reading.well_formed import well_formed
from vipo_device.protocol.texts import cleaned_json, find_unfit

_CONTENT = ROOTS[1:]
EMPTY_UPDATE = b"\x00\x00"
DEEPEST = 32
"""How deep shared parts may stand in each other: each way to read them goes down by calling itself."""
_LOG_LIMIT_BYTES = 4 * 1024 * 1024
_LOG_LIMIT_ENTRIES = 2000
_SHARED = (Array, Map, Text)
_MERGED_AT_ONCE, _HASH_DIGITS = 50, 48

Entry = tuple[str, str]
"""The name of a root, and of what stands in it."""


class BadUpdate(ValueError):
    """The bytes are not a Yjs update, or do not fit this document; the document is as it was."""


class UpdateHole(BadUpdate):
    """Something is missing on which the update builds; pycrdt would pass over that and say nothing."""


class SharedDocument:
    """One Yjs document. Not to be used from two threads at once."""

    def __init__(self, updates: Iterable[bytes] = ()) -> None:
        """Build it from updates in any order; raises BadUpdate."""
        self._events: list[bytes] = []
        self._base = merge(updates)
        self._log: list[bytes] = []
        self._log_bytes = 0
        self._steps: dict[str, Any] = {}
        """The steps in their plain form, but for those that changed since it was asked for last."""
        self._changed: set[str] = set()
        self._count: int | None = None
        self._clocks: dict[int, int] | None = None
        """Of each client, or None while they are to be read again: who drew here in years may be thousands."""
        self._hashes: dict[Entry, int] = {}
        self._sum = 0
        """The sum of the entries' hashes."""
        self._unhashed: set[Entry] = set()
        self._deepest = 0
        self._document = self._restored()

    def apply_whole(self, update: bytes, said: Knowledge) -> list[bytes]:
        """Apply an update unless something is missing on which it builds; `said` is how far it goes.

        Returns what it changed. Raises UpdateHole, which leaves the document as it was, and BadUpdate.
        """
        self.check_whole(said)
        changes = self._apply(update)
        if changes != [update]:
            self._clocks = None
            if not is_within(said.clocks.items(), self.clocks()):
                self._document = self._restored()
                raise UpdateHole("It builds on what is not known.")
        self._note(changes)
        self._count_on(said, changes, update)
        return changes

    def check_whole(self, said: Knowledge) -> None:
        """Raise UpdateHole where something is missing on which an update builds; `said` is how far it goes."""
        clocks = self.clocks()
        if not (is_within(said.begins.items(), clocks) and is_within(said.needs.items(), clocks)):
            raise UpdateHole("It builds on what is not known.")
        known = {client: max(clocks.get(client, 0), said.clocks.get(client, 0)) for client in said.deletions}
        if not is_within(Knowledge({}, said.deletions).ends().items(), known):
            raise UpdateHole("It deletes what is not known.")

    def apply_slice(self, piece: Slice) -> list[bytes]:
        """Apply a piece of an update that was found whole, after those before it; returns what it changed.

        Raises BadUpdate.
        """
        changes = self._apply(piece.update)
        self._note(changes)
        if self._clocks is not None:
            self._clocks |= {client: max(end, self._clocks.get(client, 0)) for client, end in piece.clocks.items()}
        return changes

    def apply(self, update: bytes) -> list[bytes]:
        """Apply an update; returns what it changed, as the document itself says. Raises BadUpdate."""
        changes = self._apply(update)
        self._note(changes)
        self._clocks = None
        return changes

    def _apply(self, update: bytes) -> list[bytes]:
        self._events.clear()
        self._deepest = 0
        try:
            self._document.apply_update(update)
        except (ValueError, RuntimeError, MemoryError) as error:
            self._document = self._restored()
            raise BadUpdate(str(error)) from error
        if self._deepest > DEEPEST:
            self._document = self._restored()
            raise BadUpdate("Parts of it stand too deep in each other.")
        changes = [event for event in self._events if event != EMPTY_UPDATE]
        self._events.clear()
        return changes

    def _count_on(self, said: Knowledge, changes: list[bytes], update: bytes) -> None:
        """Bring the clocks up to an update that has been applied as it was."""
        if self._clocks is not None and changes == [update]:
            self._clocks |= {client: max(end, self._clocks.get(client, 0)) for client, end in said.clocks.items()}

    def clocks(self) -> Mapping[int, int]:
        """Return the number of each client's changes; not to be changed."""
        if self._clocks is None:
            self._clocks = decode_state_vector(self.state())
        return self._clocks

    def _note(self, changes: list[bytes]) -> None:
        """Keep what is needed to build the document again, should a later update fail half-way."""
        self._log.extend(changes)
        self._log_bytes += sum(map(len, changes))
        if self._log_bytes > _LOG_LIMIT_BYTES or len(self._log) > _LOG_LIMIT_ENTRIES:
            self.measure()

    def measure(self) -> int:
        """Return how many bytes all of the document is as one update."""
        self._base, self._log, self._log_bytes = self.encode(), [], 0
        return len(self._base)

    def _restored(self) -> Doc[Any]:
        try:
            document = _document_with(merge([self._base, *self._log]))
        except (ValueError, RuntimeError) as error:
            raise BadUpdate(str(error)) from error
        document.observe(self._on_change)
        steps = document.get("steps", type=Map)
        self._steps, self._changed, self._count, self._clocks = {}, set(steps.keys()), None, None
        others = {name: document.get(name, type=Map) for name in ROOTS if name != "steps"}
        watched = [(root, root.observe_deep(partial(self._on_others, name))) for name, root in others.items()]
        self._hashes, self._sum = {}, 0
        self._unhashed = {(name, key) for name, root in {"steps": steps, **others}.items() for key in root}
        self._watching = steps, steps.observe_deep(self._on_steps), watched  # it ends with the last reference to it
        return document

    def _on_change(self, event: TransactionEvent) -> None:
        self._events.append(event.update)

    def _note_depth(self, events: list[Any]) -> None:
        self._deepest = max(self._deepest, *(len(event.path) for event in events))

    def _on_others(self, root: str, events: list[Any]) -> None:
        self._note_depth(events)
        for event in events:
            self._unhashed.update((root, str(key)) for key in event.path[:1] or event.keys)

    def _on_steps(self, events: list[Any]) -> None:
        self._note_depth(events)
        for event in events:
            names = event.path[:1] or event.keys
            self._changed.update(names)
            self._unhashed.update(("steps", str(name)) for name in names)
            if not event.path:
                self._count = None

    def encode(self, state: bytes | None = None) -> bytes:
        """Return the document as one update: all of it, or what a peer in that state lacks. Raises BadUpdate."""
        try:
            return self._document.get_update(state)
        except ValueError as error:
            raise BadUpdate(str(error)) from error

    def state(self) -> bytes:
        """Return the state vector."""
        return self._document.get_state()

    def knowledge(self) -> Knowledge:
        """Return how far this document goes, deletions included."""
        state = self.state()
        reader = Reader(self.encode(state))
        reader.integer()  # of changes it lacks none of its own; what follows are the deletions
        return Knowledge(decode_state_vector(state), read_deletions(reader))

    def has_hole(self, updates: Iterable[bytes]) -> bool:
        """Tell whether something is missing on which these updates build, that were given to this document.

        The updates were checked when they came (`check_update`). pycrdt passes over holes and says nothing.
        """
        clocks = decode_state_vector(self.state())
        return not all(is_within(read_update(update).ends().items(), clocks) for update in updates)

    def step_count(self) -> int:
        """Return the number of steps, drafts included."""
        if self._count is None:
            self._count = len(self._document.get("steps", type=Map))
        return self._count

    def to_json(self) -> dict[str, Any]:
        """Return the plain form (docs/shapes/document.md); not to be changed in place.

        What no text may hold is read as if it were not there; what is named so is not read.
        A step that has not changed since the last call is the same object.
        """
        plain = self._plain_others()
        meta = plain.pop("meta")
        start = {"format": meta.get("format", FIRST_FORMAT), "start_pos": meta.get("start_pos")}
        return {**start, "steps": self._plain_steps(), **plain}

    def _plain_steps(self) -> dict[str, Any]:
        shared = self._document.get("steps", type=Map)
        for name in tuple(self._changed):
            if name in shared and not find_unfit(name):
                self._steps[name] = _plain_step(shared[name])
            else:
                self._steps.pop(name, None)
        self._changed.clear()
        return dict(self._steps)

    def _plain_others(self) -> dict[str, Any]:
        return {name: plain(self._document.get(name, type=Map).to_py() or {}) for name in ROOTS if name != "steps"}

    def migrate(self) -> bool:
        """Bring the content to today's format, by the same update whoever does it; tell whether there was a need.

        Old names that an old browser brings later are renamed by the next migrate.
        """
        before = self.to_json()
        after: Any = migrate({**before, "format": FIRST_FORMAT})
        if format_of(before) > FORMAT or after == before:
            return False
        copy = _document_with(self.encode(), _client_id(self.digest(), self.state()))
        with copy.transaction():
            copy.get("meta", type=Map)["format"] = after["format"]
            steps = copy.get("steps", type=Map)
            for name, step in sorted(after["steps"].items()):
                if step != before["steps"][name]:
                    _rewrite(steps, name, step)
        self.apply(copy.get_update(self.state()))
        return True

    def change_to(self, wanted: Mapping[str, Any]) -> None:
        """Become what a plain document says, by no more changes than that takes, so that other edits merge."""
        before, wanted, copy = self.to_json(), well_formed(wanted), _document_with(self.encode())
        with copy.transaction():
            meta, steps = copy.get("meta", type=Map), copy.get("steps", type=Map)
            _set_all(meta, {**meta.to_py(), "format": FORMAT, "start_pos": wanted.get("start_pos")})
            for name in [name for name in steps.keys() if name not in wanted["steps"]]:  # noqa: SIM118 - a Yjs map
                del steps[name]
            for name, step in wanted["steps"].items():
                if before["steps"].get(name) != step:
                    _set_step(steps, name, step)
            for root in _CONTENT[1:]:
                _set_all(copy.get(root, type=Map), wanted.get(root, {}))
        self.apply(copy.get_update(self.state()))

    def digest(self) -> str:
        """Return a hash of the content: two documents that hold the same have the same.

        Only entries of the roots that have changed since the last call are gone through.
        """
        self.hash_some(len(self._unhashed))
        return digest_of({"entries": f"{self._sum:x}"})

    def hash_some(self, most: int) -> bool:
        """Work out so many entries' hashes, so that `digest` has less to do; tell whether some are left."""
        roots = {name: self._document.get(name, type=Map) for name in ROOTS}
        for _ in range(min(most, len(self._unhashed))):
            root, name = entry = self._unhashed.pop()
            is_there = name in roots[root] and not find_unfit(name)
            new = _hash_of(entry, _plain_step(roots[root][name])) if is_there else 0
            self._sum += new - self._hashes.pop(entry, 0)
            if new:
                self._hashes[entry] = new
        return bool(self._unhashed)

    def hashes(self) -> dict[Entry, int]:
        """Return the hashes of the entries, which `know` of a document of the same content takes."""
        self.digest()
        return self._hashes

    def know(self, update: bytes, hashes: dict[Entry, int]) -> None:
        """Take over what is known of this very content: all of it as one update, and the hashes of its entries."""
        self._base, self._log, self._log_bytes = update, [], 0
        self._hashes, self._sum = hashes, sum(hashes.values())
        self._unhashed.clear()


def _document_with(update: bytes, client_id: int | None = None) -> Doc[Any]:
    document: Doc[Any] = Doc(client_id=client_id, allow_multithreading=True)
    for name in ROOTS:
        document.get(name, type=Map)
    document.apply_update(update)
    return document


def _plain_step(value: Any) -> Any:
    return plain(value.to_py() if isinstance(value, _SHARED) else value)


def _hash_of(entry: Entry, value: Any) -> int:
    root, name = entry
    return int(digest_of({root: {name: value}})[:_HASH_DIGITS], 16)


def _client_id(digest: str, state: bytes) -> int:
    """Return an author for changes that follow from the content alone: the same wherever the content is the same."""
    return int.from_bytes(hashlib.sha256(digest.encode() + state).digest()[:4])


def _set_step(steps: Any, name: str, wanted: Mapping[str, Any]) -> None:
    """Make a step what is wanted, field by field where it is shared so: what others do to the rest of it stays."""
    shared = steps.get(name)
    if isinstance(shared, Map):
        _set_all(shared, wanted, but="params")
        _rewrite(steps, name, wanted)
    else:
        steps[name] = Map({**wanted, "params": Map(dict(wanted["params"]))})


def _rewrite(steps: Any, name: str, wanted: Mapping[str, Any]) -> None:
    """Give a step other parameters, one by one where they are shared one by one."""
    step = steps[name]
    if not isinstance(step, Map):
        steps[name] = wanted
    elif isinstance(params := step.get("params"), Map):
        _set_all(params, wanted["params"])
    else:
        step["params"] = wanted["params"]


def _set_all(shared: Any, wanted: Mapping[str, Any], *, but: str = "") -> None:
    for name in sorted({*shared.keys(), *wanted} - {but}):
        if name not in wanted:
            del shared[name]
        elif name not in shared.keys() or plain(shared[name]) != wanted[name]:  # noqa: SIM118 - a Yjs map, no dict
            shared[name] = wanted[name]


def merge(updates: Iterable[bytes]) -> bytes:
    """Return one update that holds them all, whatever their order. Raises BadUpdate."""
    parts = [update for update in updates if update and update != EMPTY_UPDATE]
    try:
        while len(parts) > 1:  # few at a time: thousands at once take ten times as long, and hold all threads up
            parts = [_merged(parts[at : at + _MERGED_AT_ONCE]) for at in range(0, len(parts), _MERGED_AT_ONCE)]
    except ValueError as error:
        raise BadUpdate(str(error)) from error
    return parts[0] if parts else EMPTY_UPDATE


def _merged(updates: list[bytes]) -> bytes:
    return merge_updates(*updates) if len(updates) > 1 else updates[0]


def empty_document() -> dict[str, Any]:
    """Return the plain form of a program without steps."""
    return {"format": FORMAT, "start_pos": None, **{name: {} for name in _CONTENT}}


def migrate_document(plain: Mapping[str, Any]) -> dict[str, Any]:
    """Return a plain document, or a library function's definition, in today's format, with its texts cleaned."""
    migrated = migrate(plain)
    assert isinstance(migrated, Mapping)
    return dict(cleaned_json(migrated))


def encode_document(plain: Mapping[str, Any]) -> bytes:
    """Return a plain document as the first update of a shared one."""
    plain, document = well_formed(plain), Doc[Any]()
    roots = {name: document.get(name, type=Map) for name in ROOTS}
    with document.transaction():
        roots["meta"]["format"] = plain.get("format", FORMAT)
        if plain.get("start_pos") is not None:
            roots["meta"]["start_pos"] = plain["start_pos"]
        for step, body in plain["steps"].items():
            _set_step(roots["steps"], step, body)
        for name in _CONTENT[1:]:
            _set_all(roots[name], plain[name])
    return document.get_update()
