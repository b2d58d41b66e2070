"""What becomes of rehearsals that end, never end, are cancelled, freeze or lose their process."""

from __future__ import annotations

import os
import signal
from dataclasses import asdict
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

from editor.language.expressions.nodes import Constant
from editor.language.plan.instructions import End, Instruction, Plan, Wait
from execution import services
from execution.errors import NotFound, NotPossibleNow
from execution.models import Rehearsal
from execution.reasons import cause_of
from execution.rehearsals import worker
from execution.rehearsals.child_process import scene_from_json
from registry.models import Device
from simulation.services import make_world
from simulation.world import DELIVERY_S
from tests.integration.execution.rehearsals.conftest import ENDLESS, SHORT, queue, row, wait_until
from tests.kit.programs import SITE, describe_anew
from tests.kit.waiting import PATIENCE_S, wait_for
from vipo_device.protocol.description import PropertySpec

pytestmark = pytest.mark.django_db(transaction=True)
BATTERY = PropertySpec("battery", "number", "PERCENT", 0, 100)
LONG_AGO = timedelta(minutes=5)


def is_alive(pid: int) -> bool:
    return Path(f"/proc/{pid}").exists()


def test_a_rehearsal_is_carried_out_and_says_how_far_it_came(factory):
    rehearsal = queue(SHORT, driver="kinematic")
    assert services.get_rehearsal(rehearsal_id=rehearsal).place == 1
    assert worker.carry_out_waiting() == 1
    view = services.get_rehearsal(rehearsal_id=rehearsal)
    assert (view.status, view.progress, view.place, view.tries, view.cause) == ("done", 1.0, None, 1, None)
    assert view.result["ok"] is True
    assert view.began_at <= view.ended_at
    assert worker.carry_out_waiting() == 0


def test_a_robot_that_stands_elsewhere_charges_at_its_home_once_it_is_there(factory):
    away = {"x": 5.0, "y": -8.0, "z": 0.0, "theta": 1.0}
    for robot, pose in (("robot01", None), ("robot02", away)):
        said = Device.objects.get(pk=robot).description
        describe_anew(robot, said | {"properties": [*said["properties"], asdict(BATTERY)]})
        Device.objects.filter(pk=robot).update(pose=pose or said["pose"], properties={"battery": 50})
    queue(Plan((Instruction(Wait(Constant(600)), "w"), Instruction(End()))), driver="kinematic")
    assert worker.carry_out_waiting() == 1
    result = Rehearsal.objects.get().result
    assert result["frames"]["robots"]["robot02"][0] == [5.0, -8.0, 1.0]
    assert result["robots"]["robot01"]["battery"] > 80
    assert result["robots"]["robot02"]["distance_m"] > 10, "it is sent to its dock"
    assert result["robots"]["robot02"]["battery"] > 80


def test_a_rehearsal_begins_with_what_devices_hold_and_show(factory):
    """A machine at work keeps what it holds and how warm it is; what does not fit its description is left out."""
    counts = {"itemInventory01": "stock", "paintInventory01": "stock", "dropOff01": "freeSlots"}
    counts |= dict.fromkeys(("curingOven01", "paintMixer02"), "jobStatus")
    for device, name in counts.items():
        said = Device.objects.get(pk=device).description
        spec = PropertySpec(name, "number", "", 0, 100 if name == "jobStatus" else 9)
        describe_anew(device, said | {"properties": [*said["properties"], asdict(spec)]})
    for device, shown in {
        "itemInventory01": {"stock": 2},
        "paintInventory01": {"stock": -3},
        "dropOff01": {"freeSlots": 4},
        "curingOven01": {"temperature": 90.0, "quality": 7, "jobStatus": 100, "unheard of": 1},
    }.items():
        Device.objects.filter(pk=device).update(properties=shown, done=True)
    Device.objects.filter(pk="paintMixer02").update(properties={"temperature": 30.0, "jobStatus": 57}, done=False)
    queue(SHORT, driver="kinematic")
    scene, *_ = scene_from_json(row(str(Rehearsal.objects.get().id)).job["scene"])
    assert scene.readings["curingOven01"] == {"temperature": 90.0, "jobStatus": 100}
    assert scene.readings["paintMixer02"] == {"temperature": 30.0}
    world = make_world(scene=scene, driver="kinematic")
    begun = {name: world.stocks()[name] for name in ("itemInventory01", "paintInventory01", "dropOff01")}
    assert begun == {"itemInventory01": {"box": 2}, "paintInventory01": {"can": 0}, "dropOff01": {"box": 5}}
    assert world.readings()["curingOven01"]["temperature"] == 90.0
    world.advance(DELIVERY_S + 10.0)
    assert world.stocks()["paintInventory01"] == {"can": 9}, "people fill a simulated source in the twin, too"
    assert 50.0 < world.readings()["curingOven01"]["temperature"] < 85.0


def test_nobody_fills_a_real_source_in_a_rehearsal(factory):
    said = Device.objects.get(pk="paintInventory01").description
    stock = asdict(PropertySpec("stock", "number", "", 0, 9))
    describe_anew("paintInventory01", said | {"simulated": False, "properties": [stock]})
    Device.objects.filter(pk="paintInventory01").update(properties={"stock": 0})
    queue(SHORT, driver="kinematic")
    scene, *_ = scene_from_json(row(str(Rehearsal.objects.get().id)).job["scene"])
    world = make_world(scene=scene, driver="kinematic")
    world.advance(DELIVERY_S * 3)
    assert world.stocks()["paintInventory01"] == {"can": 0}


def test_a_program_that_never_ends_says_so_within_the_limit_and_where_it_was(factory, settings):
    for settings.VIPO_REHEARSAL_LIMIT_S in (2, 8, 32):  # on a busy machine two seconds may be gone before it begins
        rehearsal = queue(ENDLESS)
        worker.carry_out_waiting()
        view = services.get_rehearsal(rehearsal_id=rehearsal)
        assert (view.status, view.reason, view.result["ok"]) == ("done", "", False)
        (error,) = view.result["errors"]
        minutes = round(settings.VIPO_REHEARSAL_LIMIT_S / 60, 1)
        assert (error["code"], error["step"], error["args"]["minutes"]) == ("too_slow", "w", minutes)
        hours, minutes, seconds = (int(part) for part in error["args"]["reached"].split(":"))
        if reached := hours * 3600 + minutes * 60 + seconds:
            break
    assert 0 < reached <= view.result["duration_s"]
    assert view.result["steps"], "what it found until then is kept"


def test_progress_is_told_while_it_goes_on_and_never_goes_back(factory, working):
    rehearsal = queue(ENDLESS)
    working()
    seen = []

    def look():
        seen.append((found := row(rehearsal)).progress)
        return found.course.get("virtual_s", 0) > 20 and found

    found = wait_for("twenty seconds of virtual time", look)
    assert seen == sorted(seen)
    assert (found.course["end_known"], found.course["steps"], found.course["steps_done"]) == (False, 1, 1)
    assert found.course["step"] == "w"


def test_a_cancelled_rehearsal_ends_wherever_it_is_cancelled_as_soon_as_its_worker_looks(factory, working, children):
    rehearsal = queue(ENDLESS)
    thread = working()
    wait_for("its child", lambda: children and row(rehearsal).course)
    view = services.cancel_rehearsal(rehearsal_id=rehearsal, by="Bob")
    assert (view.status, view.cause) == ("cancelled", {"code": "rehearsal_cancelled", "args": {"by": "Bob"}})
    wait_for("the end of its child, which would never end by itself", lambda: not is_alive(children[0].pid))
    assert worker.LOOK_S <= 0.1
    thread.join(PATIENCE_S)
    assert (row(rehearsal).status, row(rehearsal).result) == ("cancelled", None)


def test_what_waits_is_cancelled_and_never_begun(factory):
    rehearsal = queue(SHORT, driver="kinematic")
    services.cancel_rehearsal(rehearsal_id=rehearsal, by="Bob")
    assert worker.carry_out_waiting() == 0
    assert (row(rehearsal).status, row(rehearsal).tries) == ("cancelled", 0)


def test_cancelling_twice_is_once_and_what_is_over_stays_over(factory):
    first, second = queue(SHORT, driver="kinematic"), queue(SHORT, driver="kinematic")
    services.cancel_rehearsal(rehearsal_id=first, by="Bob")
    again = services.cancel_rehearsal(rehearsal_id=first, by="Eve")
    assert (again.status, again.reason) == ("cancelled", "Bob cancelled the rehearsal.")
    worker.carry_out_waiting()
    with pytest.raises(NotPossibleNow) as refused:
        services.cancel_rehearsal(rehearsal_id=second, by="Bob")
    assert refused.value.facts == {"why": "rehearsal_over"}
    assert row(second).status == "done"
    with pytest.raises(NotFound):
        services.cancel_rehearsal(rehearsal_id="00000000-0000-4000-8000-000000000000", by="Bob")


def test_a_frozen_child_is_ended_and_the_rehearsal_says_so(factory, working, children, monkeypatch):
    rehearsal = queue(ENDLESS)
    working()
    wait_for("its child", lambda: children and row(rehearsal).course)
    os.kill(children[0].pid, signal.SIGSTOP)
    monkeypatch.setattr(worker, "SILENT_S", 3.0)  # not before: a child that reads its modules is silent, too
    failed = wait_until(rehearsal, "failed")
    assert cause_of(failed.reason) == {"code": "rehearsal_frozen", "args": {"seconds": "3"}}
    wait_for("the end of its child", lambda: not is_alive(children[0].pid))


def test_a_child_that_does_not_end_itself_is_ended(factory, working, children, monkeypatch, settings):
    settings.VIPO_REHEARSAL_LIMIT_S = 30
    monkeypatch.setattr(worker, "GRACE_S", -29.9)  # before the child itself can
    rehearsal = queue(ENDLESS)
    working()
    failed = wait_until(rehearsal, "failed")
    assert cause_of(failed.reason)["code"] == "rehearsal_late"


def test_a_child_that_dies_ends_its_rehearsal_with_a_reason(factory, working, children):
    rehearsal = queue(ENDLESS)
    working()
    wait_for("its child", lambda: children and row(rehearsal).course)
    os.kill(children[0].pid, signal.SIGKILL)
    failed = wait_until(rehearsal, "failed")
    assert cause_of(failed.reason) == {"code": "rehearsal_died", "args": {}}


def test_a_rehearsal_that_wants_too_much_memory_says_so(factory, settings, monkeypatch):
    monkeypatch.setattr(worker, "MIB", 60 * 1024)  # a child that has read its modules has more already
    rehearsal = queue(SHORT, driver="kinematic")
    worker.carry_out_waiting()
    failed = row(rehearsal)
    assert (failed.status, failed.result) == ("failed", None)
    assert cause_of(failed.reason) == {"code": "rehearsal_memory", "args": {"megabytes": "2048"}}


def test_what_a_dead_worker_had_is_begun_anew_once_and_then_ended_with_a_reason(factory):
    rehearsal = queue(SHORT, driver="kinematic")
    for tries, status in ((1, "queued"), (2, "failed")):
        claimed = worker.claim_next()
        assert str(claimed.id) == rehearsal
        worker.sweep_rehearsals()
        assert row(rehearsal).status == "running", "one whose worker lives is left alone"
        Rehearsal.objects.filter(id=rehearsal).update(beat_at=datetime.now(UTC) - LONG_AGO)
        worker.sweep_rehearsals()
        assert (row(rehearsal).status, row(rehearsal).tries) == (status, tries)
    assert cause_of(row(rehearsal).reason)["code"] == "rehearsal_died"
    assert worker.claim_next() is None


def test_a_worker_that_thaws_changes_nothing_of_what_another_one_has_taken(factory):
    rehearsal = queue(SHORT, driver="kinematic")
    frozen = worker.claim_next()
    Rehearsal.objects.filter(id=rehearsal).update(beat_at=datetime.now(UTC) - LONG_AGO)
    worker.sweep_rehearsals()
    second = worker.claim_next()
    worker.carry_out(frozen)
    assert (row(rehearsal).status, row(rehearsal).claim) == ("running", second.claim)
    worker.carry_out(second)
    assert (row(rehearsal).status, row(rehearsal).tries) == ("done", 2)


def test_a_worker_that_is_told_to_end_gives_back_what_it_has(factory, working, children):
    rehearsal = queue(ENDLESS)
    thread = working()
    wait_for("its child", lambda: children and row(rehearsal).course)
    worker.stopping.set()
    thread.join(PATIENCE_S)
    assert not thread.is_alive()
    assert not is_alive(children[0].pid)
    given = row(rehearsal)
    assert (given.status, given.tries, given.claim, given.progress) == ("queued", 0, None, 0.0)
    assert services.get_rehearsal(rehearsal_id=rehearsal).place == 1


def test_a_rehearsal_that_is_cancelled_while_a_worker_reads_the_queue_is_not_begun(factory, monkeypatch):
    cancelled, other = queue(SHORT), queue(SHORT, 1)
    read = worker.order_of_queue

    def read_before_the_cancel():
        order = read()
        assert order
        services.cancel_rehearsal(rehearsal_id=cancelled, by="Ada")
        return order

    monkeypatch.setattr(worker, "order_of_queue", read_before_the_cancel)
    claimed = worker.claim_next()
    assert (str(claimed.id), row(cancelled).status) == (other, "cancelled")


def test_no_more_are_under_way_on_a_machine_than_may(factory, settings):
    settings.VIPO_REHEARSALS_AT_ONCE = 2
    for person in range(4):
        queue(SHORT, person)
    assert [worker.claim_next() is not None for _ in range(4)] == [True, True, False, False]
    Rehearsal.objects.filter(status="running").update(machine="another one")
    assert [worker.claim_next() is not None for _ in range(2)] == [True, True]


def test_a_rehearsal_that_is_deleted_under_way_ends_its_child(factory, working, children):
    rehearsal = queue(ENDLESS)
    thread = working()
    wait_for("its child", lambda: children and row(rehearsal).course)
    Rehearsal.objects.all().delete()
    thread.join(PATIENCE_S)
    assert not is_alive(children[0].pid)
    assert services.list_open_rehearsals(site=SITE) == []
