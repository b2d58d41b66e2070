"""How a vehicle's order is interrupted: paused and resumed, or cancelled, by instant actions; when each holds."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from connectors.vda5050.messages import VehicleState
from connectors.vda5050.orders import OURS, Body, action

PAUSE_AGAIN_S = 2.0
PAUSE_LIMIT_S = 20.0
CANCEL_AGAIN_S = 5.0
REMEMBERED = 16


@dataclass(slots=True)
class PauseRequest:
    """A pause or resume that is still to be answered."""

    command: str
    wants_pause: bool
    since_s: float


@dataclass(slots=True)
class Pausing:
    """The pauses that were asked for. A vehicle that somebody else paused is not set going."""

    pauses: list[str] = field(default_factory=list)
    ours: bool = False
    action_id: str = ""
    action_pauses: bool = False
    said_paused: bool = False
    asked: list[PauseRequest] = field(default_factory=list)
    sent_s: float | None = None

    def ask(self, command: str, target: str, now_s: float, *, pause: bool) -> None:
        """Note that a command shall be held, or go on; an empty target means all."""
        if pause:
            self.pauses = [*self.pauses, target][-REMEMBERED:]
        else:
            self.pauses = [kept for kept in self.pauses if target not in {"", kept}]
        self.asked.append(PauseRequest(command, pause, now_s))

    def wants(self, open_commands: list[str], *, held: bool) -> bool:
        """Tell whether the vehicle shall stand; a pause ends with its command."""
        return held or any(not kept or kept in open_commands for kept in self.pauses)

    def is_paused(self, state: VehicleState) -> bool:
        """Tell whether the vehicle stands paused: by its state, or where that does not tell by its last answer."""
        said = state.action(self.action_id)
        if said is not None and said.status == "FINISHED":
            self.said_paused = self.action_pauses
        return state.paused if state.paused is not None else self.said_paused

    def steer(self, state: VehicleState, now_s: float, new_id: Callable[[], str], *, wanted: bool) -> Body | None:
        """Return the instant action that is due, if one is."""
        paused = self.is_paused(state)
        if not paused and not wanted:
            self.ours = False
        if wanted == paused or (paused and not self.ours):
            return None
        if self.sent_s is not None and now_s - self.sent_s < PAUSE_AGAIN_S and self.action_pauses == wanted:
            return None
        self.ours, self.action_pauses, self.action_id, self.sent_s = True, wanted, new_id(), now_s
        return action(self.action_id, "startPause" if wanted else "stopPause", {})

    def answered(self, state: VehicleState, now_s: float, *, wanted: bool) -> list[tuple[str, str]]:
        """Return the commands that can be answered now, each with why not or an empty text, and forget them."""
        paused = self.is_paused(state)
        found = []
        for asked in list(self.asked):
            if paused == asked.wants_pause or (wanted and not asked.wants_pause):
                found.append((asked.command, ""))
            elif now_s - asked.since_s > PAUSE_LIMIT_S:
                verb = "pause" if asked.wants_pause else "go on"
                found.append((asked.command, f"The vehicle did not {verb} within {PAUSE_LIMIT_S:.0f} s."))
            else:
                continue
            self.asked.remove(asked)
        return found

    def to_json(self) -> dict[str, Any]:
        """Return what pausing_from_json reads."""
        return {"pauses": self.pauses, "ours": self.ours, "told": self.said_paused}


def pausing_from_json(body: Mapping[str, Any]) -> Pausing:
    """Return what was kept; pauses that were not answered are asked again by the server."""
    return Pausing(list(body["pauses"]), bool(body["ours"]), said_paused=bool(body["told"]))


@dataclass(slots=True)
class Cancellation:
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
        if self.sent_s is not None and now_s - self.sent_s <= CANCEL_AGAIN_S:
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
