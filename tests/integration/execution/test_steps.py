"""What the steps of a run ask of the database does not grow with the devices of the site."""

from datetime import UTC, datetime

import pytest

from bench.hall import SITE, carry_out_run, fill_hall
from editor.language.expressions.nodes import Constant, Located, Operation, Reading, Variable
from editor.language.plan.instructions import Branch, End, Instruction, Plan
from execution.engine import memory
from execution.floor.layouts import get_layout
from execution.floor_protocol import RoleFilled
from execution.machine.needs import needs_of
from execution.machine.places import ROLE
from execution.models import Run
from execution.runs.facts import facts_of, site_facts
from registry import services as registry
from registry.models import Device, Site

pytestmark = pytest.mark.django_db(transaction=True)
MANY = 300


def test_a_step_of_a_run_reads_only_the_devices_that_it_concerns(monkeypatch):
    monkeypatch.setattr(memory, "FRESH_S", 60.0)  # however long this takes here, nothing has to be looked at anew
    fill_hall(MANY)
    carry_out_run()
    counts = carry_out_run()
    rows = {step: count.device_rows for step, count in counts.items()}
    assert rows == {
        "a run begins and its command goes out": MANY + 1,
        "floor and run hear the answer": 2,
        "there is nothing to do": 1,
        "a reading ends the run": 1,
    }
    leasing = 5  # statements that take the lease and give it back, which an owner does once in a minute
    statements = {step: count.statements - leasing for step, count in counts.items()}
    assert statements == {
        # three lines of a journal are two statements, of two rows and of one: AT_ONCE says why
        # what the site's places are is one statement, and one more where it has none
        "a run begins and its command goes out": 18,
        "floor and run hear the answer": 12,
        "there is nothing to do": 3,
        "a reading ends the run": 8,
    }


def test_descriptions_are_read_for_the_layout_only_when_they_are_news():
    fill_hall(3)
    before = get_layout(SITE)
    Device.objects.filter(pk="robot001").update(pose={"x": 9.0, "y": 9.0, "z": 0.0, "theta": 0.0}, online=False)
    assert get_layout(SITE) is before
    Device.objects.filter(pk="machine000").update(name_override="Big oven")
    named = get_layout(SITE)
    assert (named is before, named.name("machine000")) == (False, "Big oven")
    Device.objects.filter(pk="machine000").update(pose_override={"x": 20.0, "y": 20.0, "z": 0.0, "theta": 0.0})
    moved = get_layout(SITE)
    assert moved.devices["machine000"].pose.x == 20.0
    Device.objects.filter(pk="machine000").update(lifecycle="retired")
    assert set(get_layout(SITE).devices) == {"robot001", "robot002"}


def test_reads_by_id_say_the_same_as_whole_views():
    fill_hall(5)
    Device.objects.filter(pk="machine000").update(name_override="Oven", pose={"x": 1.0, "y": 2.0})
    Device.objects.filter(pk="machine003").update(pose_override={"x": 3.0, "y": 4.0}, pose={"x": 1.0, "y": 2.0})
    Device.objects.filter(pk="robot001").update(pose_override={"x": 3.0, "y": 4.0}, pose={"x": 1.0, "y": 2.0})
    Device.objects.filter(pk="robot002").update(lifecycle="pending", online=False)
    Device.objects.filter(pk="machine004").update(lifecycle="retired")
    views = registry.list_devices(site=SITE)
    ids = [view.id for view in views]
    assert ids == ["machine000", "machine003", "robot001", "robot002"]
    assert registry.get_device_names(site=SITE, ids=[*ids, "machine004"]) == {view.id: view.name for view in views}
    readings = registry.get_readings(site=SITE)
    assert {device: (one.values, one.done, one.last_seen_at) for device, one in readings.items()} == {
        view.id: (view.readings, view.done, view.last_seen_at) for view in views
    }
    positions = registry.list_positions(site=SITE)
    assert [(p.id, p.kind, p.pose, p.online) for p in positions] == [(v.id, v.kind, v.pose, v.online) for v in views]
    placed = registry.list_placed(site=SITE)
    assert [position for position, _ in placed] == list(positions)
    assert [said for _, said in placed] == [view.canonical for view in views]
    assert registry.list_device_ids(site=SITE, lifecycle="approved") == tuple(ids[:3])
    assert [p.id for p in registry.list_positions(site=SITE, ids=["robot001"])] == ["robot001"]


def test_a_role_that_is_bound_in_a_step_has_its_readings_in_the_same_step():
    fill_hall(4)
    Device.objects.filter(pk="robot001").update(properties={"battery": 40, "load": "box:1"})
    battery = Operation(">", (Reading(Located(role="carrier"), "battery"), Constant(20)))
    needs = needs_of(Plan((Instruction(Branch(battery, 1)), Instruction(End()))))
    run = Run(site=Site.objects.get(slug=SITE), roles={})
    bound = RoleFilled("carrier", "robot001")
    now = datetime.now(UTC)
    assert facts_of(needs, run, [], now) == {}
    assert facts_of(needs, run, [bound], now) == {("robot001", "battery"): 40}
    run.roles = {"carrier": "robot001"}
    assert facts_of(needs, run, [], now) == {("robot001", "battery"): 40, (ROLE, "carrier"): "robot001"}


def test_a_device_that_only_the_run_tells_may_be_any_of_the_site():
    fill_hall(4)
    needs = needs_of(Plan((Instruction(Branch(Reading(Variable("machine"), "pressure"), 1)), Instruction(End()))))
    facts = site_facts(needs, SITE, datetime.now(UTC))
    assert facts == {(f"{kind}00{n}", "pressure"): 1 for n, kind in enumerate(("machine", "robot", "robot", "machine"))}
