"""What vehicles say, as VIPO reads it: connection, state and visualization. Lengths in metres, angles in radians."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Literal, NamedTuple, cast

from connectors.vda5050.fields import Fields, read_fields
from vipo_device.protocol.description import Pose
from vipo_device.protocol.messages import BadMessage

Level = Literal["WARNING", "FATAL"]
DRIVING_MODES = frozenset({"AUTOMATIC", "SEMIAUTOMATIC"})
ORDER_ERRORS = frozenset({"orderError", "orderUpdateError", "validationError", "noRouteError"})
ENDED = frozenset({"FINISHED", "FAILED"})


class VehicleName(NamedTuple):
    """Who a vehicle is: the two levels of its topics."""

    manufacturer: str
    serial_number: str


@dataclass(frozen=True, slots=True)
class Header:
    """What every message begins with."""

    number: int
    at: datetime | None
    version: str

    def is_stale(self, newest: Header | None) -> bool:
        """Tell whether the message was overtaken; a vehicle that starts anew counts from 0 at a later time."""
        if newest is None or self.number > newest.number:
            return False
        return self.at is None or newest.at is None or self.at <= newest.at


@dataclass(frozen=True, slots=True)
class Located:
    """Where a vehicle is, on the map that it names, in the vehicle's own frame."""

    pose: Pose
    map_id: str


@dataclass(frozen=True, slots=True)
class Stretch:
    """A node or an edge that is still before the vehicle; only what is released will be driven."""

    sequence: int
    released: bool


@dataclass(frozen=True, slots=True)
class ActionState:
    """How far an action is: WAITING, INITIALIZING, RUNNING, PAUSED, FINISHED or FAILED."""

    id: str
    status: str
    result: str


@dataclass(frozen=True, slots=True)
class VehicleError:
    """Something that a vehicle complains of; FATAL means that it needs a person. `hint` came with 2.1."""

    type: str
    level: Level
    text: str
    references: tuple[tuple[str, str], ...]
    hint: str = ""

    def names(self, key: str) -> str | None:
        """Return what it refers to under a key, None when it does not."""
        return next((value for name, value in self.references if name == key), None)

    @property
    def sentence(self) -> str:
        """What it says, for people."""
        said = f"{self.type}: {self.text}" if self.text else self.type
        return f"{said} ({self.hint})" if self.hint else said


@dataclass(frozen=True, slots=True)
class VehicleState:
    """A vehicle's state; None stands for what it does not tell. `is_lost`: it says that it does not know its place."""

    header: Header
    order: str
    update: int
    last_sequence: int
    ahead: tuple[Stretch, ...]
    actions: tuple[ActionState, ...]
    driving: bool
    paused: bool | None
    located: Located | None
    is_lost: bool
    battery_percent: float | None
    charging: bool
    mode: str
    e_stop: str
    field_violated: bool
    loads: tuple[str, ...] | None
    errors: tuple[VehicleError, ...]

    def action(self, action_id: str) -> ActionState | None:
        """Return the state of an action, if the vehicle tells of it."""
        return next((a for a in self.actions if a.id == action_id), None)

    def refusal(self, order: str, update: int, before: frozenset[VehicleError]) -> VehicleError | None:
        """Return the error with which the vehicle refuses an update of an order; `before` are older errors."""
        for error in self.errors:
            named, number = error.names("orderId"), error.names("orderUpdateId")
            if named == order and (number == str(update) or (number is None and update == 0)):
                return error
            about_order = error.type in ORDER_ERRORS and error.names("topic") != "instantActions"
            if named in {None, order} and number is None and about_order and error not in before:
                return error
        return None

    def works_on(self, order: str) -> bool:
        """Tell whether something of an order of ours is still to be driven, or one of its actions to be ended."""
        acting = any(a.id.startswith(f"{order}-") and a.status not in ENDED for a in self.actions)
        return self.order == order and (bool(self.ahead) or acting)

    def reason(self, action_id: str) -> str:
        """Return what the vehicle says about an action that failed, empty when it says nothing."""
        return next((e.sentence for e in self.errors if e.names("actionId") == action_id), "")

    @property
    def has_way_left(self) -> bool:
        """True while nodes or edges that are released lie before the vehicle."""
        return any(s.released for s in self.ahead)

    @property
    def has_horizon(self) -> bool:
        """True while the vehicle waits for more of its way to be released."""
        return any(not s.released for s in self.ahead)

    @property
    def fatal(self) -> VehicleError | None:
        """The first error that needs a person."""
        return next((e for e in self.errors if e.level == "FATAL"), None)


def read_connection(payload: bytes, name: VehicleName) -> tuple[Header, str]:
    """Return the header, and ONLINE, OFFLINE or CONNECTIONBROKEN. Raises BadMessage."""
    fields = read_fields(payload, "connection")
    said = fields.text("connectionState", needed=True)
    if said not in {"ONLINE", "OFFLINE", "CONNECTIONBROKEN"}:
        fields.refuse("connectionState", "ONLINE, OFFLINE or CONNECTIONBROKEN")
    return read_header(fields, name), said


def read_visualization(payload: bytes, name: VehicleName) -> tuple[Header, Located | None]:
    """Return where the vehicle is, between its states. Raises BadMessage."""
    fields = read_fields(payload, "visualization")
    return read_header(fields, name), _located(fields.inner("agvPosition"))


def read_state(payload: bytes, name: VehicleName) -> VehicleState:
    """Read a vehicle's state. Raises BadMessage."""
    fields = read_fields(payload, "state")
    battery, safety, position = (fields.inner(name) for name in ("batteryState", "safetyState", "agvPosition"))
    charge = battery.number("batteryCharge") if battery else None
    stretches = (*fields.each("nodeStates", needed=True), *fields.each("edgeStates", needed=True))
    return VehicleState(
        header=read_header(fields, name),
        order=fields.text("orderId"),
        update=fields.whole("orderUpdateId", default=0),
        last_sequence=fields.whole("lastNodeSequenceId", default=0),
        ahead=tuple(Stretch(s.whole("sequenceId"), s.truth("released") is True) for s in stretches),
        actions=tuple(_action(a) for a in fields.each("actionStates", needed=True)),
        driving=fields.truth("driving") is True,
        paused=fields.truth("paused"),
        located=_located(position),
        is_lost=position is not None and position.truth("positionInitialized") is False,
        battery_percent=None if charge is None else min(100.0, max(0.0, charge)),
        charging=battery is not None and battery.truth("charging") is True,
        mode=fields.text("operatingMode", needed=True),
        e_stop=(safety.text("eStop") if safety else "") or "NONE",
        field_violated=safety is not None and safety.truth("fieldViolation") is True,
        loads=tuple(load.lenient_text("loadType") or "load" for load in fields.each("loads"))
        if "loads" in fields.body
        else None,
        errors=tuple(_error(e) for e in fields.each("errors", needed=True)),
    )


def read_header(fields: Fields, name: VehicleName) -> Header:
    """Return the header of a message; what it says of itself must be what its topic says."""
    if (fields.text("manufacturer"), fields.text("serialNumber")) != name:
        raise BadMessage(f"{fields.path} names another vehicle than its topic, which is {'/'.join(name)[:100]}.")
    version = fields.text("version", needed=True)
    if not version.startswith("2."):
        fields.refuse("version", "2.0 or 2.1")
    return Header(fields.whole("headerId"), _time(fields.text("timestamp")), version)


def _time(text: str) -> datetime | None:
    try:
        at = datetime.fromisoformat(text)
    except ValueError:
        return None
    return at if at.tzinfo else at.replace(tzinfo=UTC)


def _located(fields: Fields | None) -> Located | None:
    if fields is None or fields.truth("positionInitialized") is False:
        return None
    pose = Pose(fields.need_number("x"), fields.need_number("y"), 0.0, fields.need_number("theta"))
    if max(abs(pose.x), abs(pose.y)) > 1e6 or abs(pose.theta) > 100:
        fields.refuse("x", "within a million metres, and theta an angle in radians")
    return Located(pose, fields.text("mapId"))


def _action(fields: Fields) -> ActionState:
    return ActionState(
        fields.text("actionId", needed=True),
        fields.text("actionStatus", needed=True),
        fields.lenient_text("resultDescription"),
    )


def _error(fields: Fields) -> VehicleError:
    level = fields.text("errorLevel", needed=True)
    if level not in {"WARNING", "FATAL"}:
        fields.refuse("errorLevel", "WARNING or FATAL")
    references = tuple((r.lenient_text("referenceKey"), _reference(r)) for r in fields.each("errorReferences"))
    return VehicleError(
        fields.text("errorType", needed=True),
        cast("Level", level),
        fields.lenient_text("errorDescription"),
        references,
        fields.lenient_text("errorHint"),
    )


def _reference(fields: Fields) -> str:
    """Return what an error refers to; the standard wants texts, and some vehicles write an update's number as such."""
    value = fields.body.get("referenceValue")
    return str(value) if isinstance(value, int) else fields.lenient_text("referenceValue")
