"""What fails in a tick keeps nothing else from its turn."""

from __future__ import annotations

from datetime import timedelta
from typing import Any

import pytest
from django.db import connection

from editor import services as editor
from editor.language import plan_to_json
from editor.language.expressions.nodes import Constant, Operation, Reading
from editor.language.plan.instructions import End, EventEnd, EventEntry, Instruction, Plan, Wait
from execution import database, services
from execution.models import ArmedProgram, Run
from execution.ticker.ticker import Ticker
from registry.models import AuditLine, Device
from tests.kit.programs import SITE, TASK, heat_oven

pytestmark = pytest.mark.django_db(transaction=True)
OVEN = "curingOven01"
HOT = Operation(">", (Reading(Constant(OVEN), "temperature"), Constant(80)))
STEPS = (Instruction(End()), Instruction(Wait(Constant(5)), "cool"), Instruction(EventEnd()))
PLAN = Plan(STEPS, reads=((OVEN, "temperature"),), events=(EventEntry("e", 1, HOT, "run"),))


def arm(name: str) -> Any:
    program = editor.create_program(site=SITE, name=name, document=TASK).id
    prepared = services.Prepared(program, SITE, name, 1, {}, {}, plan_to_json(PLAN), {})
    return services.arm_program(prepared=prepared, by="Ada").program


def silence() -> None:
    Device.objects.filter(id="robot01").update(online=True, last_seen_at=database.now() - timedelta(hours=1))


def is_swept() -> bool:
    return not Device.objects.get(id="robot01").online


ODD_ZONE = {"id": ["no", "id"], "name": "Odd", "rule": "", "points": [], "speed_m_s": None}


@pytest.mark.parametrize("change", [{"plan": {"format": 99}}, {"unknown": 1}, {"plan": {"zones": [ODD_ZONE]}}])
def test_an_armed_program_that_cannot_be_read_is_disarmed_alone_and_the_record_says_so(
    factory: Any, change: dict[str, Any]
) -> None:
    heat_oven(20)
    odd, good = arm("Odd"), arm("Good")
    row = ArmedProgram.objects.get(program=odd)
    row.prepared |= {**change, "plan": row.prepared["plan"] | change.get("plan", {})}
    row.at += timedelta(seconds=1)  # nothing of it is known in this process
    row.save()
    heat_oven(90)
    silence()
    assert Ticker("a").tick(database.now())
    assert [run.program for run in Run.objects.all()] == [good]
    assert [armed.program for armed in services.list_armed(site=SITE)] == [good]
    assert is_swept()
    line = AuditLine.objects.get(code="armed_run_unreadable")
    assert line.facts == {"program": "Odd", "by": "Ada"}


def test_an_armed_program_stays_armed_while_what_it_looks_at_cannot_be_read(factory: Any) -> None:
    heat_oven(20)
    program = arm("Good")
    Device.objects.filter(id=OVEN).update(properties=["no", "object"])
    Ticker("a").tick(database.now())
    assert [armed.program for armed in services.list_armed(site=SITE)] == [program]
    assert not AuditLine.objects.filter(code="armed_run_unreadable").exists()
    heat_oven(90)
    Ticker("a").tick(database.now())
    assert [run.program for run in Run.objects.all()] == [program]


def test_a_deleted_program_that_cannot_be_disarmed_keeps_no_other_from_starting(factory: Any) -> None:
    heat_oven(20)
    gone, good = arm("Gone"), arm("Good")
    editor.delete_program(program_id=gone)
    heat_oven(90)
    key = ArmedProgram._meta.get_field("program")
    with connection.cursor() as cursor:  # stands for what nobody foresees
        cursor.execute(f"CREATE TABLE holds (armed {key.db_type(connection)} REFERENCES execution_armedprogram)")
        cursor.execute("INSERT INTO holds VALUES (%s)", [key.get_db_prep_value(gone, connection)])
    try:
        assert Ticker("a").tick(database.now())
    finally:
        with connection.cursor() as cursor:
            cursor.execute("DROP TABLE holds")
    assert [run.program for run in Run.objects.all()] == [good]
    assert ArmedProgram.objects.count() == 2


def test_a_step_of_the_ticker_that_fails_keeps_no_other_from_its_turn_and_is_named_in_the_log(
    factory: Any, caplog: pytest.LogCaptureFixture
) -> None:
    silence()
    hidden = ("execution_timer", "execution_stopfollowed", "registry_sample")
    with connection.cursor() as cursor:  # stands for what nobody foresees
        for table in hidden:
            cursor.execute(f"ALTER TABLE {table} RENAME TO {table}_hidden")
    try:
        assert Ticker("a").tick(database.now())
    finally:
        with connection.cursor() as cursor:
            for table in hidden:
                cursor.execute(f"ALTER TABLE {table}_hidden RENAME TO {table}")
    assert is_swept()
    said = [line.getMessage() for line in caplog.records if line.name == "execution.database"]
    assert said == [
        f"A step of the ticker ({name}) failed; what comes after it goes on."
        for name in ("fire_timers", "follow_stops", "Ticker._prune_samples")
    ]
