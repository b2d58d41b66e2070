"""The shared document: a Yjs document and its plain JSON form. The one importer of pycrdt.

pycrdt integrates updates wrongly when they come out of order (it passes over holes), so whatever may be out of order
is merged into one update first, which is right; and an update that fails half-way is undone.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Collection, Iterable, Mapping
from typing import Any

from pycrdt import Array, Doc, Map, Text, TransactionEvent, merge_updates

from editor.documents.knowledge import Knowledge, read_deletions
from editor.documents.yjs_encoding import BadFrame, Reader, decode_state_vector, is_within
from editor.documents.yjs_updates import MOST_CLIENTS_OF_ALL, check_update
from editor.language.document.format_migrations import FIRST_FORMAT, FORMAT, format_of, migrate
from editor.language.reading.well_formed import well_formed
from vipo_device.protocol.texts import cleaned, cleaned_json, find_unfit, normal

ROOTS = ("meta", "steps", "functions", "roles", "parameters", "zones")
_CONTENT = ROOTS[1:]
EMPTY_UPDATE = b"\x00\x00"
DEEPEST = 32
"""How deep shared parts may stand in each other: each way to read them goes down by calling itself."""
_LOG_LIMIT_BYTES = 1024 * 1024
_LOG_LIMIT_ENTRIES = 2000
_SHARED = (Array, Map, Text)
_MERGED_AT_ONCE, _HASH_DIGITS = 50, 48
_SAFE_INTEGER = 2**53


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
        self._hashes: dict[str, int] = {}
        self._sum = 0
        """The sum of the steps' hashes."""
        self._unhashed: set[str] = set()
        self._deepest = 0
        self._document = self._restored()

    def apply_whole(self, update: bytes, said: Knowledge) -> list[bytes]:
        """Apply an update unless something is missing on which it builds; `said` is how far it goes.

        Returns what it changed. Raises UpdateHole, which leaves the document as it was, and BadUpdate.
        """
        clocks = self.clocks()
        if not is_within(said.begins.items(), clocks):
            raise UpdateHole("It begins after what is known of its client.")
        known = {client: max(clocks.get(client, 0), said.clocks.get(client, 0)) for client in said.deletions}
        if not is_within(Knowledge({}, said.deletions).ends().items(), known):
            raise UpdateHole("It deletes what is not known.")
        changes = self._apply(update)
        if changes != [update]:
            self._clocks = None
            if not is_within(said.clocks.items(), self.clocks()):
                self._document = self._restored()
                raise UpdateHole("It builds on what is not known.")
        self._note(changes)
        self._count_on(said, changes, update)
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
            self._base, self._log, self._log_bytes = self.encode(), [], 0

    def _restored(self) -> Doc[Any]:
        try:
            document = _document_with(merge([self._base, *self._log]))
        except (ValueError, RuntimeError) as error:
            raise BadUpdate(str(error)) from error
        document.observe(self._on_change)
        steps = document.get("steps", type=Map)
        self._steps, self._changed, self._count, self._clocks = {}, set(steps.keys()), None, None
        self._hashes, self._sum, self._unhashed = {}, 0, set(steps.keys())
        others = [document.get(name, type=Map) for name in _CONTENT if name != "steps"]
        watched = [(root, root.observe_deep(self._note_depth)) for root in others]
        self._watching = steps, steps.observe_deep(self._on_steps), watched  # it ends with the last reference to it
        return document

    def _on_change(self, event: TransactionEvent) -> None:
        self._events.append(event.update)

    def _note_depth(self, events: list[Any]) -> None:
        self._deepest = max(self._deepest, *(len(event.path) for event in events))

    def _on_steps(self, events: list[Any]) -> None:
        self._note_depth(events)
        for event in events:
            names = event.path[:1] or event.keys
            self._changed.update(names)
            self._unhashed.update(names)
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
        return {name: _plain(self._document.get(name, type=Map).to_py() or {}) for name in ROOTS if name != "steps"}

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
                known = before["steps"].get(name)
                if not isinstance(known, Mapping) or {**known, "params": 0} != {**step, "params": 0}:
                    steps[name] = Map({**step, "params": Map(dict(step["params"]))})
                elif known != step:
                    _rewrite(steps, name, step)
            for root in _CONTENT[1:]:
                _set_all(copy.get(root, type=Map), wanted.get(root, {}))
        self.apply(copy.get_update(self.state()))

    def digest(self) -> str:
        """Return a hash of the content: two documents that hold the same have the same.

        Only steps that have changed since the last call are gone through.
        """
        shared = self._document.get("steps", type=Map)
        for name in self._unhashed:
            is_there = name in shared and not find_unfit(name)
            new = _hash_of(name, _plain_step(shared[name])) if is_there else 0
            self._sum += new - self._hashes.pop(name, 0)
            if new:
                self._hashes[name] = new
        self._unhashed.clear()
        return digest_of({**self._plain_others(), "steps": f"{self._sum:x}"})

    def hashes(self) -> dict[str, int]:
        """Return the hashes of the steps, which `know_hashes` of a document of the same content takes."""
        self.digest()
        return self._hashes

    def know_hashes(self, hashes: dict[str, int]) -> None:
        """Take over the hashes of the steps, so that they are not worked out again."""
        self._hashes, self._sum = hashes, sum(hashes.values())
        self._unhashed.clear()


def _document_with(update: bytes, client_id: int | None = None) -> Doc[Any]:
    document: Doc[Any] = Doc(client_id=client_id, allow_multithreading=True)
    for name in ROOTS:
        document.get(name, type=Map)
    document.apply_update(update)
    return document


def _plain_step(value: Any) -> Any:
    return _plain(value.to_py() if isinstance(value, _SHARED) else value)


def _hash_of(name: str, step: Any) -> int:
    return int(digest_of({name: step})[:_HASH_DIGITS], 16)


def _client_id(digest: str, state: bytes) -> int:
    """Return an author for changes that follow from the content alone: the same wherever the content is the same."""
    return int.from_bytes(hashlib.sha256(digest.encode() + state).digest()[:4])


def _rewrite(steps: Any, name: str, wanted: Mapping[str, Any]) -> None:
    """Give a step other parameters, one by one where they are shared one by one."""
    step = steps[name]
    params = step["params"] if isinstance(step, Map) else None
    if not isinstance(step, Map):
        steps[name] = wanted
    elif not isinstance(params, Map):
        step["params"] = wanted["params"]
    else:
        _set_all(params, wanted["params"])


def _set_all(shared: Any, wanted: Mapping[str, Any]) -> None:
    for name in sorted({*shared.keys(), *wanted}):
        if name not in wanted:
            del shared[name]
        elif name not in shared.keys() or _plain(shared[name]) != wanted[name]:  # noqa: SIM118 - a Yjs map, no dict
            shared[name] = wanted[name]


def clients_of(update: bytes) -> Collection[int]:
    """Return the Yjs clients whose changes an update brings."""
    return read_update(update).clocks.keys()


def read_update(update: bytes) -> Knowledge:
    """Return how far a checked update goes; nothing of one that was written when other bounds held."""
    try:
        return check_update(update, {root.encode() for root in ROOTS}, MOST_CLIENTS_OF_ALL)
    except BadFrame:
        return Knowledge({}, {})


def merge(updates: Iterable[bytes]) -> bytes:
    """Return one update that holds them all, whatever their order. Raises BadUpdate."""
    parts = [update for update in updates if update and update != EMPTY_UPDATE]
    if not parts:
        return EMPTY_UPDATE
    try:
        while len(parts) > 1:  # few at a time: thousands at once take ten times as long, and hold all threads up
            parts = [_merged(parts[at : at + _MERGED_AT_ONCE]) for at in range(0, len(parts), _MERGED_AT_ONCE)]
    except ValueError as error:
        raise BadUpdate(str(error)) from error
    return parts[0]


def _merged(updates: list[bytes]) -> bytes:
    return merge_updates(*updates) if len(updates) > 1 else updates[0]


def digest_of(document: Mapping[str, Any]) -> str:
    """Return a hash of a plain document's content."""
    text = json.dumps(document, sort_keys=True, separators=(",", ":"), ensure_ascii=True)
    return hashlib.sha256(text.encode()).hexdigest()


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
            roots["steps"][step] = Map({**body, "params": Map(dict(body["params"]))})
        for name in _CONTENT[1:]:
            for key, value in plain[name].items():
                roots[name][key] = value
    return document.get_update()


def _plain(value: Any) -> Any:
    """Return JSON with whole numbers as integers, as they were typed: Yjs knows only one kind of number."""
    if isinstance(value, str):
        return cleaned(value)
    if isinstance(value, dict):
        return {normal(key): _plain(item) for key, item in value.items() if not find_unfit(key)}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, float):
        return _number(value)
    if value is None or isinstance(value, bool | int):
        return value
    return None  # bytes and the like are not JSON: a value that is still to be entered


def _number(value: float) -> float | int | None:
    if not math.isfinite(value):
        return None
    return int(value) if value.is_integer() and abs(value) < _SAFE_INTEGER else value
