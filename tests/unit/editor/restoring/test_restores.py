"""What is restored while others draw takes nothing of theirs."""

from __future__ import annotations

from typing import Any

import pytest
from pycrdt import Map

from editor.documents.shared_document import SharedDocument, encode_document
from editor.language.comparison.changes import apply_changes
from editor.language.comparison.needs import restore_some
from tests.kit.drawn.restores import lost_in_a_restore
from tests.kit.programs import document, step


@pytest.mark.parametrize("seed", range(40))
def test_nobody_elses_edit_is_lost_in_a_restore(seed: int) -> None:
    assert lost_in_a_restore(seed) == []


def test_a_step_that_goes_back_to_its_place_keeps_what_is_typed_into_it_meanwhile() -> None:
    then = document({"w": step("while"), "a": step("wait", ("w", "body"), duration=1)})
    room = SharedDocument([encode_document({**then, "steps": {**then["steps"], "a": step("wait", duration=1)}})])
    other = SharedDocument([room.encode()])
    typed = other._document.get("steps", type=Map)["a"]["params"]
    typed["duration"] = 7
    now: dict[str, Any] = room.to_json()
    room.change_to(apply_changes(now, restore_some(now, then, [("steps", "a")]).changes))
    room.apply(other.encode(room.state()))
    after = room.to_json()["steps"]["a"]
    assert (after["place"], after["params"]) == (["w", "body", "1V"], {"duration": 7})
