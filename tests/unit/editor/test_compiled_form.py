"""The compiled form of a room in several processes: all come to the same one, and it shows every edit."""

from __future__ import annotations

import json
from collections import deque
from dataclasses import dataclass, field
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from editor.documents.yjs_encoding import encode_integer
from editor.programs.compiled_patch import make_patch
from editor.rooms import yjs_protocol
from editor.rooms.compiled_form import CompiledForm, encode_check
from editor.rooms.member import Close
from editor.rooms.room import Room
from editor.rooms.stream import BEGINNING, Entry, Note
from tests.unit.editor.people import Client, room

NAMES = ("a", "b", "c")


def form_of(edits: set[str], revision: int) -> dict[str, Any]:
    lines = sorted(edits)
    return {
        "revision": revision, "script": "\n".join(lines), "lines": lines, "order": lines, "added_moves": [],
        "numbers": {line: str(number) for number, line in enumerate(lines, 1)}, "depth": dict.fromkeys(lines, 0),
        "diagnostics": [],
    }  # fmt: skip


def change_to(here: CompiledForm, form: dict[str, Any]) -> dict[str, Any]:
    """Return what a check says that found this form."""
    return form if here.now is None else make_patch(here.now, form)


@dataclass
class Process:
    """A process that edits, checks and hears, one thing at a time, in whatever order chance has it."""

    name: str
    stream: list[Entry]
    form: CompiledForm = field(init=False)
    edits: set[str] = field(default_factory=set)
    queue: deque[Note] = field(default_factory=deque)
    heard: int = 0
    touched: bool = False
    looking: tuple[set[str], str] | None = None

    def __post_init__(self) -> None:
        self.form = CompiledForm()

    @property
    def after(self) -> str:
        return self.stream[self.heard - 1].id if self.heard else BEGINNING

    def edit(self, clock: int) -> None:
        self.edits.add(f"{self.name}{clock}")
        self.queue.append(Note("update", f"{self.name}{clock}".encode()))
        self.touched = True

    def look(self, _clock: int) -> None:
        if self.touched and self.looking is None:
            self.touched, self.looking = False, (set(self.edits), self.after)

    def tell(self, clock: int) -> None:
        if self.looking is not None:
            (edits, after), self.looking = self.looking, None
            said = change_to(self.form, form_of(edits, clock))
            self.queue.append(encode_check(said, after=after, more=self.touched, against=""))

    def publish(self, _clock: int) -> None:
        while self.queue:
            self.stream.append(Entry(str(len(self.stream) + 1), self.name, self.queue.popleft()))

    def hear(self, _clock: int) -> None:
        if self.heard == len(self.stream):
            return
        entry = self.stream[self.heard]
        self.heard += 1
        if entry.note.kind == "update":
            self.edits.add(entry.note.data.decode())
            self.form.hear_update(entry)
        else:
            holds = self.form.hear(entry)
            self.touched |= self.name in self.form.not_shown() or not holds


ACTS = ("edit", "look", "tell", "publish", "hear", "die")


@settings(max_examples=400, deadline=None)
@given(st.lists(st.tuples(st.sampled_from(NAMES), st.sampled_from(ACTS)), max_size=80))
def test_every_order_of_events_ends_with_one_form_that_shows_every_edit(history: list[tuple[str, str]]) -> None:
    stream: list[Entry] = []
    alive = {name: Process(name, stream) for name in NAMES}
    for clock, (name, act) in enumerate(history):
        if act == "die" and len(alive) > 1:
            alive.pop(name, None)
        elif name in alive and act != "die":
            getattr(alive[name], act)(clock)
    for clock in range(1000, 1100):
        for process in alive.values():
            if process.form.not_shown() and clock % 10 == 9:  # as the room does after a while
                process.touched = True
            for act in ("look", "tell", "publish"):
                getattr(process, act)(clock * 10 + NAMES.index(process.name))
        for process in alive.values():
            while process.heard < len(stream):
                process.hear(clock)
        if not any(process.touched or process.form.not_shown() for process in alive.values()):
            break
    forms = [process.form.now for process in alive.values()]
    published = sorted(entry.note.data.decode() for entry in stream if entry.note.kind == "update")
    assert all(form == forms[0] for form in forms)
    assert (forms[0] or form_of(set(), 0))["lines"] == published


def ask(client: Client, revision: int = 0) -> None:
    client.send(encode_integer(yjs_protocol.COMPILED) + encode_integer(revision))


def told(client: Client) -> list[dict[str, Any]]:
    frames = [frame for frame in client.member.outbox if frame[0] == yjs_protocol.COMPILED]
    client.member.outbox.clear()
    return [json.loads(frame[frame.index(b"{") :]) for frame in frames]


def check(here: Room, form: dict[str, Any], entry: str) -> None:
    """Let a room's own check be heard from the stream."""
    note = encode_check(change_to(here.form, form), after=BEGINNING, more=False, against="")
    here.hear(Entry(entry, here.origin, note))


def test_who_looks_is_shown_the_whole_form_once_and_then_what_changed() -> None:
    here = room()
    looks, draws = Client(here, can_write=False), Client(here, number=2)
    ask(looks)
    assert here.touched
    check(here, form_of({"x"}, 1), "1")
    check(here, form_of({"x", "y"}, 2), "2")
    whole, patch = told(looks)
    assert (whole, told(draws)) == (form_of({"x"}, 1), [])
    assert (patch["base"], patch["script"]) == (1, [[1, 0, ["y"]]])


def test_who_comes_back_with_the_present_form_is_told_nothing_and_with_another_all() -> None:
    here = room()
    client = Client(here)
    check(here, form_of({"x"}, 7), "1")
    client.member.outbox.clear()
    ask(client, 7)
    assert told(client) == []
    ask(client, 6)
    assert told(client) == [form_of({"x"}, 7)]


def test_a_process_without_a_form_whose_people_look_checks_when_it_hears_only_of_changes() -> None:
    here, late = room("here"), room("late")
    check(here, form_of({"x"}, 1), "1")
    note = encode_check(change_to(here.form, form_of({"y"}, 2)), after=BEGINNING, more=False, against="")
    late.hear(Entry("2", "here", note))
    assert (late.form.now, late.touched) == (None, False)
    client = Client(late)
    ask(client)
    late.touched = False
    late.hear(Entry("3", "here", note))
    assert late.touched


def test_asking_for_a_large_form_again_and_again_is_abuse() -> None:
    here = room()
    client = Client(here)
    check(here, form_of({"x" * 1_000_000}, 1), "1")
    with pytest.raises(Close) as refused:
        any(ask(client) for _ in range(20))
    assert refused.value.code == Close.ABUSE
