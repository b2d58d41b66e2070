"""What holds in a rehearsal, and what is said of what does not."""

from typing import get_args

import pytest

from execution.trials.expectations import Seen, judge
from execution.trials.trial import Expectation, ExpectationKind
from tests.kit.files import ROOT

SQUARE = ((0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0))


def seen(**more):
    result = {
        "ok": True, "duration_s": 90.0, "errors": [], "collisions": [],
        "carrying": {"r1": [[0, {}], [5, {"box": 2}]]},
        "frames": {"dt_s": 0.5, "robots": {
            "r1": [[0, 5, 0], [1, 1, 0], [1, 1.5, 0], [5, 5, 0]], "r2": [[1, 1, 0], [9, 9, 0], [0.5, 0.5, 0]]}},
        "log": [{"code": "command", "device": d, "t": 1.0, "args": {"method": m}}
                for d, m in (("r1", "pick"), ("oven", "heat"), ("r1", "drop"), ("hall.oven", "bake"))],
        "properties": {"oven": [[0.0, "heat", 20], [7.0, "heat", 55.5], [8.0, "lid", "open"], [9.0, "on", True]]},
        "steps": [{"step": "s1"}, {"step": "s1"}],
        **more,
    }  # fmt: skip
    return Seen(result, {"oven": {"box": 1}}, {"hall": SQUARE}, {"dock": (1.0, 1.0)}, {"s1": "7b"})


FAILED = {
    "ok": False,
    "errors": [{"t": 30.0, "step": "s1", "kind": "timed_out", "message": "The Oven does not answer."}],
}


@pytest.mark.parametrize(
    ("kind", "says", "holds", "saw"),
    [
        ("ends", "well", True, "it ended well after 90 s"),
        ("fails", "oven", False, "it ended well after 90 s"),
        ("within_s", 90.0, True, "it took 90 s"),
        ("within_s", 89.0, False, "it took 90 s"),
        ("item", {"object": "box", "at": "oven"}, True, "it holds 1"),
        ("item", {"object": "box", "at": "r1", "count": 2}, True, "it holds 2"),
        ("item", {"object": "box", "at": "r1", "count": 1}, False, "it holds 2"),
        ("item", {"object": "can", "at": "oven"}, False, "it holds 0"),
        ("item", {"object": "can", "at": "oven", "count": 0}, True, "it holds 0"),
        ("never_two_in", {"zone": "hall"}, False, "r1 and r2 were in it at 1 s"),
        ("never_two_in", {"place": "dock", "within_m": 0.6}, True, "no two were"),
        ("never_two_in", {"place": "dock"}, False, "r1 and r2 were in it at 1 s"),
        ("commands", ["r1.pick", "drop"], True, "they came"),
        ("commands", ["drop", "oven.heat"], False, "oven.heat did not come after drop"),
        ("commands", ["oven.cool"], False, "oven.cool did not come"),
        ("commands", ["drop", "hall.oven.bake"], True, "they came"),
        ("commands", ["drop", "bake"], True, "they came"),
        ("commands", ["oven.bake"], False, "oven.bake did not come"),
        ("property", {"device": "oven", "name": "heat", "at_least": 50}, True, "it was 55.5 at 7 s"),
        ("property", {"device": "oven", "name": "heat", "at_least": 60}, False, "it was from 20 to 55.5"),
        ("property", {"device": "oven", "name": "heat", "at_most": 20}, True, "it was 20 at 0 s"),
        ("property", {"device": "oven", "name": "lid", "is": "shut"}, False, "it was open"),
        ("property", {"device": "oven", "name": "on", "is": 1}, False, "it was True"),
        ("property", {"device": "oven", "name": "gone", "is": 1}, False, "it was never shown"),
        ("step", {"step": "s1"}, True, "it was, 2 times"),
        ("step", {"step": "s1", "times": 1}, False, "it was, 2 times"),
        ("step", {"step": "s2", "times": 0}, True, "it was, 0 times"),
    ],
)
def test_an_expectation_is_held_against_what_was_seen(kind, says, holds, saw):
    verdict = judge(Expectation(kind, 4, says), seen())
    assert (verdict.ok, verdict.saw, verdict.line) == (holds, saw, 4)


@pytest.mark.parametrize(
    ("kind", "says", "holds"),
    [("ends", "well", False), ("fails", "OVEN", True), ("fails", "timed_out", True), ("fails", "lid", False)],
)
def test_a_failure_is_told_with_its_time_and_step(kind, says, holds):
    verdict = judge(Expectation(kind, 1, says), seen(**FAILED))
    assert (verdict.ok, verdict.t_s) == (holds, 30.0)
    assert verdict.saw == "at 30 s, step 7b: The Oven does not answer."


@pytest.mark.parametrize("code", ["too_long", "too_much", "too_slow"])
def test_a_rehearsal_that_was_stopped_has_not_ended_within_any_time(code):
    stopped = {"t": 90.0, "step": "s1", "kind": "timed_out", "message": "The program was stopped.", "code": code}
    verdict = judge(Expectation("within_s", 1, 1800.0), seen(ok=False, errors=[stopped]))
    assert (verdict.ok, verdict.saw) == (False, "at 90 s, step 7b: The program was stopped.")
    failed = {**stopped, "message": "The Oven does not answer.", "code": "step_timed_out"}
    assert judge(Expectation("within_s", 1, 1800.0), seen(ok=False, errors=[failed])).ok


def test_a_rehearsal_in_which_robots_touch_does_not_end_well():
    verdict = judge(Expectation("ends", 1, "well"), seen(ok=False, collisions=[{"t": 4.0, "a": "r1", "b": "wall"}]))
    assert (verdict.ok, verdict.saw) == (False, "r1 touched wall at 4 s")


def test_the_form_of_a_test_knows_every_expectation():
    rows = (ROOT / "frontend" / "src" / "editor" / "tests" / "testRows.ts").read_text()
    assert [kind for kind in get_args(ExpectationKind) if f'kind === "{kind}"' not in rows] == []
