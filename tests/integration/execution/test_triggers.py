"""Programs that start by themselves."""

from dataclasses import replace
from datetime import UTC, datetime
from uuid import uuid4

import pytest

from editor import services as editor
from editor.language import plan_to_json
from editor.language.expressions.nodes import Constant, Operation, Reading
from editor.language.plan.instructions import Branch, End, EventEnd, EventEntry, Instruction, Plan, Wait
from execution import database, services
from execution.machine.needs import clock_fact, needs_of
from execution.models import ArmedProgram, Command, Run, RunEvent
from execution.runs import triggers
from execution.runs.facts import site_facts
from registry import services as registry
from tests.kit.programs import TASK, heat_oven
from tests.kit.sign_in import join_and_sign_in, post_json

pytestmark = pytest.mark.django_db(transaction=True)
SITE, OVEN = "painting-factory", "curingOven01"
HOT = Operation(">", (Reading(Constant(OVEN), "temperature"), Constant(80)))
PLAN = Plan(
    (
        Instruction(Wait(Constant(1)), "main"),
        Instruction(End()),
        Instruction(Wait(Constant(5)), "cool"),
        Instruction(EventEnd()),
    ),
    reads=((OVEN, "temperature"),),
    events=(EventEntry("e", 2, HOT, "run"),),
)


def arm(plan=PLAN):
    program = editor.create_program(site=SITE, name="Cool down", document=TASK).id
    prepared = services.Prepared(program, SITE, "Cool down", 3, {}, {}, plan_to_json(plan), {})
    return services.arm_program(prepared=prepared, by="Ada")


def explore():
    """Let a robot drive where it likes, as a call by hand keeps it."""
    site = ArmedProgram.objects.get().site
    at = database.now()
    return Command.objects.create(
        id=uuid4(), site=site, position=0, device="robot01", method="explore", by="Ada", status="running",
        send_after=at, created_at=at,
    )  # fmt: skip


def look():
    return services.start_armed(now=datetime.now(UTC))


def test_a_run_starts_at_the_events_body_when_the_condition_becomes_true(factory):
    heat_oven(20)
    armed = arm()
    assert (armed.version, armed.by) == (3, "Ada")
    assert look() == 0
    heat_oven(90)
    assert look() == 1
    factory.go(lambda: Run.objects.get().status == "finished", limit_s=20)
    run = Run.objects.get()
    assert (set(run.steps), run.program) == ({"e", "cool"}, armed.program)
    first = RunEvent.objects.filter(run=run).first()
    assert (first.code, first.text) == ("started_itself", "Run 1 started by itself; Ada has armed the program.")


@pytest.mark.parametrize(
    ("day", "times", "started"),
    [
        ("2026-10-24T", ["22:00", "23:59:59"], 0),
        ("2026-10-25T", ["00:20", "00:30", "00:59:59", "01:00", "01:20", "01:30", "01:59:59.5", "02:00", "03:00"], 1),
        ("2026-03-29T", ["00:30", "00:59:59", "01:00", "01:30"], 1),
    ],
)
def test_half_past_two_comes_once_in_the_nights_when_clocks_are_changed(factory, settings, day, times, started):
    """In UTC: in Berlin it is 2:30 at 00:30 and, by clocks that were put back, at 01:30; in spring it is then 3:00."""
    settings.TIME_ZONE = "Europe/Berlin"
    late = Operation(">=", (Operation("now", ()), Constant(2 * 3600 + 30 * 60)))
    arm(replace(PLAN, reads=(), events=(EventEntry("e", 2, late, "run"),)))
    seen = 0
    for time in times:
        seen += services.start_armed(now=datetime.fromisoformat(f"{day}{time}+00:00"))
        Run.objects.update(status="finished", ended_at=datetime.now(UTC))
    assert seen == started


@pytest.mark.parametrize(
    ("at", "clock"),
    [
        ("00:59:59", "02:59:59"),
        ("01:00:00", "02:59:59"),
        ("01:17:30.25", "02:59:59"),
        ("01:59:59.999", "02:59:59"),
        ("02:00:00", "03:00:00"),
    ],
)
def test_the_time_of_day_stands_still_while_clocks_repeat_an_hour(db, settings, at, clock):
    settings.TIME_ZONE = "Europe/Berlin"
    needs = needs_of(Plan((Instruction(Branch(Operation("now", ()), 1)), Instruction(End()))))
    facts = site_facts(needs, SITE, datetime.fromisoformat(f"2026-10-25T{at}+00:00"))
    hours, minutes, seconds = map(int, clock.split(":"))
    assert facts == clock_fact(hours * 3600 + minutes * 60 + seconds)


def test_what_is_true_already_starts_nothing_and_while_a_run_is_under_way_none_is_added(factory):
    heat_oven(90)
    arm()
    assert look() == 0
    heat_oven(20)
    assert look() == 0
    heat_oven(90)
    assert look() == 1
    heat_oven(20)
    look()
    heat_oven(90)
    assert look() == 0
    assert Run.objects.count() == 1


def test_two_tickers_that_see_the_same_start_one_run(factory):
    heat_oven(20)
    arm()
    seen = [ArmedProgram.objects.select_related("site").get() for _ in range(3)]
    heat_oven(90)
    assert sum(triggers._look_at(row, datetime.now(UTC)) for row in seen) == 1
    assert Run.objects.count() == 1


def test_stop_all_disarms_until_somebody_arms_again(factory):
    heat_oven(20)
    arm()
    services.press_stop(site=SITE, by="Otto")
    assert services.list_armed(site=SITE) == ()
    heat_oven(90)
    assert look() == 0
    with pytest.raises(services.NotPossibleNow, match="The site is stopped"):
        arm()
    services.reset_stop(site=SITE, by="Ada")
    assert (look(), Run.objects.count()) == (0, 0)


def test_a_program_that_nothing_starts_cannot_be_armed(factory):
    with pytest.raises(services.NotReady, match="Nothing starts this program by itself"):
        arm(Plan((Instruction(End()),)))
    assert ArmedProgram.objects.count() == 0


def test_a_disarmed_program_starts_no_more(factory):
    heat_oven(20)
    armed = arm()
    services.disarm_program(program_id=armed.program, site=SITE)
    heat_oven(90)
    assert (look(), services.list_armed(site=SITE)) == (0, ())


def test_a_condition_that_becomes_true_while_a_robot_explores_starts_a_run_when_that_is_over(factory):
    heat_oven(20)
    arm()
    call = explore()
    heat_oven(90)
    assert (look(), look()) == (0, 0)
    Command.objects.filter(id=call.id).update(status=Command.Status.DONE)
    assert (look(), look(), Run.objects.count()) == (1, 0, 1)


def test_a_condition_that_holds_no_more_when_the_robot_has_explored_starts_nothing(factory):
    heat_oven(20)
    arm()
    call = explore()
    heat_oven(90)
    look()
    heat_oven(20)
    Command.objects.filter(id=call.id).update(status=Command.Status.DONE)
    assert (look(), Run.objects.count()) == (0, 0)


def test_a_deleted_program_starts_nothing_and_is_disarmed_for_all_who_look(factory, monkeypatch):
    heat_oven(20)
    armed = arm()
    editor.delete_program(program_id=armed.program)
    said = []
    monkeypatch.setattr(registry, "publish", lambda site, message: said.append((site, message)))
    heat_oven(90)
    assert (look(), Run.objects.count(), ArmedProgram.objects.count()) == (0, 0, 0)
    assert said == [(SITE, {"type": "armed", "programs": []})]


def test_a_program_that_is_deleted_while_its_condition_is_looked_at_starts_nothing(factory):
    heat_oven(20)
    seen, armed = arm(), ArmedProgram.objects.select_related("site").get()
    heat_oven(90)
    editor.delete_program(program_id=seen.program)
    assert triggers._look_at(armed, datetime.now(UTC)) is False
    assert (Run.objects.count(), ArmedProgram.objects.count()) == (0, 0)


def test_a_program_that_was_deleted_can_be_disarmed_by_who_may(factory):
    armed = arm()
    other = arm()
    editor.delete_program(program_id=armed.program)
    path = f"/api/programs/{armed.program}/arm"
    assert post_json(join_and_sign_in("viewer", SITE), path, {"on": False}).status_code == 403
    off = post_json(join_and_sign_in("operator", SITE), path, {"on": False})
    assert (off.status_code, [each["program"] for each in off.json()]) == (200, [str(other.program)])
