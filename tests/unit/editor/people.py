"""Connections without a network, for rooms in tests."""

from __future__ import annotations

from dataclasses import dataclass, field

from pycrdt import Doc, Map

from editor.documents.shared_document import SharedDocument
from editor.rooms import yjs_protocol
from editor.rooms.member import Member, Person
from editor.rooms.room import Room
from editor.rooms.stream import Entry, Note
from tests.kit.drawn.frames import read_frame


def nobody() -> None:
    """Nobody sends."""


@dataclass
class Client:
    """A Yjs client: its own document, joined to a room through the frames it exchanges."""

    room: Room
    person: Person = field(default_factory=lambda: Person(1, "Ada Author", "AA"))
    can_write: bool = True
    number: int = 1
    member: Member = field(init=False)
    document: Doc = field(init=False)
    refused: str = ""

    def __post_init__(self) -> None:
        self.member = Member(self.person, can_write=self.can_write, wake=nobody)
        self.document = Doc(client_id=self.number)
        self.document.get("steps", type=Map)
        self.room.join(self.member)

    def send(self, frame: bytes, now_s: float = 0.0) -> None:
        self.room.receiver.receive(self.member, frame, now_s)

    def edit(self, step: str, x: float) -> bytes:
        """Change the client's own document; returns the update, which is not sent yet."""
        before = self.document.get_state()
        self.document.get("steps", type=Map)[step] = Map({"kind": "wait", "pos": [x, 0], "params": Map({})})
        return self.document.get_update(before)

    def read(self) -> list[yjs_protocol.Message]:
        """Take the frames that were sent, answer the questions among them, apply the changes."""
        read = []
        self.room.spread()
        while self.member.outbox:
            frame = self.member.outbox.popleft()
            if frame[0] in (yjs_protocol.SAVED, yjs_protocol.REFUSAL):
                continue
            message = read_frame(frame)
            read.append(message)
            if isinstance(message, yjs_protocol.SyncStep1):
                self.send(yjs_protocol.encode_step_2(self.document.get_update(message.state)))
            elif isinstance(message, yjs_protocol.SyncStep2 | yjs_protocol.Update):
                self.document.apply_update(message.update)
        return read

    def steps(self) -> dict[str, object]:
        return SharedDocument([self.document.get_update()]).to_json()["steps"]


def room(origin: str = "here") -> Room:
    """Return an empty room."""
    return Room("program", "hall", origin, SharedDocument())


class TwoProcesses:
    """Two rooms of the same program, joined by a stream that may lose things."""

    def __init__(self) -> None:
        self.rooms = {"a": room("a"), "b": room("b")}
        self.number = 0

    def carry(self, lose: bool = False) -> None:
        for _ in range(10):
            for origin, source in self.rooms.items():
                while source.to_publish:
                    note = source.to_publish.popleft()
                    if not lose:
                        self.deliver(origin, note)

    def deliver(self, origin: str, note: Note) -> None:
        self.number += 1
        for name, target in self.rooms.items():
            if name != origin:
                target.hear(Entry(str(self.number), origin, note))

    def pair(self) -> tuple[Room, Room]:
        return self.rooms["a"], self.rooms["b"]
