"""A small hall with a shelf, an oven, rollers and a bench nobody knows the class of, for the tests of the world."""

from __future__ import annotations

from registry.floorplan.plan import Grid
from simulation.world import Scene
from vipo_device.protocol.description import Description, MethodSpec, ParameterSpec, Pose, PropertySpec, Size

WIDTH, HEIGHT, CELL_M = 240, 160, 0.05
GOODS = (ParameterSpec("object", "object"), ParameterSpec("value", "number"))
PICKING = (ParameterSpec("device", "device"), *GOODS)


def hall(*, wall_at_x: float | None = None) -> Grid:
    """Return an empty room of 12 x 8 m with walls around it, and one across at x if asked for."""
    cells = bytearray(WIDTH * HEIGHT)
    for row in range(HEIGHT):
        for column in range(WIDTH):
            edge = row in (0, HEIGHT - 1) or column in (0, WIDTH - 1)
            across = wall_at_x is not None and column == round(wall_at_x / CELL_M)
            cells[row * WIDTH + column] = 100 if edge or across else 0
    return Grid(WIDTH, HEIGHT, CELL_M, 0.0, 0.0, bytes(cells))


def method(name: str, *parameters: ParameterSpec) -> MethodSpec:
    return MethodSpec(name, f"down/{name}", parameters=parameters)


def robot(name: str, x: float, y: float, theta: float = 0.0, capacity: int = 2) -> Description:
    return Description(
        id=name,
        name=name.title(),
        kind="robot",
        device_class="turtlebot",
        pose=Pose(x, y, 0.0, theta),
        size=Size(0.36, 0.36, 0.42),
        capacity=capacity,
        radius_m=0.18,
        speed_m_s=0.5,
        properties=(PropertySpec("battery", "number", "PERCENT", 0, 100), PropertySpec("load", "text")),
        methods=(
            method("move", ParameterSpec("path", "location")),
            method("pick", *PICKING),
            method("drop", *PICKING),
            method("wave"),
        ),
    )


SHELF = Description(
    id="shelf",
    name="Shelf",
    kind="machine",
    device_class="shelf",
    pose=Pose(3.0, 7.0),
    size=Size(2.0, 1.0, 1.8),
    gives=("box",),
    properties=(PropertySpec("stock", "number", "", 0, 24),),
    methods=(method("dispense", *GOODS),),
)
OVEN = Description(
    id="oven",
    name="Oven",
    kind="machine",
    device_class="oven",
    pose=Pose(8.0, 7.0),
    size=Size(2.0, 1.0, 1.5),
    gives=("box",),
    takes=("box",),
    properties=(
        PropertySpec("jobStatus", "number", "PERCENT", 0, 100),
        PropertySpec("temperature", "number", "DEG_C", 15, 250),
        PropertySpec("quality", "text", options=("ok", "scratched")),
    ),
    methods=(method("curePaint", ParameterSpec("time", "number", "MIN", 1, 60)),),
)
ROLLERS = Description(
    id="rollers",
    name="Rollers",
    kind="machine",
    device_class="rollers",
    pose=Pose(8.0, 1.0),
    size=Size(2.0, 1.0, 0.8),
    takes=("box",),
    properties=(PropertySpec("freeSlots", "number", "", 0, 2),),
    methods=(method("accept", *GOODS),),
)
BENCH = Description(
    id="bench",
    name="Bench",
    kind="machine",
    device_class="quantum-welder",
    pose=Pose(3.0, 1.0),
    size=Size(1.0, 1.0, 1.0),
    properties=(PropertySpec("jobStatus", "number"), PropertySpec("mode", "text", options=("slow", "fast"))),
    methods=(
        method("weld", ParameterSpec("mode", "text", options=("slow", "fast"))),
        method("cool", ParameterSpec("time", "number", "SEC", 0, 100)),
    ),
)
MACHINES = (SHELF, OVEN, ROLLERS, BENCH)
ROBOT = robot("robot", 3.0, 4.0)


def scene(*robots: Description, **more: object) -> Scene:
    """Return the hall with its machines and the robots (one in the middle unless others are named)."""
    return Scene(hall(), (*MACHINES, *(robots or (ROBOT,))), **more)  # type: ignore[arg-type]
