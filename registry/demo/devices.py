"""What the painting factory's devices say of themselves.

`python -m registry.demo.devices` writes their RDF, and the devices of the site file that programs are checked with.
"""

from __future__ import annotations

import json
from math import pi
from pathlib import Path
from typing import Any

from registry.demo.factory import FOLDER, read_plan
from vipo_device.descriptions.reader import write_description
from vipo_device.protocol.description import (
    Description,
    MethodSpec,
    ParameterSpec,
    Pose,
    PropertySpec,
    Size,
    description_to_json,
)
from vipo_device.protocol.messages import down_topic

SITE = "painting-factory"
DEVICES = FOLDER / "devices"
SITE_FILE = FOLDER.parents[1] / "examples" / "painting-factory.json"
PENDING_DEVICE = "paintMixer03"
ROBOT_RADIUS_M = 0.18
DOCK_HEADING_RAD = pi / 2
_HEIGHT_M = {"shelf": 1.8, "cans": 1.2, "mixer": 1.2, "booth": 1.6, "oven": 1.5, "rollers": 0.8}
_GIVES = {"shelf": ("box",), "cans": ("can",), "mixer": ("can",), "booth": ("box",), "oven": ("box",)}
_TAKES = {"mixer": ("can",), "booth": ("box", "can"), "oven": ("box",), "rollers": ("box",)}
_TEXTS = {
    "shelf": "Keeps boxes and hands them to robots.",
    "cans": "Keeps cans of paint and hands them to robots.",
    "mixer": "Mixes a can of paint for the given time.",
    "booth": "Paints a box with the paint from a can for the given time.",
    "oven": "Cures the paint on a box for the given time.",
    "rollers": "Takes finished boxes for dispatch.",
}


def _percent(name: str, title: str) -> PropertySpec:
    return PropertySpec(name, "number", "PERCENT", 0.0, 100.0, title)


def _count(name: str, most: float, title: str) -> PropertySpec:
    return PropertySpec(name, "number", "", 0.0, most, title)


_PROPERTIES: dict[str, tuple[PropertySpec, ...]] = {
    "shelf": (_count("stock", 24.0, "Boxes in stock"),),
    "cans": (_count("stock", 8.0, "Cans in stock"),),
    "mixer": (_percent("jobStatus", "Job"), PropertySpec("temperature", "number", "DEG_C", 0.0, 80.0, "Temperature")),
    "booth": (_percent("jobStatus", "Job"), PropertySpec("pressure", "number", "BAR", 0.0, 10.0, "Air pressure")),
    "oven": (
        _percent("jobStatus", "Job"),
        PropertySpec("temperature", "number", "DEG_C", 15.0, 250.0, "Temperature"),
        PropertySpec("quality", "text", title="Quality", options=("ok", "scratched")),
    ),
    "rollers": (_count("freeSlots", 9.0, "Free slots"),),
}
_TIMED = {
    "mixer": ("mixPaint", "Mix paint", 30.0),
    "booth": ("paint", "Paint", 30.0),
    "oven": ("curePaint", "Cure paint", 60.0),
}
_DISPENSES, _ACCEPTS = {"shelf", "cans", "mixer"}, {"rollers"}


def describe_devices() -> tuple[Description, ...]:
    """Return the descriptions of every device of the demo, the pending one last."""
    plan = read_plan()
    machines = tuple(_machine(device) for device in plan["devices"])
    robots = tuple(_robot(number, *at) for number, at in enumerate(plan["docks"], 1))
    pending = {"id": PENDING_DEVICE, "name": PENDING_DEVICE, "kind": "mixer", "at": [16.2, 3.75], "size": [0.8, 0.8]}
    return (*machines, *robots, _machine(pending))


def _machine(device: dict[str, Any]) -> Description:
    kind = device["kind"]
    x, y = device["at"]
    size_x, size_y = device["size"]
    return Description(
        id=device["id"],
        name=device["name"],
        kind="machine",
        device_class=kind,
        pose=Pose(x, -y, 0.0, 0.0),
        size=Size(size_x, size_y, _HEIGHT_M[kind]),
        description=_TEXTS[kind],
        site=SITE,
        simulated=True,
        gives=_GIVES.get(kind, ()),
        takes=_TAKES.get(kind, ()),
        properties=_PROPERTIES[kind],
        methods=tuple(_machine_methods(device["id"], kind)),
    )


def _machine_methods(device_id: str, kind: str) -> list[MethodSpec]:
    methods = []
    if kind in _TIMED:
        name, title, longest = _TIMED[kind]
        time = ParameterSpec("time", "number", "MIN", 1.0, longest)
        methods.append(MethodSpec(name, down_topic(device_id, name), "time", title, (time,)))
    if kind in _DISPENSES:
        methods.append(_hand_over(device_id, "dispense", "Dispense", _GIVES[kind]))
    if kind in _ACCEPTS:
        methods.append(_hand_over(device_id, "accept", "Accept", _TAKES[kind]))
    return methods


def _hand_over(device_id: str, name: str, title: str, objects: tuple[str, ...]) -> MethodSpec:
    parameters = (ParameterSpec("object", "object", options=objects), ParameterSpec("value", "number", "", 1.0, 24.0))
    return MethodSpec(name, down_topic(device_id, name), "object", title, parameters)


def _robot(number: int, x: float, y: float) -> Description:
    robot_id = f"robot{number:02}"
    return Description(
        id=robot_id,
        name=f"TurtleBot {number}",
        kind="robot",
        device_class="turtlebot",
        pose=Pose(x, -y, 0.0, round(DOCK_HEADING_RAD, 4)),
        size=Size(2 * ROBOT_RADIUS_M, 2 * ROBOT_RADIUS_M, 0.42),
        description="Carries up to two objects.",
        site=SITE,
        simulated=True,
        capacity=2,
        radius_m=ROBOT_RADIUS_M,
        speed_m_s=0.5,
        properties=(_percent("battery", "Battery"), PropertySpec("load", "text", title="Load")),
        methods=tuple(_robot_methods(robot_id)),
    )


def _robot_methods(robot_id: str) -> list[MethodSpec]:
    hand = (
        ParameterSpec("device", "device"),
        ParameterSpec("object", "object"),
        ParameterSpec("value", "number", "", 1.0, 2.0),
    )
    described = (
        ("move", "location", (ParameterSpec("path", "location"),)),
        ("pick", "object", hand),
        ("drop", "object", hand),
        ("honk", "signal", (ParameterSpec("times", "number", "", 1.0, 10.0),)),
        ("blink", "signal", (ParameterSpec("time", "number", "SEC", 1.0, 60.0),)),
    )
    return [MethodSpec(n, down_topic(robot_id, n), message, n.capitalize(), given) for n, message, given in described]


def write_devices(folder: Path = DEVICES) -> None:
    """Write each device's description as Turtle."""
    folder.mkdir(exist_ok=True)
    for description in describe_devices():
        (folder / f"{description.id}.ttl").write_text(write_description(description))


def with_devices(site_file: str) -> str:
    """Return a site file with the demo's devices as its devices; what is empty is left out of them."""
    devices = [_without_empty(description_to_json(description)) for description in describe_devices()]
    devices[-1]["lifecycle"] = "pending"
    site = json.loads(site_file) | {"devices": devices}
    return json.dumps(site, indent=1, ensure_ascii=False) + "\n"


def _without_empty(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _without_empty(one) for key, one in value.items() if one not in (None, "", [])}
    return [_without_empty(one) for one in value] if isinstance(value, list) else value


def read_demo_descriptions() -> dict[str, bytes]:
    """Return what each device of the demo says of itself, as its file has it, by id."""
    return {path.stem: path.read_bytes() for path in sorted(DEVICES.glob("*.ttl"))}


if __name__ == "__main__":
    write_devices()
    SITE_FILE.write_text(with_devices(SITE_FILE.read_text()))
