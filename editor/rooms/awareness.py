"""Who is here and what they point at; a connection speaks only for the clients it introduced, under its own name."""

from __future__ import annotations

import json

from editor.rooms.member import Close, Member
from editor.rooms.yjs_protocol import AwarenessEntry

MOST_CLIENTS_PER_MEMBER = 4
MOST_STATE_BYTES = 4096
MOST_REMEMBERED = 1000


class AwarenessBoard:
    """The states of all clients in a room, here and in other processes."""

    def __init__(self) -> None:
        self._states: dict[int, AwarenessEntry] = {}
        self._owners: dict[int, Member] = {}
        self._elsewhere: dict[int, str] = {}
        self._left: dict[int, int] = {}
        self._changed_here: set[int] = set()
        self._changed_elsewhere: set[int] = set()

    @property
    def has_news(self) -> bool:
        """Whether something has changed since `take_changes` was called."""
        return bool(self._changed_here or self._changed_elsewhere)

    def speaks_for_itself(self, member: Member, entries: tuple[AwarenessEntry, ...]) -> bool:
        """Tell whether a message has anything of the sender's own: clients also repeat what they hear of others."""
        return any(self._may_speak(member, entry) for entry in entries)

    def _may_speak(self, member: Member, entry: AwarenessEntry) -> bool:
        owner = self._owners.get(entry.client)
        if owner is not None:
            return owner is member
        if entry.state is None or entry.client in self._elsewhere:
            return False
        return entry.clock > self._left.get(entry.client, -1)  # else a late echo would bring back who has left

    def take(self, member: Member, entries: tuple[AwarenessEntry, ...]) -> None:
        """Take what a member shows of itself; what it says of others is passed over. Raises Close."""
        for entry in entries:
            if self._may_speak(member, entry):
                self._take_own(member, entry)

    def _take_own(self, member: Member, entry: AwarenessEntry) -> None:
        known = self._states.get(entry.client)
        if known is not None and entry.clock <= known.clock and entry.state is not None:
            return
        if entry.client not in member.clients and len(member.clients) >= MOST_CLIENTS_PER_MEMBER:
            raise Close(Close.ABUSE, f"One connection speaks for more than {MOST_CLIENTS_PER_MEMBER} clients.")
        state = None if entry.state is None else {**entry.state, "user": member.person.shown()}
        if state is not None and len(json.dumps(state)) > MOST_STATE_BYTES:
            raise Close(Close.TOO_LARGE, f"A client may show {MOST_STATE_BYTES} bytes of itself, not more.")
        self._owners[entry.client] = member
        member.clients.add(entry.client)
        self._states[entry.client] = AwarenessEntry(entry.client, entry.clock, state)
        self._changed_here.add(entry.client)

    def drop(self, member: Member) -> None:
        """Take a member's clients off the board; everybody is told."""
        for client in member.clients:
            self._owners.pop(client, None)
            known = self._states.get(client)
            if known is not None:
                self._states[client] = AwarenessEntry(client, known.clock, None)
                self._changed_here.add(client)
        member.clients.clear()

    def hear(self, origin: str, entries: tuple[AwarenessEntry, ...]) -> None:
        """Take what another process says of its clients."""
        for entry in entries:
            if entry.client in self._owners:
                continue
            self._elsewhere[entry.client] = origin
            self._states[entry.client] = entry
            self._changed_elsewhere.add(entry.client)

    def forget_process(self, origin: str) -> None:
        """Take the clients of a process that has gone off the board."""
        for client in [c for c, where in self._elsewhere.items() if where == origin]:
            self._states[client] = AwarenessEntry(client, self._states[client].clock, None)
            self._changed_elsewhere.add(client)

    def take_changes(self) -> tuple[list[AwarenessEntry], list[AwarenessEntry]]:
        """Return what changed since the last call: here, and elsewhere. Clients that have left are then forgotten."""
        here = [self._states[c] for c in sorted(self._changed_here)]
        elsewhere = [self._states[c] for c in sorted(self._changed_elsewhere)]
        self._changed_here.clear()
        self._changed_elsewhere.clear()
        for entry in (*here, *elsewhere):
            if entry.state is None:
                self._forget(entry.client)
        return here, elsewhere

    def _forget(self, client: int) -> None:
        known = self._states.pop(client, None)
        if known is not None:
            self._left[client] = known.clock
        while len(self._left) > MOST_REMEMBERED:
            del self._left[next(iter(self._left))]
        self._elsewhere.pop(client, None)
        owner = self._owners.pop(client, None)
        if owner is not None:
            owner.clients.discard(client)

    def everybody(self) -> list[AwarenessEntry]:
        """Return all that is shown now."""
        return [entry for entry in self._states.values() if entry.state is not None]

    def here(self) -> list[AwarenessEntry]:
        """Return what this process's own clients show."""
        return [self._states[c] for c in self._owners if self._states[c].state is not None]
