"""The halls and programs that the measurements of the map look at; run in a process of its own beside a demo.

-m bench.canvas.filling EMAIL     makes the hall, lets that person draw in it, prints the ids of the programs as JSON
"""

from __future__ import annotations

import json
import sys
from typing import Any, Literal

import django

from bench.programs import Json, make_program

HALL, FACTORY = "long-hall", "painting-factory"
TOUR = "a tour of all robots"
WIDTH_M, HEIGHT_M, CELL_M = 112, 74, 0.25
MACHINES, ROBOTS = 30, 50
COUNTS = (15, 500, 2000)
COLUMNS, ROWS = 40, 50
"""Where constructs of the hall stand: 2.8 m and 1.45 m apart, so that none lies on another."""


def machine_id(number: int) -> str:
    """Return the name of one of the hall's machines."""
    return f"hallMachine{number:02d}"


def robot_id(number: int) -> str:
    """Return the name of one of the hall's robots."""
    return f"hallRobot{number:02d}"


def hall_program(count: int) -> Json:
    """Return a program of that many constructs, each near to the one before it and none over another."""
    document = make_program(count)
    places = COLUMNS * ROWS
    for index, step in enumerate(document["steps"].values()):
        row, column = divmod(index * (places // count if count > 100 else 1), COLUMNS)
        x, y = 1.4 + column * (WIDTH_M - 2.8) / (COLUMNS - 1), -(1.2 + row * (HEIGHT_M - 2.4) / (ROWS - 1))
        step["pos"] = [round(x, 2), round(y, 2)]
        step["params"] = _here(step["params"], x, y, index)
    return {**document, "start_pos": [0.6, -0.5]}


def tour_program() -> Json:
    """Return a program in which every robot drives to places of its own, all at once."""
    steps: Json = {"all": _parallel(["program", "body", "V"], "abcde")}
    for number in range(ROBOTS):
        ten, one = divmod(number, 10)
        row, branch = f"row{ten}", "abcdefghij"[one]
        steps.setdefault(row, _parallel(["all", "abcde"[ten], "V"], "abcdefghij"))
        x, y = 6 + one * 11.0, -(6 + ten * 13.0)
        for visit, (east, north) in enumerate(((3, 0), (3, 3), (0, 3), (0, 0)) * 4):
            steps[f"v{number}x{visit}"] = {
                "kind": "move", "place": [row, branch, f"{visit + 1}V"], "pos": [x + east, y + north],
                "params": {"role": f"r{number}", "to": _point(x + east, y + north)},
            }  # fmt: skip
    roles = {f"r{number}": {"name": f"r{number}", "device": robot_id(number)} for number in range(ROBOTS)}
    return {"format": 1, "steps": steps, "functions": {}, "roles": roles, "parameters": {}, "zones": {}}


def _parallel(place: list[str], branches: str) -> Json:
    return {"kind": "parallel", "place": place, "pos": [2, -2], "params": {"branches": list(branches)}}


def _here(params: Json, x: float, y: float, index: int) -> Json:
    """Let a step speak of the hall's machines and of places beside it."""
    said = {**params}
    if "route" in said:
        said |= {"source": _point(x - 1, y), "target": _point(x + 1, y)}
        said["route"] = [[round(x, 2), round(y, 2)]]
    if "to" in said:
        said["to"] = _point(x + 1, y)
    if "device" in said:
        said |= {"device": {"device": machine_id(index % MACHINES)}, "method": "heat", "args": {"value": 1}}
    for name in ("condition", "until"):
        if name in said:
            reading = {"property": [machine_id(index % MACHINES), "temperature"]}
            said[name] = {"op": ">", "args": [reading, 30 + index % 97 / 2]}
    return said


def _point(x: float, y: float) -> Json:
    inside = min(max(x, 0.5), WIDTH_M - 0.5), min(max(y, 0.5 - HEIGHT_M), -0.5)
    return {"point": [round(inside[0], 2), round(inside[1], 2)]}


def _fill(email: str) -> Json:
    from registry import services as registry
    from registry.floorplan.plan import Grid
    from registry.models import User

    wide, high = int(WIDTH_M / CELL_M), int(HEIGHT_M / CELL_M)
    registry.create_site(name="Long hall", slug=HALL)
    registry.save_map(site=HALL, grid=Grid(wide, high, CELL_M, 0.0, -float(HEIGHT_M), bytes(wide * high)))
    registry.set_member(site=HALL, email=email, role="author")
    _fill_devices()
    user = User.objects.get(email=email)
    made: Json = {}
    for site, make in ((FACTORY, make_program), (HALL, hall_program)):
        for count in COUNTS:
            made[f"{site} {count}"] = _save(site, f"{count} constructs", make(count), user)
    made[TOUR] = _save(HALL, TOUR, tour_program(), user)
    return made


def _save(site: str, name: str, document: Json, user: Any) -> str:
    from editor.rooms.content_update import read_content, write_document
    from editor.services import create_program

    program = create_program(site=site, name=name, user=user)
    write_document(
        program_id=program.id, document=document, tag=read_content(program_id=program.id).tag, author=user.pk
    )
    return str(program.id)


def _fill_devices() -> None:
    from bench.hall import approved_row
    from registry.models import Device, Site
    from vipo_device.protocol.description import Description, MethodSpec, ParameterSpec, Pose, PropertySpec, Size

    def describe(name: str, number: int, kind: Literal["machine", "robot"], at: Pose) -> Description:
        methods = ("move", "pick", "drop") if kind == "robot" else ("heat", "dispense", "accept")
        value = (ParameterSpec("value", "number"),)
        return Description(
            name, f"{kind.title()} {number}", kind, "turtlebot" if kind == "robot" else "oven", at, Size(0.4, 0.4, 0.4),
            site=HALL, radius_m=0.18 if kind == "robot" else 0.0, speed_m_s=0.5 if kind == "robot" else 0.0,
            properties=(PropertySpec("temperature", "number", "DEG_C", -20, 120),),
            methods=tuple(
                MethodSpec(m, f"vipo/v1/dev/{name}/down/{m}", parameters=() if m == "move" else value) for m in methods
            ),
        )  # fmt: skip

    site = Site.objects.get(slug=HALL)
    machines = [
        describe(machine_id(n), n, "machine", Pose(9 + n % 10 * 10.4, -(12 + n // 10 * 24.0))) for n in range(MACHINES)
    ]
    robots = [describe(robot_id(n), n, "robot", Pose(6 + n % 10 * 11.0, -(6 + n // 10 * 13.0))) for n in range(ROBOTS)]
    Device.objects.bulk_create(approved_row(each, site) for each in machines + robots)


def main(arguments: list[str]) -> dict[str, Any]:
    """Fill the database that the environment names."""
    django.setup()
    return _fill(arguments[0])


if __name__ == "__main__":
    print(json.dumps(main(sys.argv[1:])))
