"""A vehicle's state as the properties that VIPO shows."""

from __future__ import annotations

from connectors.vda5050.factsheet import Factsheet, capacity
from connectors.vda5050.messages import VehicleState
from registry.capability import Scalar
from registry.wire import MAX_TEXT


def shown(state: VehicleState | None, sheet: Factsheet) -> dict[str, Scalar]:
    """Return the values of the properties that the description names; what the vehicle does not tell is left out."""
    if state is None:
        return {}
    found: dict[str, Scalar] = {
        "battery": round(state.battery_percent),
        "driving": state.driving,
        "charging": state.charging,
        "mode": state.mode[:MAX_TEXT],
        "problem": _problem(state),
    }
    if state.loads is not None and capacity(sheet):
        found["load"] = _counted(state.loads)
    return found


def _problem(state: VehicleState) -> str:
    told = [error.sentence for error in state.errors]
    if state.e_stop != "NONE":
        told.insert(0, f"Emergency stop ({state.e_stop})")
    return "; ".join(told)[:MAX_TEXT]


def _counted(loads: tuple[str, ...]) -> str:
    """Return loads as VIPO writes them: EPAL:2,box:1."""
    return ",".join(f"{name}:{loads.count(name)}" for name in sorted(set(loads)))[:MAX_TEXT]
