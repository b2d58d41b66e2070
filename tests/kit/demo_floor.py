"""The painting factory for tests: its grid, its devices and its docks, from the demo's floor plan."""

from functools import cache
from typing import Any

from editor.language.site.surroundings import PlaceFacts
from execution.traffic.layout import Layout, make_layout
from registry.demo.factory import make_grid, read_plan
from registry.floorplan.plan import Grid
from simulation.world import Scene
from vipo_device.protocol.description import Description, MethodSpec, ParameterSpec, Pose, PropertySpec, Size

OBJECT = (ParameterSpec("object", "object"), ParameterSpec("value", "number"))
TIME = (ParameterSpec("time", "number", "MIN", 1, 60),)
METHODS: dict[str, dict[str, tuple[ParameterSpec, ...]]] = {
    "shelf": {"dispense": OBJECT},
    "cans": {"dispense": OBJECT},
    "mixer": {"mixPaint": TIME, "dispense": OBJECT},
    "booth": {"paint": TIME},
    "oven": {"curePaint": TIME},
    "rollers": {"accept": OBJECT},
}
GIVES = {"shelf": ("box",), "cans": ("can",), "mixer": ("can",), "booth": ("box",), "oven": ("box",)}
TAKES = {"mixer": ("can",), "booth": ("box", "can"), "oven": ("box",), "rollers": ("box",)}


def _methods(device: str, methods: dict[str, tuple[ParameterSpec, ...]]) -> tuple[MethodSpec, ...]:
    return tuple(MethodSpec(m, f"vipo/v1/dev/{device}/down/{m}", "", "", p) for m, p in methods.items())


def _machine(item: dict[str, Any]) -> Description:
    kind, (x, y), (width, depth) = item["kind"], item["at"], item["size"]
    return Description(
        id=item["id"],
        name=item["name"],
        kind="machine",
        device_class=kind,
        pose=Pose(x, -y),
        size=Size(width, depth, 1.0),
        site="painting-factory",
        simulated=True,
        gives=GIVES.get(kind, ()),
        takes=TAKES.get(kind, ()),
        properties=(PropertySpec("temperature", "number", "DEG_C"), PropertySpec("quality", "text")),
        methods=_methods(item["id"], METHODS[kind]),
    )


def _robot(number: int, x: float, y: float) -> Description:
    device = f"robot{number:02}"
    robot_methods: dict[str, tuple[ParameterSpec, ...]] = {"move": (), "pick": OBJECT, "drop": OBJECT}
    return Description(
        id=device,
        name=f"TurtleBot {number}",
        kind="robot",
        device_class="turtlebot",
        pose=Pose(x, y, 0.0, 1.5708),
        size=Size(0.36, 0.36, 0.3),
        site="painting-factory",
        simulated=True,
        capacity=2,
        radius_m=0.18,
        speed_m_s=0.5,
        methods=_methods(device, robot_methods),
    )


@cache
def grid() -> Grid:
    return make_grid(read_plan())


@cache
def devices() -> tuple[Description, ...]:
    plan = read_plan()
    robots = [_robot(i + 1, x, -y) for i, (x, y) in enumerate(plan["docks"])]
    return (*(_machine(item) for item in plan["devices"]), *robots)


@cache
def places() -> tuple[PlaceFacts, ...]:
    docks = read_plan()["docks"]
    return tuple(PlaceFacts(f"dock{i + 1}", f"Dock {i + 1}", "dock", x, -y, 1.5708) for i, (x, y) in enumerate(docks))


@cache
def layout() -> Layout:
    return make_layout(grid(), devices(), places())


def scene(**more: Any) -> Scene:
    """Return the factory for a simulated world."""
    return Scene(grid(), devices(), seed=1, **more)
