"""docs/api.md and docs/shapes/program-socket.md say the limits of the program socket that the code holds."""

from __future__ import annotations

import pytest

from editor.documents import shared_document, yjs_updates
from editor.rooms import hub, member, receiver, room, yjs_protocol
from tests.kit.files import ROOT

MIB = 1024 * 1024
SENTENCES = {
    "docs/api.md": [
        f"A frame of a program has {yjs_protocol.MOST_FRAME_BYTES // MIB} MiB at most, a program "
        f"{receiver.MOST_DOCUMENT_BYTES // MIB} MiB and {receiver.MOST_STEPS:,} steps; {room.MOST_READERS} who only "
        f"look and {room.MOST_WRITERS} who may draw are in it at once.",
        f"{hub.MOST_OF_PERSON} programs in a process and {room.MOST_OF_PERSON} of one program",
        f"more than {member.FRAMES_PER_S:g} frames or {member.BYTES_PER_S / MIB:g} MiB a second",
    ],
    "docs/shapes/program-socket.md": [
        f"Frames may have up to {yjs_protocol.MOST_FRAME_BYTES // MIB} MiB; a larger one closes with 4413.",
        f"values nested more than {yjs_updates.DEEPEST} times, shared parts nested more than "
        f"{yjs_updates.MOST_NESTED} times ({shared_document.DEEPEST} in the document), more than "
        f"{yjs_updates.MOST_CLIENTS} clients ({yjs_updates.MOST_CLIENTS_OF_ALL:,} in what a client has in all) or "
        f"{yjs_updates.MOST_PARTS:,} changes, values and deletions, more than {yjs_updates.MOST_VALUES:,} values",
        f"one program open {room.MOST_OF_PERSON} times by a person, or {hub.MOST_OF_PERSON} openings of theirs in a "
        "process |",
        f"there are {room.MOST_WRITERS} who may draw or {room.MOST_READERS} who may only look already",
        f"{member.FRAMES_PER_S:g} messages a second ({member.BURST_FRAMES:g} at once) and "
        f"{member.BYTES_PER_S / MIB:g} MiB ({member.BURST_BYTES / MIB:g} at once)",
        f"{member.AWARENESS_PER_S:g} a second, {member.BURST_AWARENESS:,g} at once",
        f"at most {member.PARTS_PER_S:,g} changes, values and deletions a second, {member.BURST_PARTS:,.0f} at once",
        f"{member.WORK_PER_S:g} s of the server\u2019s time in a second, {member.BURST_WORK_S:g} s at once; after "
        f"that their messages wait, {member.MOST_WAITING_BYTES // MIB} MiB of them at most",
        f"A sync step 1 may name {yjs_protocol.MOST_STATE_VECTOR_CLIENTS:,} clients, and a message about who is here "
        f"may have {yjs_protocol.MOST_AWARENESS_FRAME_BYTES // MIB} MiB. An update above "
        f"{receiver.LIGHT_BYTES // 1024} KiB is applied in pieces",
        f"changes of at most {yjs_updates.MOST_CLIENTS_EVER:,} clients",
    ],
}


@pytest.mark.parametrize("page", SENTENCES)
def test_a_page_says_the_limits_that_hold(page: str) -> None:
    text = (ROOT / page).read_text(encoding="utf-8")
    assert [sentence for sentence in SENTENCES[page] if sentence not in text] == []
