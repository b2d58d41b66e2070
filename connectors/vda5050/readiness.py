"""Whether a vehicle can be told to do something now, and why not."""

from __future__ import annotations

from connectors.vda5050.messages import DRIVING_MODES, VehicleState
from connectors.vda5050.orders import OURS


def why_not(name: str, state: VehicleState, *, is_located: bool) -> str:
    """Return why a vehicle takes no command now, for people; empty when it does."""
    if state.fatal is not None:
        return f"{name} needs a person: {state.fatal.sentence}"
    if state.mode not in DRIVING_MODES:
        return f"{name} is in the mode {state.mode[:40]}; switch it to AUTOMATIC."
    if works_for_others(state):
        return f"{name} carries out an order of somebody else ({state.order[:60]})."
    return "" if is_located and not state.is_lost else f"{name} does not know where it is; set its position."


def works_for_others(state: VehicleState) -> bool:
    """Tell whether the vehicle drives by an order that is not VIPO's."""
    return state.has_way_left and not state.order.startswith(OURS)
