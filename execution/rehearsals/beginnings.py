"""What a rehearsal begins with: what the site's devices show at the moment, as far as that can be gone on from."""

from __future__ import annotations

from registry.services import DeviceView
from simulation.actors.readings import KEPT
from vipo_device.protocol.arguments import is_number
from vipo_device.protocol.description import PropertySpec, Scalar
from vipo_device.protocol.units import same_dimension

_KEPT_BY_ROBOTS = frozenset({"battery", "load"})


def beginning_readings(device: DeviceView) -> dict[str, Scalar]:
    """Return the readings with which a device begins: all that it described and said, in the type that it described.

    A device at work keeps what stays when the work is over, what it holds and how warm it is, of a robot also how full
    its battery is: the rehearsal knows nothing of what others let it do, so the rest would never go on.
    """
    is_at_work = not device.done
    return {
        spec.name: value
        for spec in device.canonical.properties
        if _is_of(spec, value := device.readings.get(spec.name)) and not (is_at_work and not _stays(device.kind, spec))
    }


def _stays(kind: str, spec: PropertySpec) -> bool:
    names = _KEPT_BY_ROBOTS if kind == "robot" else KEPT
    return spec.name in names or same_dimension(spec.unit, "DEG_C")


def _is_of(spec: PropertySpec, value: object) -> bool:
    if spec.type == "number":
        return is_number(value)
    return isinstance(value, bool if spec.type == "boolean" else str)
