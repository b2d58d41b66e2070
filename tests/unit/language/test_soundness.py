"""Programs by chance that check clean do nothing that their text tells to be wrong; the command tries ten thousand."""

from __future__ import annotations

import random
from typing import Any

from editor.language import compile_document
from scripts.soundness import Judge, try_programs
from tests.kit.demo_site import factory

PICK = {"role": "robot", "at": {"device": "itemInventory01"}, "object": "box", "quantity": 1}


def test_a_program_that_checks_clean_does_not_fail_for_what_its_text_tells() -> None:
    tried = list(try_programs(200, seed=11, site=factory()))
    assert [wrong for _, _, wrong in tried if wrong] == []
    assert sum(clean for _, clean, _ in tried) > 30


def test_the_judge_sees_what_a_robot_cannot_carry() -> None:
    steps: dict[str, Any] = {
        "s0": {"kind": "repeat", "place": ["program", "body", "V"], "params": {"times": 2}},
        "s1": {"kind": "pick", "place": ["s0", "body", "V"], "params": PICK},
    }
    plan = compile_document({"format": 2, "steps": steps}, factory()).plan
    assert plan is not None
    assert Judge(plan, random.Random(1)).run() == ""
    assert Judge(plan, random.Random(1), carried=1).run() == "pick leaves 3 at the step s1"
