"""Doors that robots pass, in runs: as the database keeps them, beside people and alerts."""

from collections import OrderedDict
from dataclasses import replace
from datetime import UTC, datetime, timedelta

import pytest

from editor.language.expressions.nodes import PlaceRef, Zone
from editor.language.plan.instructions import Call, End, Instruction, Move, Plan, RoleBinding
from execution import services
from execution.engine import drive
from execution.errors import NotPossibleNow
from execution.floor import layouts
from execution.models import Command, FloorState
from execution.ticker.alerts import watch_alerts
from execution.traffic import doors
from execution.traffic import floor as pure
from registry.models import Device, DeviceAlert
from simulation.services import make_world
from simulation.world import Fault, Scene
from tests.integration.execution.conftest import DEVICES, SITE
from tests.kit import demo_floor
from tests.kit.programs import run_status
from vipo_device.protocol.description import Description, MethodSpec, Pose, PropertySpec, Size, description_to_json

pytestmark = pytest.mark.django_db(transaction=True)
METHODS = tuple(MethodSpec(name, f"vipo/v1/dev/door02/down/{name}") for name in ("open", "close"))
STATE = PropertySpec("state", "text", options=("closed", "open"))
DOOR = Description(
    "door02", "Door 2", "machine", "door", Pose(0.3, -0.3), Size(0.1, 0.1, 2.0), properties=(STATE,), methods=METHODS
)
GATE = Zone("gate", "Gate", "door", ((9.0, -12.0), (10.0, -12.0), (10.0, -0.5), (9.0, -0.5)), None, "door02")
EAST, WEST = PlaceRef(point=(14.0, -8.0)), PlaceRef(point=(4.0, -8.0))


def going(*goals, then=()):
    """Return a plan in which a robot drives through the gate."""
    moves = [Move("robot", goal) for goal in goals]
    steps = [Instruction(each, f"s{n}", n, (f"s{n}",), (f"s{n}",)) for n, each in enumerate((*moves, *then), start=1)]
    roles = {"robot": RoleBinding("robot", "robot01", ("move",))}
    return Plan((*steps, Instruction(End())), roles, zones=(GATE,))


@pytest.fixture
def hall(factory, monkeypatch):
    """The factory with a door across it, which closes at once behind the last."""
    monkeypatch.setattr(doors, "HOLD_S", 0.0)
    monkeypatch.setattr(doors, "SETTLE_S", 0.0)
    put_in_world(factory)
    row = Device.objects.get(id="robot01")
    body = description_to_json(DOOR)
    Device.objects.create(
        id="door02", site=row.site, lifecycle="approved", description=body, online=True, properties={"state": "closed"}
    )
    return factory


def put_in_world(factory, *faults):
    poses = {"robot01": Pose(4.0, -8.0, 0.0, 0.0)}
    scene = Scene(demo_floor.grid(), [*DEVICES, DOOR], seed=1, poses=poses, faults=faults)
    factory.world = make_world(scene=scene, driver="kinematic")
    Device.objects.filter(id="robot01").update(pose={"x": 4.0, "y": -8.0, "z": 0.0, "theta": 0.0})


def told():
    return list(Command.objects.filter(device="door02").order_by("position").values_list("method", "status"))


def floor_now():
    return pure.from_json(FloorState.objects.get(site__slug=SITE).state)


def is_in_the_gate():
    state = FloorState.objects.filter(site__slug=SITE).first()
    robot = pure.from_json(state.state).robots["robot01"] if state and state.state else None
    return robot is not None and 9.0 <= robot.x <= 10.0


def test_a_run_passes_a_door_that_opens_for_it_and_closes_behind_it(hall):
    run = hall.start(going(EAST))
    hall.go(lambda: run_status(run) == "finished")
    hall.go(lambda: ("close", "done") in told())
    assert told() == [("open", "done"), ("close", "done")]
    assert Device.objects.get(id="door02").properties["state"] == "closed"
    assert not floor_now().doors["door02"].ours


def test_a_floor_that_another_process_goes_on_with_holds_the_door(hall, monkeypatch):
    run = hall.start(going(EAST, WEST))
    hall.go(is_in_the_gate, dt_s=0.2)
    monkeypatch.setattr(layouts, "_layouts", {})
    monkeypatch.setattr(drive, "_memories", OrderedDict())
    assert floor_now().doors["door02"].robots == ("robot01",)
    hall.go(lambda: run_status(run) == "finished")
    assert ("open", "done") in told()


def test_people_may_not_close_a_door_on_a_robot_and_may_open_it(hall):
    run = hall.start(going(EAST))
    hall.go(is_in_the_gate, dt_s=0.2)
    with pytest.raises(NotPossibleNow, match="Door 2 is held open for robots that pass"):
        services.call_method(site=SITE, device_id="door02", method="close", arguments={}, by="Ada")
    assert services.call_method(site=SITE, device_id="door02", method="open", arguments={}, by="Ada").method == "open"
    hall.go(lambda: run_status(run) == "finished")


def test_a_door_that_does_not_open_fails_the_run_and_is_an_alert(hall, monkeypatch):
    monkeypatch.setattr(doors, "WAIT_LIMIT_S", 3.0)
    monkeypatch.setattr(doors, "RETRY_S", 600.0)  # a machine that is busy for seconds must not try it again before that
    put_in_world(hall, Fault("door02", "fail_next"))
    run = hall.start(going(EAST))
    hall.go(lambda: run_status(run) == "failed")
    assert services.get_run(run_id=run).run.reason == "Door 2 did not open in time."
    codes = [event.code for event in services.list_events(run_id=run)]
    assert "door_shut" in codes
    alert = DeviceAlert.objects.get(device="door02", code="command_failed")
    assert alert.args["method"] == "open"


def test_stop_all_holds_the_door_and_the_run_goes_on_after(hall):
    run = hall.start(going(EAST))
    hall.go(is_in_the_gate, dt_s=0.2)
    services.press_stop(site=SITE, by="Ada")
    for _ in range(10):
        hall.work()
        hall.send()
        hall.pass_time(1.0)
        drive.advance_site(SITE)
    assert [method for method, _ in told() if method != "pause"] == ["open"]
    services.reset_stop(site=SITE, by="Ada")
    services.resume_run(run_id=run, by="Ada")
    hall.go(lambda: run_status(run) == "finished")
    hall.go(lambda: ("close", "done") in told())


def test_a_step_that_closes_the_door_of_another_run_waits_until_its_robot_is_through(hall):
    run = hall.start(going(EAST))
    hall.go(is_in_the_gate, dt_s=0.2)
    close = replace(going(), instructions=(closing(), Instruction(End())))
    other = hall.start(close)
    hall.work()
    assert "door_in_use" in [event.code for event in services.list_events(run_id=other)]
    hall.go(lambda: {run_status(run), run_status(other)} == {"finished"})


def closing():
    return Instruction(Call(PlaceRef(device="door02"), "close", {}), "c1", 1, ("c1",), ("c1",))


def test_a_door_that_is_away_when_a_robot_needs_it_is_an_alert(hall):
    Device.objects.filter(id="door02").update(online=False, last_seen_at=datetime.now(UTC))
    run = hall.start(going(EAST))
    hall.go(lambda: "door_away" in [event.code for event in services.list_events(run_id=run)])
    watch_alerts(now=datetime.now(UTC) + timedelta(minutes=1), since=datetime.now(UTC) - timedelta(hours=1))
    assert DeviceAlert.objects.filter(device="door02", code="offline_at_work", over_at=None).exists()
    assert "robot01" in floor_now().doors["door02"].robots
