"""The shared document and its plain form."""

from __future__ import annotations

import random
from typing import Any

import pytest
from pycrdt import Doc, Map

from editor.documents.shared_document import (
    BadUpdate,
    SharedDocument,
    digest_of,
    empty_document,
    encode_document,
    merge,
)
from editor.documents.yjs_encoding import decode_state_vector
from editor.documents.yjs_updates import check_update

PLAIN: dict[str, Any] = {
    "format": 1,
    "start_pos": [2.5, -3],
    "steps": {
        "s1": {"kind": "wait", "place": ["program", "body", "a"], "pos": [1, 2], "params": {"seconds": 5}},
        "s2": {"kind": "if", "place": None, "pos": None, "params": {"condition": {"op": "<", "args": [1.5, True]}}},
    },
    "functions": {"f1": {"name": "Rest", "parameters": [{"name": "minutes", "type": "number", "unit": "MIN"}]}},
    "roles": {"robot": {"name": "Robot", "can": []}},
    "parameters": {},
    "zones": {},
}


def test_a_plain_document_comes_back() -> None:
    assert SharedDocument([encode_document(PLAIN)]).to_json() == PLAIN


def test_an_empty_document_has_all_its_parts() -> None:
    assert SharedDocument([encode_document(empty_document())]).to_json() == empty_document()
    assert SharedDocument().to_json() == {**empty_document(), "format": 1}
    assert SharedDocument([encode_document(empty_document())]).to_json() == empty_document()


def test_a_step_is_a_shared_map_so_that_two_may_change_it_at_once() -> None:
    document: Doc[Any] = Doc()
    document.apply_update(encode_document(PLAIN))
    steps = document.get("steps", type=Map)
    assert isinstance(steps["s1"], Map)
    assert isinstance(steps["s1"]["params"], Map)
    assert steps["s1"]["place"] == ["program", "body", "a"]


def test_numbers_are_as_they_were_typed() -> None:
    plain = SharedDocument([encode_document(PLAIN)]).to_json()
    assert isinstance(plain["steps"]["s1"]["params"]["seconds"], int)
    assert isinstance(plain["steps"]["s2"]["params"]["condition"]["args"][0], float)
    assert plain["steps"]["s2"]["params"]["condition"]["args"][1] is True


def test_two_documents_that_hold_the_same_have_one_digest() -> None:
    assert SharedDocument([encode_document(PLAIN)]).digest() == SharedDocument([encode_document(PLAIN)]).digest()
    assert digest_of(PLAIN) != digest_of(empty_document())


def test_the_digest_after_edits_is_that_of_a_document_that_is_read_anew() -> None:
    document = SharedDocument([encode_document(PLAIN)])
    before = document.digest()
    assert document.digest() == before
    for steps in ({**PLAIN["steps"], "new": PLAIN["steps"]["s1"]}, {"s1": PLAIN["steps"]["s1"]}, PLAIN["steps"]):
        document.change_to({**PLAIN, "steps": steps})
        assert document.digest() == SharedDocument([document.encode()]).digest()
    document.change_to({**PLAIN, "steps": {**PLAIN["steps"], "s1": {**PLAIN["steps"]["s1"], "pos": [7, 7]}}})
    assert document.digest() == SharedDocument([document.encode()]).digest() != before


def test_what_is_no_update_is_refused_and_changes_nothing() -> None:
    document = SharedDocument([encode_document(PLAIN)])
    for noise in (b"\xff" * 1000, b"\x01\xff\xff\xff\xff\x0f", b"\x00"):
        with pytest.raises(BadUpdate):
            document.apply(noise)
    assert document.to_json() == PLAIN


def test_an_update_that_is_already_known_changes_nothing() -> None:
    update = encode_document(PLAIN)
    document = SharedDocument([update])
    assert document.apply(update) == []


def histories() -> list[tuple[list[bytes], str]]:
    """Return updates of three people who edit at once, in the order of happening, with the digest they lead to."""
    found = []
    for seed in range(20):
        dice, updates = random.Random(seed), []
        documents = [Doc(client_id=number + 1) for number in range(3)]
        for document in documents:
            document.get("steps", type=Map)
        for turn in range(40):
            document = dice.choice(documents)
            before, steps = document.get_state(), document.get("steps", type=Map)
            key = dice.choice("abcde")
            if key in steps and turn % 3 == 0:
                del steps[key]
            elif key in steps:
                steps[key]["pos"] = [turn, 0]
            else:
                steps[key] = Map({"kind": "wait", "params": Map({})})
            updates.append(document.get_update(before))
            if dice.random() < 0.7:
                for other in documents:
                    other.apply_update(merge(updates))
        final = SharedDocument()
        for update in updates:
            final.apply(update)
        found.append((updates, final.digest()))
    return found


def test_loading_does_not_depend_on_the_order_of_the_rows() -> None:
    dice = random.Random(1)
    for updates, digest in histories():
        shuffled = dice.sample(updates, len(updates))
        assert SharedDocument(shuffled).digest() == digest
        half = merge(shuffled[:20])
        assert SharedDocument([half, *shuffled[10:]]).digest() == digest


def test_what_is_told_is_enough_to_follow() -> None:
    for updates, digest in histories():
        leader, follower = SharedDocument(), SharedDocument()
        for update in updates:
            for change in leader.apply(update):
                follower.apply(change)
        assert follower.digest() == leader.digest() == digest


def old_document() -> SharedDocument:
    steps = {"w": {"kind": "wait", "params": {"seconds": 5}}, "u": {"kind": "wait", "params": {"timeout_s": 9}}}
    return SharedDocument([encode_document({"format": 1, "steps": steps})])


def test_an_old_document_climbs_by_the_same_update_in_every_process() -> None:
    first, second = old_document(), SharedDocument([old_document().encode()])
    before = first.encode()
    second = SharedDocument([before])
    assert first.migrate()
    assert second.migrate()
    assert first.encode() == second.encode()
    assert first.to_json()["format"] == 2
    assert first.to_json()["steps"]["w"]["params"] == {"duration": 5}
    assert first.to_json()["steps"]["u"]["params"] == {"timeout": 9}
    assert not first.migrate()
    assert SharedDocument([before, first.encode(), second.encode()]).digest() == first.digest()


def test_two_processes_that_climb_from_different_states_meet() -> None:
    first = old_document()
    second = SharedDocument([first.encode()])
    steps = {"x": {"kind": "wait", "params": {"seconds": 1}}}
    second.apply(encode_document({"format": 1, "steps": steps}))
    assert first.migrate()
    assert second.migrate()
    third = SharedDocument([first.encode(), second.encode()])
    assert third.to_json() == SharedDocument([second.encode(), first.encode()]).to_json()
    assert third.to_json()["steps"]["x"]["params"] == {"duration": 1}
    assert third.to_json()["steps"]["w"]["params"] == {"duration": 5}


def test_a_document_of_a_later_format_does_not_climb() -> None:
    document = SharedDocument([encode_document({"format": 9, "steps": {}})])
    before = document.encode()
    assert not document.migrate()
    assert document.encode() == before


def test_steps_that_are_not_shared_piece_by_piece_climb_whole() -> None:
    raw: Doc[Any] = Doc()
    steps = raw.get("steps", type=Map)
    steps["plain"] = {"kind": "wait", "params": {"seconds": 1}}
    steps["half"] = Map({"kind": "wait", "params": {"seconds": 2}})
    steps["odd"] = 5
    document = SharedDocument([raw.get_update()])
    assert document.migrate()
    assert {name: step for name, step in document.to_json()["steps"].items() if name != "odd"} == {
        "plain": {"kind": "wait", "params": {"duration": 1}},
        "half": {"kind": "wait", "params": {"duration": 2}},
    }


@pytest.mark.parametrize("tell", [True, False])
def test_the_clocks_are_those_of_the_state_vector_after_every_change(tell: bool) -> None:
    clients: list[Doc[Any]] = [Doc(client_id=number) for number in range(1, 5)]
    document, chance = SharedDocument(), random.Random(7)
    for number in range(200):
        client = chance.choice(clients)
        client.apply_update(document.encode())
        before, steps = client.get_state(), client.get("steps", type=Map)
        if (name := f"s{chance.randrange(9)}") in steps and chance.random() < 0.3:
            del steps[name]
        else:
            steps[name] = Map({"pos": [number, 0]})
        update = client.get_update(before)
        if tell:
            document.apply_whole(update, check_update(update, {b"steps"}))
        else:
            document.apply(update)
        assert document.clocks() == decode_state_vector(document.state())
        assert document.step_count() == len(document.to_json()["steps"]) == len(steps)


def test_the_clocks_stop_at_a_hole() -> None:
    client: Doc[Any] = Doc(client_id=1)
    document = SharedDocument()
    document.clocks()
    parts = []
    for number in range(3):
        before = client.get_state()
        client.get("steps", type=Map)["s1"] = Map({"pos": [number, 0]})
        parts.append(client.get_update(before))
    document.apply(parts[0])
    document.apply(parts[2])
    assert document.clocks() == decode_state_vector(document.state())


def test_the_clocks_are_right_after_an_update_that_was_undone() -> None:
    document = SharedDocument([encode_document({**empty_document(), "steps": {"s1": {"kind": "wait"}}})])
    before = dict(document.clocks())
    with pytest.raises(BadUpdate):
        document.apply(b"\x05\xff\xff\xff\x0f")
    assert document.clocks() == decode_state_vector(document.state()) == before
    assert document.step_count() == 1
