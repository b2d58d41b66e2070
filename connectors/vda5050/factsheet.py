"""A vehicle's factsheet as a VIPO description, and its state as the properties that the description names; pure."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from math import hypot

from connectors.vda5050.fields import Fields, read_fields
from connectors.vda5050.messages import VehicleName, VehicleState, read_header
from vipo_device.descriptions.plausibility import find_faults
from vipo_device.protocol.description import (
    Description,
    MethodSpec,
    ParameterSpec,
    Pose,
    PropertySpec,
    Scalar,
    Size,
    ValueType,
)
from vipo_device.protocol.loads import PARTING
from vipo_device.protocol.messages import MAX_TEXT, BadMessage, down_topic, fit_device_id

HANDLING = ("pick", "drop")
KEPT_FROM_PEOPLE = frozenset({"initPosition", "move", "pause", "resume", "cancel", *HANDLING})
"""Node actions that are offered in another way, or would make VIPO lose the vehicle."""
VALUE_TYPES: Mapping[str, ValueType] = {
    "BOOL": "boolean",
    "NUMBER": "number",
    "INTEGER": "number",
    "FLOAT": "number",
    "STRING": "text",
}
PROPERTIES = (
    PropertySpec("battery", "number", "PERCENT", 0.0, 100.0, "Battery"),
    PropertySpec("load", "text", title="Load"),
    PropertySpec("driving", "boolean", title="Driving"),
    PropertySpec("charging", "boolean", title="Charging"),
    PropertySpec("mode", "text", title="Operating mode"),
    PropertySpec("error", "text", title="Faults"),
    PropertySpec("warning", "text", title="Warnings"),
)
_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]{0,63}")
_UNFIT = re.compile(r"[^A-Za-z0-9_.-]")
_NO_PARTING = str.maketrans(dict.fromkeys(PARTING, "-"))


@dataclass(frozen=True, slots=True)
class Parameter:
    """A parameter of an action, as the factsheet tells it."""

    key: str
    type: str
    optional: bool


@dataclass(frozen=True, slots=True)
class Action:
    """An action that a vehicle can do, and where: INSTANT, NODE, EDGE."""

    type: str
    scopes: frozenset[str]
    parameters: tuple[Parameter, ...]
    text: str


@dataclass(frozen=True, slots=True)
class Factsheet:
    """What a vehicle is: metres, metres a second."""

    series: str
    vehicle_class: str
    length_m: float
    width_m: float
    height_m: float
    speed_m_s: float
    load_types: tuple[str, ...]
    load_positions: int
    actions: tuple[Action, ...]

    def can(self, action: str, scope: str) -> bool:
        """Tell whether the vehicle does an action there."""
        return any(a.type == action and scope in a.scopes for a in self.actions)


def read_factsheet(payload: bytes, name: VehicleName) -> Factsheet:
    """Read a factsheet; one without size and speed is refused, for such a vehicle could not be steered round others.

    Raises BadMessage.
    """
    fields = read_fields(payload, "factsheet")
    read_header(fields, name)
    kind, body = fields.inner("typeSpecification"), fields.inner("physicalParameters")
    if kind is None or body is None:
        raise BadMessage("factsheet must have typeSpecification and physicalParameters: its class, size and speed.")
    loads, features = fields.inner("loadSpecification"), fields.inner("protocolFeatures")
    sets = loads.each("loadSets") if loads else []
    return Factsheet(
        series=kind.text("seriesName"),
        vehicle_class=kind.text("agvClass", needed=True),
        length_m=_length(body, "length"),
        width_m=_length(body, "width"),
        height_m=_length(body, "heightMax"),
        speed_m_s=_length(body, "speedMax"),
        load_types=tuple(dict.fromkeys(t for s in sets if (t := s.text("loadType")))),
        load_positions=len(loads.words("loadPositions")) if loads else 0,
        actions=tuple(_action(a) for a in features.each("agvActions")) if features else (),
    )


def _length(fields: Fields, name: str) -> float:
    value = fields.need_number(name)
    if value <= 0:
        fields.refuse(name, "above 0")
    return value


def _action(fields: Fields) -> Action:
    parameters = [
        Parameter(p.text("key", needed=True), p.text("valueDataType"), p.truth("isOptional") is True)
        for p in fields.each("actionParameters")
    ]
    return Action(
        fields.text("actionType", needed=True),
        frozenset(fields.words("actionScopes")),
        tuple(parameters),
        fields.lenient_text("actionDescription"),
    )


def device_id(name: VehicleName) -> str:
    """Return the id of a vehicle's device, before a site puts its own name before it.

    A hash keeps those apart that would look the same without it.
    """
    plain = f"{name.manufacturer}-{name.serial_number}"
    return fit_device_id(plain, "/".join(name), is_unambiguous="-" not in name.manufacturer)


def describe(name: VehicleName, sheet: Factsheet, home: Pose, site: str, device: str) -> Description:
    """Return the description of a vehicle, as this device, that was first seen at `home` (site frame).

    Raises BadMessage.
    """
    description = Description(
        id=device,
        name=f"{name.manufacturer} {name.serial_number}"[:100],
        kind="robot",
        device_class=_UNFIT.sub("-", sheet.vehicle_class.lower())[:64],
        pose=home,
        size=Size(sheet.length_m, sheet.width_m, sheet.height_m),
        description=f"{sheet.series} over VDA 5050"[:1000] if sheet.series else "Over VDA 5050",
        site=site,
        capacity=capacity(sheet),
        radius_m=round(hypot(sheet.length_m, sheet.width_m) / 2, 3),
        speed_m_s=sheet.speed_m_s,
        properties=PROPERTIES,
        methods=tuple(_methods(device, sheet)),
    )
    if faults := find_faults(description):
        raise BadMessage(f"factsheet: {faults[0].text}"[:300])
    return description


def capacity(sheet: Factsheet) -> int:
    """Return how many loads the vehicle carries at once: one for each place, one where it names none."""
    return max(1, sheet.load_positions) if sheet.can("pick", "NODE") else 0


def _methods(device: str, sheet: Factsheet) -> list[MethodSpec]:
    move = MethodSpec("move", down_topic(device, "move"), "location", "Move", (ParameterSpec("path", "location"),))
    hand = (
        ParameterSpec("device", "device", required=False),
        ParameterSpec("object", "object", options=sheet.load_types[:64]),
        ParameterSpec("value", "number", "", 1.0, float(max(1, capacity(sheet))), required=False),
    )
    handling = [name for name in HANDLING if sheet.can(name, "NODE")]
    hands = [MethodSpec(name, down_topic(device, name), "object", name.capitalize(), hand) for name in handling]
    return [move, *hands, *(_method(device, action) for action in offered_actions(sheet))]


def offered_actions(sheet: Factsheet) -> tuple[Action, ...]:
    """Return the vehicle's further node actions that can be told in VIPO's values."""
    return tuple(
        action
        for action in sheet.actions
        if "NODE" in action.scopes
        and action.type not in KEPT_FROM_PEOPLE
        and _NAME.fullmatch(action.type)
        and all(p.optional or (p.type in VALUE_TYPES and _NAME.fullmatch(p.key)) for p in action.parameters)
    )


def _method(device: str, action: Action) -> MethodSpec:
    parameters = tuple(
        ParameterSpec(p.key, VALUE_TYPES[p.type], required=not p.optional)
        for p in action.parameters
        if p.type in VALUE_TYPES and _NAME.fullmatch(p.key)
    )
    return MethodSpec(action.type, down_topic(device, action.type), "", action.text[:100] or action.type, parameters)


def read_properties(state: VehicleState | None, sheet: Factsheet) -> dict[str, Scalar]:
    """Return the values of the properties that the description names; what the vehicle does not tell is left out."""
    if state is None:
        return {}
    found: dict[str, Scalar] = {
        "driving": state.driving,
        "charging": state.charging,
        "mode": state.mode[:MAX_TEXT],
        "error": _error_text(state),
        "warning": _warning_text(state),
    }
    if state.battery_percent is not None:
        found["battery"] = round(state.battery_percent)
    if state.loads is not None and capacity(sheet):
        found["load"] = _counted(state.loads)
    return found


def _error_text(state: VehicleState) -> str:
    stop = [] if state.e_stop == "NONE" else [f"Emergency stop ({state.e_stop})"]
    return "; ".join([*stop, *(e.sentence for e in state.errors if e.level == "FATAL")])[:MAX_TEXT]


def _warning_text(state: VehicleState) -> str:
    field = ["Something is in its protective field"] if state.field_violated else []
    return "; ".join([*field, *(e.sentence for e in state.errors if e.level == "WARNING")])[:MAX_TEXT]


def _counted(loads: tuple[str, ...]) -> str:
    """Return loads as VIPO writes them: EPAL:2,box:1."""
    named = [load.translate(_NO_PARTING) for load in loads]
    return ",".join(f"{name}:{named.count(name)}" for name in sorted(set(named)))[:MAX_TEXT]
