"""A vehicle's state as the properties that VIPO shows."""

from __future__ import annotations

from connectors.vda5050.factsheet import Factsheet, capacity
from connectors.vda5050.messages import VehicleState
from vipo_device.protocol.description import Scalar
from vipo_device.protocol.messages import MAX_TEXT


def shown(state: VehicleState | None, sheet: Factsheet) -> dict[str, Scalar]:
    """Return the values of the properties that the description names; what the vehicle does not tell is left out."""
    if state is None:
        return {}
    found: dict[str, Scalar] = {
        "driving": state.driving,
        "charging": state.charging,
        "mode": state.mode[:MAX_TEXT],
        "error": _error(state),
        "warning": _warning(state),
    }
    if state.battery_percent is not None:
        found["battery"] = round(state.battery_percent)
    if state.loads is not None and capacity(sheet):
        found["load"] = _counted(state.loads)
    return found


def _error(state: VehicleState) -> str:
    stop = [] if state.e_stop == "NONE" else [f"Emergency stop ({state.e_stop})"]
    return "; ".join([*stop, *(e.sentence for e in state.errors if e.level == "FATAL")])[:MAX_TEXT]


def _warning(state: VehicleState) -> str:
    field = ["Something is in its protective field"] if state.field_violated else []
    return "; ".join([*field, *(e.sentence for e in state.errors if e.level == "WARNING")])[:MAX_TEXT]


def _counted(loads: tuple[str, ...]) -> str:
    """Return loads as VIPO writes them: EPAL:2,box:1."""
    return ",".join(f"{name}:{loads.count(name)}" for name in sorted(set(loads)))[:MAX_TEXT]
