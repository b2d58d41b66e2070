"""An order that is being cancelled, and when it counts as cancelled."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass, field
from typing import Any

from connectors.vda5050.messages import VehicleState
from connectors.vda5050.orders import OURS, Body, action

AGAIN_S = 5.0


@dataclass(slots=True)
class Cancel:
    """The commands that end with an order, and the cancel commands to be answered."""

    action_id: str
    targets: list[str] = field(default_factory=list)
    controls: list[str] = field(default_factory=list)
    sent_s: float | None = None

    def include(self, commands: Iterable[str], control: str) -> None:
        """Let these commands end, too, and answer one more cancel command, if it is named."""
        self.targets += [command for command in commands if command not in self.targets]
        self.controls += [control] if control else []

    def is_over(self, state: VehicleState) -> bool:
        """Tell whether the vehicle has cancelled, or does nothing of ours any more; one that refuses drives on."""
        said = state.action(self.action_id)
        has_ours = state.order.startswith(OURS) and state.works_on(state.order)
        return not has_ours or (said is not None and said.status == "FINISHED")

    def due(self, state: VehicleState, now_s: float, new_id: Callable[[], str]) -> Body | None:
        """Return the instant action when it is time to send it, or to send it again; anew where it was refused."""
        if self.sent_s is not None and now_s - self.sent_s <= AGAIN_S:
            return None
        said = state.action(self.action_id)
        if said is not None and said.status == "FAILED":
            self.action_id = new_id()
        self.sent_s = now_s
        return action(self.action_id, "cancelOrder", {})

    def to_json(self) -> dict[str, Any]:
        """Return what outlives a restart: it is sent again after it."""
        return {**asdict(self), "sent_s": None}


def is_orphan(state: VehicleState, known_order: str) -> bool:
    """Tell whether the vehicle carries out an order of ours that is not the one that is known."""
    return state.order.startswith(OURS) and state.order != known_order and state.works_on(state.order)
