"""A device as the rest of VIPO sees it: the frozen view of its row, and the JSON that browsers get of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from datetime import datetime
from typing import Any, Final, Literal

from registry.alerts.causes import is_battery_low
from registry.devices.activity import NOT_TRUSTED, NOTHING, Activity, Seen, activity_of
from registry.models import Device
from vipo_device.descriptions.forms import CONTENT_TYPES
from vipo_device.protocol.description import Description, MethodSpec, Pose, PropertySpec, Scalar, description_from_json
from vipo_device.protocol.loads import read_load
from vipo_device.protocol.topics import split_methods

Status = Literal["idle", "busy", "done", "waiting", "warning", "error", "offline", "pending"]
_ICONS = {"turtlebot": "turtle"}
"""What the API calls a class's icon where that is no name of the class; no screen reads it, and no class is added."""
_MOST_KNOWN = 5000
_known: dict[str, Description] = {}

OWN_PLACE: Final = "own"
NewPlace = Pose | Literal["own"]
"""Where people put a device; `OWN_PLACE`: where it says itself again."""


@dataclass(frozen=True, slots=True)
class DeviceView:
    """A device as it is now: `canonical` has the name and place that hold, `readings` its properties' values.

    `has_key` tells whether it can come in with a key of its own, `dropped` how many of its messages were not taken,
    `is_of_paper` that it describes itself by the paper's message and so knows no command by its id, `only_done_flag`
    that whoever plays it now may therefore answer no command but by `done`;
    `stand_in` tells that it is simulated in place of the real one, and `stands_at` where a real robot is meanwhile;
    `asks` are the methods that nobody may call before an admin has confirmed their topics. `home` is where a robot
    belongs, by its description or where people put it; `is_placed` tells that people put it somewhere.
    """

    id: str
    site: str
    canonical: Description
    lifecycle: str
    online: bool
    done: bool
    command: str
    boot: int
    readings: Mapping[str, Scalar] = field(default_factory=dict)
    carrying: Mapping[str, int] = field(default_factory=dict)
    status: Status = "idle"
    activity: Activity = NOTHING
    last_seen_at: datetime | None = None
    has_key: bool = False
    dropped: int = 0
    is_of_paper: bool = False
    stand_in: bool = False
    stands_at: Pose | None = None
    asks: tuple[MethodSpec, ...] = ()
    home: Pose | None = None
    is_placed: bool = False

    @property
    def only_done_flag(self) -> bool:
        """Whether it answers by `done` alone: a stand-in answers each command."""
        return self.is_of_paper and not self.stand_in

    @property
    def whole(self) -> Description:
        """What the device says of itself, with the methods that may not be called yet."""
        return replace(self.canonical, methods=(*self.canonical.methods, *self.asks)) if self.asks else self.canonical

    @property
    def played(self) -> Description:
        """What the device says of itself, told as simulated while a stand-in speaks for it."""
        return replace(self.canonical, simulated=True) if self.stand_in else self.canonical

    @property
    def at_home(self) -> Description:
        """What the device says of itself, a robot where it belongs, wherever it stands at the moment."""
        return self.canonical if self.home is None else replace(self.canonical, pose=self.home)

    @property
    def name(self) -> str:
        """The name people gave it, or the one it gave itself."""
        return self.canonical.name

    @property
    def kind(self) -> str:
        """`machine` or `robot`."""
        return self.canonical.kind

    @property
    def pose(self) -> Pose:
        """Where it is now."""
        return self.canonical.pose


def view_of(device: Device, site: str) -> DeviceView:
    """Return the view of a device's row, which has been described."""
    said = effective_description(device)
    callable_methods, asks = split_methods(said, device.granted)
    canonical = replace(said, methods=callable_methods) if asks else said
    readings: dict[str, Scalar] = dict(device.properties)
    view = DeviceView(
        id=device.id,
        site=site,
        canonical=canonical,
        lifecycle=device.lifecycle,
        online=device.online,
        done=device.done,
        command=device.command,
        boot=device.boot,
        readings=readings,
        carrying=read_load(readings.get("load")),
        last_seen_at=device.last_seen_at,
        has_key=bool(device.credential_hash),
        dropped=device.dropped,
        is_of_paper=device.source_type == CONTENT_TYPES["paper"],
        stand_in=device.stand_in,
        stands_at=place_of_real(canonical.kind, device.aside),
        asks=asks,
        home=_home_of(device) if canonical.kind == "robot" else None,
        is_placed=bool(device.pose_override),
    )
    return replace(view, status=status_of(view), activity=_activity(view))


def effective_description(device: Device) -> Description:
    """Return what the device says of itself, with the name and place that hold."""
    said = _read_description(device)
    pose = pose_that_holds(said.kind, device.pose, device.pose_override)
    return replace(said, name=device.name_override or said.name, pose=Pose(**pose) if pose else said.pose)


def _home_of(device: Device) -> Pose:
    """Return where a robot belongs."""
    return Pose(**device.pose_override) if device.pose_override else _read_description(device).pose


def place_of_real(kind: str, aside: Mapping[str, Any] | None) -> Pose | None:
    """Return where a real robot is whose stand-in speaks, as far as anybody knows."""
    pose = aside.get("pose") if aside and kind == "robot" else None
    return Pose(**pose) if pose else None


def pose_that_holds(
    kind: str, measured: Mapping[str, float] | None, placed: Mapping[str, float] | None
) -> Mapping[str, float] | None:
    """Return where a device is, of where it says it is now and where people put it; None where it was described.

    A robot knows best where it is; a machine is where people put it, else where it says.
    """
    return (measured or placed) if kind == "robot" else (placed or measured)


def _read_description(device: Device) -> Description:
    """Return what a row says of its device; read once for each different description, since states come often."""
    said = _known.get(device.description_hash)
    if said is None:
        said = description_from_json(device.description or {})
        if len(_known) >= _MOST_KNOWN:
            _known.clear()
        if device.description_hash:
            _known[device.description_hash] = said
    return said


def status_of(view: DeviceView) -> Status:
    """Return the one word for how a device is."""
    if view.lifecycle == "pending":
        return "pending"
    if not view.online:
        return "offline"
    if view.readings.get("error"):
        return "error"
    if not view.done:
        return "busy"
    spec = view.canonical.property("battery")
    low = is_battery_low(view.readings.get("battery"), spec.unit if spec else "")
    return "warning" if low or view.readings.get("warning") else "idle"


def _activity(view: DeviceView) -> Activity:
    if view.lifecycle == "pending":
        return NOT_TRUSTED
    if not view.online:
        return NOTHING
    return activity_of(Seen(view.canonical, view.readings, view.carrying, view.done))


def device_to_json(view: DeviceView) -> dict[str, Any]:
    """Return the device as the API and the sockets say it."""
    said = view.canonical
    return {
        "id": view.id,
        "name": said.name,
        "kind": said.kind,
        "device_class": said.device_class,
        "icon": _ICONS.get(said.device_class, said.device_class),
        "lifecycle": view.lifecycle,
        "status": view.status,
        **_activity_to_json(view.activity),
        "location": asdict(said.pose),
        "is_placed": view.is_placed,
        "size": asdict(said.size),
        "radius_m": said.radius_m,
        "properties": [_property_to_json(p, view.readings.get(p.name)) for p in said.properties],
        "methods": [_method_to_json(m) for m in said.methods],
        "asks": [_method_to_json(m) for m in view.asks],
        "gives": list(said.gives),
        "takes": list(said.takes),
        "capacity": said.capacity,
        "carrying": dict(view.carrying),
        "last_seen_at": view.last_seen_at.isoformat() if view.last_seen_at else None,
        "done": view.done,
        "simulated": said.simulated,
        "image": said.image if said.image.startswith(("https://", "http://")) else "",
        "description": said.description,
        "stand_in": view.stand_in,
        "stands_at": asdict(view.stands_at) if view.stands_at else None,
        "has_key": view.has_key,
        "dropped": view.dropped,
    }


def _activity_to_json(activity: Activity) -> dict[str, Any]:
    said = {"code": activity.code, "args": dict(activity.args)} if activity.code else None
    return {"doing": activity.text, "activity": said}


def _property_to_json(spec: PropertySpec, value: Scalar) -> dict[str, Any]:
    return {
        "name": spec.name,
        "title": spec.title,
        "type": spec.type,
        "unit": spec.unit,
        "minimum": spec.minimum,
        "maximum": spec.maximum,
        "options": list(spec.options),
        "value": value,
    }


def _method_to_json(method: MethodSpec) -> dict[str, Any]:
    return {
        "name": method.name,
        "title": method.title,
        "topic": method.topic,
        "message_type": method.message_type,
        "parameters": [{**asdict(p), "options": list(p.options)} for p in method.parameters],
    }


def changed_fields(before: DeviceView | None, after: DeviceView) -> dict[str, Any]:
    """Return the id and what a browser does not know yet."""
    new = device_to_json(after)
    old = device_to_json(before) if before else {}
    return {"id": after.id, **{k: v for k, v in new.items() if k not in old or old[k] != v}}


def changed_state(before: DeviceView, after: DeviceView) -> dict[str, Any]:
    """Return the id and what a browser does not know yet, where only the device's state can have changed."""
    new, old = _state_to_json(after), _state_to_json(before)
    told = {"id": after.id, **{k: v for k, v in new.items() if old[k] != v}}
    if any(before.readings.get(p.name) != after.readings.get(p.name) for p in after.canonical.properties):
        told["properties"] = [_property_to_json(p, after.readings.get(p.name)) for p in after.canonical.properties]
    return told


def device_news(before: DeviceView | None, after: DeviceView, fields: Mapping[str, Any]) -> dict[str, Any]:
    """Return the live message with these new fields of a device.

    `redescribed` stands in it where something other than readings, and where a robot is, has changed: what the device
    is by its description and by what people decided, a machine's place, whether it is there. Programs are checked
    against that; browsers are not told it.
    """
    message = {"type": "device", "device": fields}
    return {**message, "redescribed": True} if before is None or _is_redescribed(before, after) else message


def _is_redescribed(before: DeviceView, after: DeviceView) -> bool:
    if (before.lifecycle, before.online) != (after.lifecycle, after.online):
        return True
    old = replace(before.canonical, pose=after.pose) if before.kind == after.kind == "robot" else before.canonical
    return old != after.canonical


def _state_to_json(view: DeviceView) -> dict[str, Any]:
    pose = view.canonical.pose
    return {
        "status": view.status,
        **_activity_to_json(view.activity),
        "location": {"x": pose.x, "y": pose.y, "z": pose.z, "theta": pose.theta},
        "carrying": dict(view.carrying),
        "last_seen_at": view.last_seen_at.isoformat() if view.last_seen_at else None,
        "done": view.done,
    }
