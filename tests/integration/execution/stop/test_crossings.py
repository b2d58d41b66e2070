"""Somebody does something at the very moment at which another presses Stop all, and even resets it: it stands still.

What the one does is held in the middle by a lock of the test's, after it has seen that nothing is stopped.
"""

from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from uuid import uuid4

import psycopg
import pytest
from django.db import connection

from editor import services as editor
from editor.language import plan_to_json
from editor.language.expressions.nodes import Constant, Operation, Reading
from editor.language.plan.instructions import EventEntry
from execution import services
from execution.engine.drive import advance_site
from execution.models import ArmedProgram, Command, InboxEvent, Run, SiteStop
from execution.traffic.messages import CONTROLS
from registry.models import Device
from tests.kit.programs import CARRY, SITE, TASK, describe_anew, heat_oven
from tests.kit.waiting import wait_for

pytestmark = pytest.mark.servers
WAITING = "SELECT count(*) FROM pg_stat_activity WHERE datname = current_database() AND wait_event_type = 'Lock'"
RUNS = "LOCK TABLE execution_run IN SHARE ROW EXCLUSIVE MODE"
JOURNAL = "LOCK TABLE execution_runevent IN SHARE ROW EXCLUSIVE MODE"
COMMANDS = "LOCK TABLE execution_command IN SHARE ROW EXCLUSIVE MODE"
INBOX = "LOCK TABLE execution_inboxevent IN SHARE ROW EXCLUSIVE MODE"


@contextmanager
def held(url, lock, press):
    """Let somebody do something until this lock holds it up, and give what it comes to after the block."""
    with (
        psycopg.connect(url) as holder,
        psycopg.connect(url, autocommit=True) as looking,
        ThreadPoolExecutor(1) as pool,
    ):
        holder.execute(lock)
        pressed = pool.submit(in_thread, press)
        wait_for("who is held up", lambda: looking.execute(WAITING).fetchone() == (1,))
        yield pressed
        holder.commit()
        pressed.exception(60)


def in_thread(press):
    try:
        return press()
    finally:
        connection.close()


def sent_now(factory):
    """What leaves for devices when workers and gateways have done all there is, but for controls."""
    factory.work()
    Command.objects.update(send_after=datetime.now(UTC))
    return [
        c.topic for c in services.claim_commands(limit=100) if not c.topic.endswith(("/pause", "/resume", "/cancel"))
    ]


def stop_and_reset():
    services.press_stop(site=SITE, by="Otto")
    services.reset_stop(site=SITE, by="Otto")


def stands_still_until_resumed(factory, run):
    assert sent_now(factory) == []
    view = services.get_run(run_id=run).run
    assert (view.status, view.reason) == ("paused", "Otto stopped all devices of the site")
    assert sent_now(factory) == []
    services.resume_run(run_id=run, by="Ada")
    assert sent_now(factory) != []
    assert services.get_run(run_id=run).run.status == "running"


def begin():
    prepared = services.Prepared(uuid4(), SITE, "Task", 1, {}, {}, plan_to_json(CARRY), {})
    return services.start_run(prepared=prepared, by="Ada")


def test_a_run_that_starts_while_the_stop_is_pressed_and_reset_stands_still(factory, db):
    with held(db, RUNS, begin) as started:
        stop_and_reset()
    stands_still_until_resumed(factory, started.result().id)


def test_a_run_that_starts_while_a_robot_is_told_to_explore_is_refused(factory, db):
    robot = Device.objects.get(pk="robot03")
    robot.description["methods"].append({**robot.description["methods"][0], "name": "explore", "parameters": []})
    describe_anew("robot03", robot.description)
    told = {"site": SITE, "device_id": "robot03", "method": "explore", "arguments": {}, "by": "Otto"}
    with ThreadPoolExecutor(1) as pool, psycopg.connect(db, autocommit=True) as looking:
        with held(db, COMMANDS, lambda: services.call_method(**told)) as called:
            started = pool.submit(in_thread, begin)
            wait_for("who is held up behind", lambda: looking.execute(WAITING).fetchone() == (2,))
        assert called.result().status == "pending"
        assert "explores the floor" in str(started.exception(60))
    assert not Run.objects.exists()


def test_a_start_that_was_asked_for_before_the_stop_stands_still(factory):
    seen = services.get_stop(site=SITE).fence
    stop_and_reset()
    prepared = services.Prepared(uuid4(), SITE, "Task", 1, {}, {}, plan_to_json(CARRY), {})
    run = services.start_run(prepared=prepared, by="Ada", fence=seen)
    stands_still_until_resumed(factory, run.id)


def test_a_run_that_is_resumed_while_the_stop_is_pressed_and_reset_stands_still(factory, db):
    run = factory.start(CARRY)
    factory.work()
    services.pause_run(run_id=run, by="Ada")
    factory.work()
    with held(db, RUNS, lambda: services.resume_run(run_id=run, by="Ada")) as resumed:
        stop_and_reset()
    assert str(resumed.exception()) == "The site is stopped. Reset the stop, then resume the run."
    stands_still_until_resumed(factory, run)


def test_a_run_that_is_cancelled_while_the_stop_is_pressed_ends(factory, db):
    run = factory.start(CARRY)
    factory.go(lambda: Command.objects.exists())
    with held(db, INBOX, lambda: services.cancel_run(run_id=run, by="Ada")):
        stop_and_reset()
        assert services.claim_commands(limit=100) == ()
    services.follow_stops()
    factory.work()
    assert services.get_run(run_id=run).run.status == "cancelled"


def test_a_run_whose_step_is_under_way_while_the_stop_is_pressed_and_reset_stands_still(factory, db):
    run = begin().id
    with held(db, JOURNAL, lambda: advance_site(SITE)):
        stop_and_reset()
    advance_site(SITE)
    assert [c.method for c in Command.objects.all() if c.run == run] != []
    assert {command.topic.rsplit("/", 1)[1] for command in services.claim_commands(limit=100)} <= {*CONTROLS}
    stands_still_until_resumed(factory, run)


def test_a_planned_start_that_is_due_while_the_stop_is_pressed_and_reset_stands_still(factory, db):
    prepared = services.Prepared(uuid4(), SITE, "Task", 1, {}, {}, plan_to_json(CARRY), {})
    soon = services.Terms(not_before=datetime.now(UTC) + timedelta(minutes=1))
    run = services.start_run(prepared=prepared, by="Ada", terms=soon).id
    Run.objects.update(not_before=datetime.now(UTC) - timedelta(seconds=1))
    with held(db, JOURNAL, lambda: advance_site(SITE)):
        stop_and_reset()
    stands_still_until_resumed(factory, run)


HOT = Operation(">", (Reading(Constant("curingOven01"), "temperature"), Constant(80)))
ITSELF = replace(CARRY, reads=(("curingOven01", "temperature"),), events=(EventEntry("when", 0, HOT, "run"),))


def arm(fence=None):
    program = editor.create_program(site=SITE, name="Hot", document=TASK).id
    prepared = services.Prepared(program, SITE, "Hot", 1, {}, {}, plan_to_json(ITSELF), {})
    return services.arm_program(prepared=prepared, by="Ada", fence=fence)


def test_an_armed_program_that_fires_while_the_stop_is_pressed_and_reset_stands_still(factory, db):
    heat_oven(20)
    arm()
    heat_oven(90)
    with held(db, RUNS, lambda: services.start_armed(now=datetime.now(UTC))) as fired:
        stop_and_reset()
    assert fired.result() == 1
    services.follow_stops()
    assert services.list_armed(site=SITE) == ()
    stands_still_until_resumed(factory, Run.objects.get().id)


def test_a_program_that_was_armed_while_the_stop_was_pressed_and_reset_never_fires(factory):
    heat_oven(20)
    seen = services.get_stop(site=SITE).fence
    stop_and_reset()
    arm(fence=seen)
    heat_oven(90)
    assert services.start_armed(now=datetime.now(UTC)) == 0
    assert (ArmedProgram.objects.count(), Run.objects.count()) == (0, 0)


def test_a_call_by_hand_that_crosses_the_stop_and_its_reset_is_never_sent(factory, db):
    def call():
        return services.call_method(
            site=SITE, device_id="paintMixer01", method="mixPaint", arguments={"time": 2}, by="Ada"
        )

    with held(db, COMMANDS, call) as called:
        stop_and_reset()
    factory.work()
    assert sent_now(factory) == []
    view = services.get_call(site=SITE, call_id=called.result().id)
    assert (view.status, view.why) == ("cancelled", "Otto stopped all devices of the site")
    assert call().status == "pending"


def test_a_reset_while_the_stop_is_being_followed_leaves_the_floor_free_and_the_runs_paused(factory, db):
    run = factory.start(CARRY)
    factory.go(lambda: Command.objects.exists())
    with held(db, INBOX, lambda: services.press_stop(site=SITE, by="Otto")) as pressed:
        assert services.is_stopped(site=SITE)
        assert services.claim_commands(limit=100) == ()
        assert services.reset_stop(site=SITE, by="Otto").active is False
    assert pressed.result().active is True
    services.follow_stops()
    keys = InboxEvent.objects.filter(target=f"site:{SITE}", key__regex="^(stop|reset):").order_by("id")
    assert [key.partition(":")[0] for key in keys.values_list("key", flat=True)] == ["stop", "reset"]
    stands_still_until_resumed(factory, run)


def test_two_who_press_and_two_who_reset_at_once_do_it_once(factory):
    run = factory.start(CARRY)
    factory.work()

    def both(what):
        with ThreadPoolExecutor(2) as pool:
            pressed = [pool.submit(in_thread, lambda by=by: what(site=SITE, by=by)) for by in ("Ada", "Otto")]
            return {each.result(60) for each in pressed}

    assert len(both(services.press_stop)) == 1
    stop = SiteStop.objects.get()
    assert (stop.active, stop.pressed) == (True, stop.fence)
    assert len(both(services.reset_stop)) == 1
    assert (SiteStop.objects.get().pressed, SiteStop.objects.get().active) == (stop.pressed, False)
    services.follow_stops()
    factory.work()
    assert services.get_run(run_id=run).run.status == "paused"
    floor = InboxEvent.objects.filter(target=f"site:{SITE}", key__regex="^(stop|reset):")
    assert floor.count() == 2


def test_who_is_frozen_in_the_middle_of_a_press_holds_nobody_up(factory, db):
    run = factory.start(CARRY)
    factory.go(lambda: Command.objects.exists())
    with psycopg.connect(db) as frozen:
        services.press_stop(site=SITE, by="Otto")
        services.reset_stop(site=SITE, by="Otto")
        frozen.execute("SELECT 1 FROM execution_stopfollowed FOR UPDATE")
        assert services.press_stop(site=SITE, by="Ada").active is True
        assert services.claim_commands(limit=100) == ()
    services.follow_stops()
    factory.work()
    assert services.get_run(run_id=run).run.reason == "Ada stopped all devices of the site"


def test_a_run_that_goes_on_under_an_old_fence_is_paused_by_the_ticker(factory):
    """As when who resumed it, or started it, died before it could look again."""
    run = factory.start(CARRY)
    factory.work()
    stop = services.press_stop(site=SITE, by="Otto")
    services.reset_stop(site=SITE, by="Otto")
    factory.work()
    services.resume_run(run_id=run, by="Ada")
    factory.work()
    Run.objects.update(fence=stop.fence - 1)
    services.follow_stops()
    services.follow_stops()
    stands_still_until_resumed(factory, run)
