"""Events of a program that is carried out: live readings start their bodies."""

import pytest

from editor.language.expressions.nodes import Constant, Operation, PlaceRef, Reading
from editor.language.plan.instructions import Call, End, EventEnd, EventEntry, Instruction, Notify, Plan, Wait
from execution import services
from execution.engine.drive import advance_site
from execution.models import Run, RunEvent
from tests.kit.programs import SITE, heat_oven

pytestmark = pytest.mark.django_db(transaction=True)
OVEN = "curingOven01"
HOT = Operation(">", (Reading(Constant(OVEN), "temperature"), Constant(80)))
LATE = Operation(">=", (Operation("now", ()), Constant(0)))


def told(run):
    return list(RunEvent.objects.filter(run=run, kind="notice").values_list("text", flat=True))


def program(condition=HOT, *body):
    return Plan(
        (
            Instruction(Wait(Constant(600)), "w"),
            Instruction(End()),
            *(body or (Instruction(Notify(Constant("It is hot")), "n"),)),
            Instruction(EventEnd()),
        ),
        events=(EventEntry("e", 2, condition),),
    )


def test_a_reading_that_crosses_its_limit_starts_the_body_each_time(factory):
    heat_oven(20)
    run = factory.start(program())
    factory.work()
    assert Run.objects.get(id=run).watches is True
    for value in (90, 95, 30, 85):
        heat_oven(value)
        advance_site(SITE)
    assert told(run) == ["It is hot", "It is hot"]
    steps = Run.objects.get(id=run).steps
    assert (steps["e"]["count"], steps["e"]["status"], steps["w"]["status"]) == (2, "done", "running")


def test_the_time_of_day_is_told_to_a_program_that_asks_for_it(factory):
    run = factory.start(program(LATE))
    factory.work()
    facts = {(thing, name): value for thing, name, value in Run.objects.get(id=run).state["facts"]}
    assert 0 <= facts["$clock", "now"] < 86_400
    assert told(run) == []


def test_what_fails_in_an_events_body_fails_the_run(factory):
    heat_oven(20)
    call = Call(PlaceRef(device=OVEN), "bakeBread", {})
    run = factory.start(program(HOT, Instruction(call, "b")))
    factory.work()
    heat_oven(90)
    advance_site(SITE)
    factory.work()
    row = Run.objects.get(id=run)
    assert row.status == "failed"
    assert row.reason == "Curing Oven cannot bakeBread; it offers no such method."
    assert (row.steps["b"]["status"], row.steps["w"]["status"]) == ("failed", "skipped")


def test_a_paused_run_looks_at_its_events_when_it_goes_on(factory):
    heat_oven(20)
    run = factory.start(program())
    factory.work()
    services.pause_run(run_id=run, by="Ada")
    factory.work()
    heat_oven(90)
    advance_site(SITE)
    assert told(run) == []
    services.resume_run(run_id=run, by="Ada")
    factory.work()
    assert told(run) == ["It is hot"]
