"""How far a rehearsal is, and whether its end is known; what never ends is stopped, and says where it was."""

import pytest

from editor.language.expressions.nodes import Constant
from editor.language.plan.instructions import Branch, End, EventEntry, Instruction, Invoke, Jump, Plan, Return, Wait
from execution.rehearsals.progress import Progress, has_known_end
from execution.rehearsals.rehearsal import Conditions, rehearse
from tests.kit import demo_floor
from tests.kit.programs import plan_of

WAIT = Instruction(Wait(Constant(1)), "w")
YES = Constant(True)


@pytest.mark.parametrize(
    ("plan", "known"),
    [
        (plan_of(WAIT, End()), True),
        (plan_of(Branch(YES, 2), WAIT, End()), True),
        (plan_of(WAIT, Jump(0)), False),
        (plan_of(Branch(YES, 3), WAIT, Jump(0), End()), False),
        (plan_of(Invoke(2, "f", {}), End(), WAIT, Return()), True),
        (plan_of(Invoke(2, "f", {}), End(), Invoke(2, "f", {}), Return()), False),
        (plan_of(WAIT, End(), events=(EventEntry("e", 0, YES),)), False),
        (plan_of(WAIT, End(), events=(EventEntry("e", 0, YES, "run"),)), True),
    ],
)
def test_the_end_is_known_where_nothing_leads_back(plan: Plan, known: bool) -> None:
    assert has_known_end(plan) is known


def test_the_share_is_of_the_steps_and_never_quite_one() -> None:
    assert [Progress(0.0, "", done, 4, True).share for done in (0, 1, 4)] == [0.0, 0.247, 0.99]
    assert Progress(0.0, "", 0, 0, True).share == 0.0


def rehearsed(plan: Plan, follow, **conditions):
    return rehearse(
        plan,
        demo_floor.scene(),
        places=demo_floor.places(),
        conditions=Conditions("kinematic", **conditions),
        follow=follow,
    )


def test_what_is_told_goes_forward_in_time_and_in_steps() -> None:
    seen: list[Progress] = []
    two = Instruction(Wait(Constant(5)), "v")
    result = rehearsed(plan_of(Instruction(Wait(Constant(5)), "w"), two, End()), seen.append)
    assert result["ok"] is True
    assert [each.virtual_s for each in seen] == sorted(each.virtual_s for each in seen)
    shares = [each.share for each in seen]
    assert shares == sorted(shares)
    assert {(each.step, each.steps_done) for each in seen} >= {("w", 0), ("v", 1)}
    assert {(each.steps, each.end_known) for each in seen} == {(2, True)}


def test_following_a_rehearsal_changes_nothing_of_its_result() -> None:
    plan = plan_of(WAIT, End())
    assert rehearsed(plan, None) == rehearsed(plan, lambda progress: None)


def test_one_whose_time_is_over_is_stopped_and_says_where_it_was_and_what_it_has_found() -> None:
    result = rehearsed(plan_of(WAIT, Jump(0)), lambda progress: 600.0 if progress.virtual_s >= 70 else None)
    assert result["ok"] is False
    error = result["errors"][0]
    assert (error["step"], error["code"], error["args"]) == ("w", "too_slow", {"minutes": 10.0, "reached": "0:01:10"})
    assert error["message"] == ("The program was stopped after 10 min, at 0:01:10 of simulated time; it may never end.")
    assert len(result["steps"]) >= 70


def test_one_at_the_limit_of_virtual_time_says_at_which_step_it_was() -> None:
    result = rehearsed(plan_of(WAIT, Jump(0)), None, limit_s=30)
    assert [(error["step"], error["code"]) for error in result["errors"]] == [("w", "too_long")]
