"""What a machine does follows from what it says of itself, whatever its class is called."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import product

import pytest

from simulation.behaviour import behaviour_of
from simulation.kind_file import default_kinds, read_kinds
from simulation.services import make_world
from simulation.world import Ack, Fault, PropertyChanged, Scene, WorldEvent
from tests.unit.simulation.stage_set import OVEN, ROBOT, ROLLERS, hall, method
from vipo_device.descriptions.reader import read_description, write_description
from vipo_device.protocol.description import Description, ParameterSpec, Pose, PropertySpec, Scalar, Size

PRESS = Description(
    id="press01",
    name="Press",
    kind="machine",
    device_class="hydraulic-press",
    pose=Pose(8.0, 7.0),
    size=Size(1.0, 1.0, 1.0),
    properties=(
        PropertySpec("force", "number", "KiloN", 0, 400),
        PropertySpec("die", "text", options=("flat", "round")),
        PropertySpec("oil", "number", "K", 250, 370),
        PropertySpec("pressure", "number", "KiloPA", 0, 1000),
        PropertySpec("cycles", "number", "", 0, 2),
        PropertySpec("locked", "boolean"),
    ),
    methods=(
        method(
            "pressPart",
            ParameterSpec("force", "number", "KiloN", 0, 400),
            ParameterSpec("die", "text", options=("flat", "round")),
            ParameterSpec("dwell", "number", "SEC", 0, 600),
        ),
        method("lock", ParameterSpec("locked", "boolean")),
    ),
)
TIME = ParameterSpec("time", "number", "MIN", 1, 60)
CURE = ("curePaint", {"time": 1})


def story(device: Description, *calls: tuple[str, Mapping[str, object]], **more: object) -> list[WorldEvent]:
    """Return all that a machine says while it is told the calls, one every minute and a half."""
    world = make_world(scene=Scene(hall(), (device,), **more), driver="kinematic")  # type: ignore[arg-type]
    said: list[WorldEvent] = []
    for number, (name, arguments) in enumerate(calls):
        world.command(device.id, name, arguments, f"c{number}")
        for _ in range(90):
            said += world.advance(1.0)
    world.close()
    return said


def readings_after(device: Description, *calls: tuple[str, Mapping[str, object]]) -> Mapping[str, Scalar]:
    """Return the readings ten seconds after the last of the calls, which are one second apart."""
    world = make_world(scene=Scene(hall(), (device,)), driver="kinematic")
    for number, (name, arguments) in enumerate(calls):
        world.command(device.id, name, arguments, f"c{number}")
        world.advance(10.0)
    return world.readings()[device.id]


@pytest.mark.parametrize("seed", [0, 1, 7])
def test_a_kiln_with_the_ovens_rdf_behaves_like_the_oven(seed: int) -> None:
    rdf = write_description(OVEN)
    oven = read_description(rdf.encode())
    kiln = read_description(rdf.replace('vipo:deviceClass "oven"', 'vipo:deviceClass "kiln"').encode())
    assert (oven.device_class, kiln.device_class) == ("oven", "kiln")
    told = story(oven, *[CURE] * 6, seed=seed)
    assert any(isinstance(e, Ack) and e.result for e in told)
    assert repr(story(kiln, *[CURE] * 6, seed=seed)) == repr(told)


def test_a_press_that_nobody_wrote_shows_what_it_was_told_and_counts() -> None:
    before = readings_after(PRESS)
    assert (before["force"], before["cycles"], before["oil"]) == (0, 0, 295.1)
    press = ("pressPart", {"force": 250, "die": "round", "dwell": 5})
    after = readings_after(PRESS, press)
    assert (after["force"], after["die"], after["cycles"]) == (250, "round", 1)
    assert after["locked"] is False
    assert readings_after(PRESS, press, ("lock", {"locked": True}))["locked"] is True
    assert readings_after(PRESS, press, press, press, press)["cycles"] == 2, "its range ends there"


def test_no_argument_sets_what_follows_from_the_stock() -> None:
    count = method("recount", ParameterSpec("stock", "number"))
    cupboard = replace(PRESS, methods=(count,), properties=(PropertySpec("stock", "number", "", 0, 9),), gives=("box",))
    assert readings_after(cupboard, ("recount", {"stock": 4}))["stock"] == 9


def test_readings_keep_to_their_units() -> None:
    world = make_world(scene=Scene(hall(), (PRESS,)), driver="kinematic")
    world.command("press01", "pressPart", {"force": 1, "die": "flat", "dwell": 600}, "c")
    world.advance(590.0)
    assert world.readings()["press01"]["pressure"] == 250.0, "2.5 bar"
    oil = world.readings()["press01"]["oil"]
    assert isinstance(oil, float)
    assert oil == pytest.approx(273.15 + 34, abs=0.6)
    world.advance(20.0)
    assert world.readings()["press01"]["pressure"] == 0.0


@pytest.mark.parametrize(
    ("unit", "most", "shown"),
    [
        ("DEG_C", 100.0, 80.0),
        ("K", 1500.0, 353.15),
        ("DEG_F", 212.0, 176.0),
        ("DEG_C", 99.0, 34.0),
        ("DEG_C", None, 34.0),
    ],
)
def test_what_may_reach_100_degrees_by_its_range_is_hot_while_it_works_whatever_it_is_called(
    unit: str, most: float | None, shown: float
) -> None:
    heat = PropertySpec("heat", "number", unit, None, most)
    lehr = replace(
        PRESS, id="lehr", device_class="annealing-lehr", properties=(heat,), methods=(method("anneal", TIME),)
    )
    world = make_world(scene=Scene(hall(), (lehr,)), driver="kinematic")
    world.command("lehr", "anneal", {"time": 20}, "c")
    world.advance(1190.0)
    assert world.readings()["lehr"]["heat"] == pytest.approx(shown, abs=0.6)


def test_a_set_point_is_what_a_machine_warms_to() -> None:
    heats = replace(
        OVEN,
        methods=(method("heat", ParameterSpec("temperature", "number", "DEG_C"), ParameterSpec("time", "number")),),
    )
    world = make_world(scene=Scene(hall(), (heats,)), driver="kinematic")
    world.command("oven", "heat", {"temperature": 180, "time": 60}, "c")
    world.advance(3500.0)
    assert world.readings()["oven"]["temperature"] == pytest.approx(180, abs=0.6)


def test_a_set_point_and_what_is_left_of_a_job_are_in_the_units_of_the_readings() -> None:
    asked = (ParameterSpec("temperature", "number", "DEG_F"), ParameterSpec("force", "number", "N"), TIME)
    lehr = replace(
        OVEN, methods=(method("heat", *asked),), properties=(*OVEN.properties, PropertySpec("force", "number", "N"))
    )
    world = make_world(scene=Scene(hall(), (lehr,)), driver="kinematic")
    world.command("oven", "heat", {"temperature": 356, "force": 7, "time": 60}, "c")
    world.advance(3500.0)
    assert world.readings()["oven"]["temperature"] == pytest.approx(180, abs=0.6)

    saw = replace(
        PRESS,
        properties=(PropertySpec("cut", "number", "MilliM", 0, 600),),
        methods=(method("saw", ParameterSpec("cut", "number", "CentiM"), ParameterSpec("time", "number", "SEC")),),
    )
    assert readings_after(saw, ("saw", {"cut": 12, "time": 1}))["cut"] == 120


def test_what_shows_whether_a_machine_works_shows_before_the_first_job_that_it_rests() -> None:
    lines = (
        'version = 1\n[[kinds]]\nname = "pressing"\nwhen = { methods = ["pressPart"] }\n'
        '[kinds.readings]\npressure = { law = "while_working", unit = "BAR", resting = 1.0, working = 2.5 }\n'
    )
    world = make_world(scene=Scene(hall(), (PRESS,), kinds=(*default_kinds(), *read_kinds(lines))), driver="kinematic")
    assert world.readings()["press01"]["pressure"] == 100.0, "1 bar"
    kept = Scene(
        hall(), (PRESS,), kinds=(*default_kinds(), *read_kinds(lines)), readings={"press01": {"pressure": 250.0}}
    )
    assert make_world(scene=kept, driver="kinematic").readings()["press01"]["pressure"] == 250.0


def test_the_same_seed_is_the_same_course_and_another_one_is_another() -> None:
    def qualities(seed: int) -> list[object]:
        return [e.result["quality"] for e in story(OVEN, *[CURE] * 10, seed=seed) if isinstance(e, Ack) and e.result]

    assert qualities(0).count("scratched") == 2
    assert qualities(3) == qualities(3)
    assert len({tuple(qualities(seed)) for seed in range(1, 4)}) == 3


def test_what_takes_no_said_time_takes_a_little_more_or_less() -> None:
    accept = ("accept", {"object": "box", "value": 1})

    def lasts(seed: int) -> float:
        return next(e.t_s for e in story(ROLLERS, accept, seed=seed) if isinstance(e, Ack) and e.status == "DONE")

    assert lasts(0) == 2.0
    drawn = [lasts(seed) for seed in range(1, 9)]
    assert all(1.75 <= t_s <= 2.25 for t_s in drawn)
    assert len(set(drawn)) > 1


WELDING = """
version = 1
[[kinds]]
name = "pressing"
when = { methods = ["pressPart"], properties = ["force"] }
job_s = 40.0
[kinds.needs.pressPart]
blank = 1
[kinds.uses.pressPart]
blank = 1
[kinds.fails]
pressPart = 1.0
"""


def test_lines_in_the_file_make_a_machine_need_use_up_and_fail() -> None:
    kinds = (*default_kinds(), *read_kinds(WELDING))
    press = ("pressPart", {"force": 1, "die": "flat", "dwell": 1})

    def answers(seed: int, blanks: int) -> list[tuple[str, str]]:
        said = story(PRESS, press, press, kinds=kinds, seed=seed, stocks={"press01": {"blank": blanks}})
        return [(e.status, e.why) for e in said if isinstance(e, Ack) and e.is_final]

    assert answers(0, 1) == [("DONE", ""), ("REJECTED", "Press cannot pressPart: it has 0 blank and needs 1.")]
    assert answers(1, 1) == [("FAILED", "Press broke down at pressPart.")] * 2


def test_a_kind_for_one_id_is_no_other_devices() -> None:
    kinds = read_kinds('version = 1\n[[kinds]]\nname = "mine"\nwhen = { ids = ["press01"] }\nslots = 3\n')
    assert (behaviour_of(PRESS, kinds).slots, behaviour_of(OVEN, kinds).slots) == (3, 8)


def test_a_robot_with_an_empty_battery_stands_until_it_is_charged() -> None:
    away = {"robot": Pose(6.0, 4.0)}
    low = {"robot": {"battery": 0.01}}
    move = {"path": [[6.0, 4.0], [10.0, 4.0]]}
    world = make_world(scene=Scene(hall(), (ROBOT,), poses=away, readings=low), driver="kinematic")
    world.command("robot", "move", move, "m")
    said = [e for e in world.advance(20.0) if isinstance(e, Ack) and e.is_final]
    assert [(e.status, e.why) for e in said] == [("FAILED", "The battery of Robot is empty; charge it.")]
    at = world.robots()["robot"].pose
    assert 6.0 < at.x < 9.0
    world.command("robot", "move", {"path": [[at.x, 4.0], [10.0, 4.0]]}, "again")
    assert [e.status for e in world.advance(20.0) if isinstance(e, Ack)] == ["REJECTED"]
    assert world.robots()["robot"].pose == at


LATE = Fault("robot", "late", at_s=5000.0, after_s=1.0)


@pytest.mark.parametrize("faults", [(), (LATE,)], ids=["well", "with a fault to come"])
def test_a_robot_charges_at_home_and_goes_on(faults: tuple[Fault, ...]) -> None:
    empty = Scene(hall(), (ROBOT,), readings={"robot": {"battery": 0}}, faults=faults)
    world = make_world(scene=empty, driver="kinematic")
    world.advance(900.0)
    assert world.readings()["robot"]["battery"] == 50
    world.command("robot", "move", {"path": [[3.0, 4.0], [5.0, 4.0]]}, "m")
    assert [e.status for e in world.advance(20.0) if isinstance(e, Ack)][-1] == "DONE"


def test_a_robot_that_stands_with_work_uses_no_more_than_one_that_has_none() -> None:
    away = {"robot": Pose(6.0, 4.0)}
    charges = []
    for does in ("rest", "wave", "wait", "drive"):
        slow = {"robot": {"wave": 2000.0}}
        world = make_world(scene=Scene(hall(), (ROBOT,), poses=away, paces=slow), driver="kinematic")
        if does != "rest":
            move = {"path": [[11.0 - x % 2 * 10, 4.0] for x in range(200)]}
            world.command("robot", "wave" if does == "wave" else "move", {} if does == "wave" else move, "c")
        if does == "wait":
            world.command("robot", "pause", {}, "p")
        world.advance(3600.0)
        assert world.busy()["robot"] is (does != "rest")
        charges.append(round(world.robots()["robot"].battery))
        world.close()
    assert charges == [96, 96, 96, 75]


@pytest.mark.parametrize(
    ("spec", "shown"),
    [
        (PropertySpec("battery", "number", "V", 20, 29), 24.6),
        (PropertySpec("battery", "number", "V"), 0),
        (PropertySpec("battery", "text"), "full"),
        (PropertySpec("battery", "boolean"), True),
    ],
)
def test_a_battery_that_is_not_told_in_per_cent_stays_as_it_is_and_is_never_flat(
    spec: PropertySpec, shown: Scalar
) -> None:
    device = replace(ROBOT, properties=(spec,))
    low = Fault("robot", "battery", value=0.0)
    floor = Scene(
        hall(),
        (device,),
        poses={"robot": Pose(6.0, 4.0)},
        readings={"robot": {"battery": shown}},
        faults=(low,),
        delivery_s=60.0,
    )
    world = make_world(scene=floor, driver="kinematic")
    assert world.readings()["robot"] == {"battery": shown}
    said = world.advance(3660.0)
    assert [e for e in said if isinstance(e, PropertyChanged)] == []
    assert world.readings()["robot"] == {"battery": shown}
    world.command("robot", "move", {"path": [[6.0, 4.0], [8.0, 4.0]]}, "m")
    assert [e.status for e in world.advance(20.0) if isinstance(e, Ack)][-1] == "DONE"


@pytest.mark.parametrize("unit", ["PERCENT", "", "NUM"])
def test_a_number_without_a_measure_is_per_cent(unit: str) -> None:
    device = replace(ROBOT, properties=(PropertySpec("battery", "number", unit),))
    kept = {"robot": {"battery": 50}}
    floor = Scene(hall(), (device,), poses={"robot": Pose(6.0, 4.0)}, readings=kept)
    world = make_world(scene=floor, driver="kinematic")
    assert world.readings()["robot"]["battery"] == 50
    world.advance(3600.0)
    assert world.readings()["robot"]["battery"] == 46, "a day of standing"


def test_where_people_look_after_a_floor_they_change_an_empty_battery() -> None:
    floor = Scene(
        hall(), (ROBOT,), poses={"robot": Pose(6.0, 4.0)}, readings={"robot": {"battery": 0}}, delivery_s=60.0
    )
    world = make_world(scene=floor, driver="kinematic")
    world.advance(50.0)
    assert world.readings()["robot"]["battery"] == 0
    world.advance(20.0)
    assert world.readings()["robot"]["battery"] == 100


@pytest.mark.parametrize(("low", "high"), list(product([float("nan"), -5.0, 1e300], [float("nan"), -1e300, 0.0])))
def test_a_hostile_range_never_makes_a_world_raise(low: float, high: float) -> None:
    odd = replace(
        PRESS,
        properties=tuple(PropertySpec(p.name, p.type, p.unit, low, high) for p in PRESS.properties),
        methods=tuple(method(f"m{n}", ParameterSpec("time", "number", "SEC", low, high)) for n in range(10_000)),
    )
    for value in (-1, float("nan"), float("inf"), 10**400, "x", None, 0):
        assert all(isinstance(e, WorldEvent) for e in story(odd, ("m9999", {"time": value})))
