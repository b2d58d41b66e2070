"""Master control of one vehicle: the server's commands and the vehicle's states in, orders and answers out.

Nothing here waits for an event: what is open is judged anew by each state, so that a message that got lost, a
connector that was killed, and a vehicle that started anew come to the same end.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Literal

from connectors.vda5050.coordinates import Point
from connectors.vda5050.factsheet import read_properties
from connectors.vda5050.interruptions import Cancellation, Pausing, is_orphan, pausing_from_json
from connectors.vda5050.messages import ENDED, Located, VehicleError, VehicleState
from connectors.vda5050.open_commands import OpenTasks
from connectors.vda5050.orders import Body, Order, order_from_json, order_to_json
from connectors.vda5050.tasks import (
    Task,
    Vehicle,
    drives_in_front,
    growing,
    next_order,
    read_task,
    why_not,
    works_for_others,
)
from vipo_device.kit.arguments import why_astray
from vipo_device.protocol.description import DeviceState, Pose
from vipo_device.protocol.messages import CONTROLS, AckMessage, DeviceCommand

PATIENCE_S = 3.0
TRIES = 4
NOT_TAKEN = "The vehicle did not take the order."
NOT_THERE = "The vehicle no longer has the action; it was started anew, or its order was ended."


@dataclass(frozen=True, slots=True)
class Send:
    """A message for the vehicle, without its header: an order, or one instant action."""

    topic: Literal["order", "instantActions"]
    body: Body


class VehicleControl:
    """`out` fills with answers and messages; whoever sends them empties it. Times are seconds of one clock."""

    def __init__(self, vehicle: Vehicle, new_id: Callable[[], str]) -> None:
        self.vehicle = vehicle
        self.out: list[AckMessage | Send] = []
        self.state: VehicleState | None = None
        self.located: Located | None = None
        self.online = False
        self._new_id = new_id
        self.held = False
        self._tasks = OpenTasks(lambda ack: self.out.append(ack))
        self._order: Order | None = None
        self._cancel: Cancellation | None = None
        self._pausing = Pausing()
        self._sent_s: float | None = None
        self._tries = 0
        self._errors_before: frozenset[VehicleError] = frozenset()
        self._cancelled_s: float | None = None
        self._missed: tuple[VehicleState, float] | None = None

    def hear_state(self, state: VehicleState, now_s: float) -> None:
        """Take in a state of the vehicle."""
        self.state, self.located = state, state.located or self.located
        self.settle(now_s)

    def hold(self, now_s: float, *, active: bool) -> None:
        """Take in that the site's stop was pressed or reset."""
        self.held = active
        if active and not self.vehicle.can_pause:
            self._cancel_tasks(self._tasks.commands, "", "The site was stopped; it cannot pause.")
        self.settle(now_s)

    def command(self, command: DeviceCommand, now_s: float) -> None:
        """Take in a command; one that is known is answered again, or will be."""
        known = self._tasks.find(command.id)
        if known is not None:
            self.out.append(known)
            return
        if self._is_open(command.id):
            return
        if command.method in CONTROLS:
            self._control(command, now_s)
        elif why := self._take_on(command):
            self._tasks.say(command.id, "REJECTED", why)
        self.settle(now_s)

    def reject(self, command_id: str, why: str) -> None:
        """Answer a command that is not carried out."""
        self._tasks.say(command_id, "REJECTED", why)

    def look(self, boot: int, seq: int) -> DeviceState:
        """Return the device's state as VIPO hears it."""
        pose = self.vehicle.frame.to_site(self.located.pose) if self.located else None
        head = self._tasks.head
        command = head.command if head else ""
        is_free = head is None and self._cancel is None and not (self.state and works_for_others(self.state))
        return DeviceState(boot, seq, is_free, pose, command, read_properties(self.state, self.vehicle.sheet))

    def settle(self, now_s: float) -> None:
        """Judge everything that is open by the newest state, and do what is due."""
        state = self.state
        if state is None or not self.online:
            return
        self._follow_order(state, now_s)
        self._give_up_on_fatal(state)
        self._finish(state, now_s)
        self._follow_cancel(state, now_s)
        self._steer_pause(state, now_s)
        self._hand_over(state, now_s)
        self._say_running()

    def to_json(self) -> dict[str, Any]:
        """Return what has to outlive a restart of the connector."""
        return {
            **self._tasks.to_json(),
            "order": order_to_json(self._order) if self._order else None,
            "cancel": self._cancel.to_json() if self._cancel else None,
            "pausing": self._pausing.to_json(),
            "held": self.held,
        }

    def recall(self, body: Mapping[str, Any]) -> None:
        """Take up what to_json wrote; an order that was perhaps not sent is sent again, which the vehicle ignores."""
        self._tasks.recall(body)
        self._order = order_from_json(body["order"]) if body["order"] else None
        self._cancel = Cancellation(**body["cancel"]) if body["cancel"] else None
        self._pausing = pausing_from_json(body["pausing"])
        self.held = bool(body.get("held"))

    def _is_open(self, command: str) -> bool:
        controls = [asked.command for asked in self._pausing.asked] + (self._cancel.controls if self._cancel else [])
        return command in controls or command in self._tasks.commands

    def _take_on(self, command: DeviceCommand) -> str:
        """Queue a command; return why not, or an empty text."""
        if why := self._refusal():
            return why
        task = read_task(self.vehicle, command, self._way_begins())
        if isinstance(task, str):
            return task
        tail = self._tasks.tail
        if tail and not (task.way and tail.way):
            # It waits here, unknown to the vehicle, until all before it is done.
            self._tasks.say(task.command, "ACCEPTED")
        self._tasks.add(task)
        return ""

    def _refusal(self) -> str:
        name, state = self.vehicle.description.name, self.state
        if state is None or not self.online:
            return f"{name} is not connected."
        return "The site is stopped." if self.held else why_not(name, state, is_located=self.located is not None)

    def _way_begins(self) -> Point | None:
        """Return where the next piece of way has to begin: at the end of the last one, or where the vehicle is."""
        ends = [task.way[-1].point for task in self._tasks if task.way]
        if not ends and self.located is None:
            return None
        return self._in_site(Pose(*ends[-1]) if ends else (self.located.pose if self.located else Pose(0, 0)))

    def _in_site(self, pose: Pose) -> Point:
        site = self.vehicle.frame.to_site(pose)
        return site.x, site.y

    def _control(self, command: DeviceCommand, now_s: float) -> None:
        named = command.arguments.get("command")
        target = named if isinstance(named, str) else ""
        if command.method == "cancel":
            self._cancel_named(command.id, target)
        elif not self.vehicle.can_pause:
            self._tasks.say(command.id, "REJECTED", f"{self.vehicle.description.name} cannot pause.")
        elif self._tasks.is_over(target):
            self._tasks.say(command.id, "DONE")  # it ended while this was on its way: there is nothing to hold
        else:
            self._pausing.ask(command.id, target, now_s, pause=command.method == "pause")

    def _cancel_named(self, control: str, target: str) -> None:
        tasks = list(self._tasks)
        at = next((at for at, task in enumerate(tasks) if task.command == target), None)
        if not target:
            self._cancel_tasks(self._tasks.commands, control)
        elif at is not None:
            behind = [t.command for t in tasks[at + 1 :] if t.way and tasks[at].way]
            self._cancel_tasks([target, *behind], control)
        else:
            if self._tasks.find(target) is None:
                # It may still be on its way here, and must not be carried out when it comes.
                self._tasks.say(target, "CANCELED", "It was cancelled before it arrived.")
            self._tasks.say(control, "DONE")

    def _cancel_tasks(self, commands: list[str], control: str, why: str = "") -> None:
        """End commands: at once those that the vehicle does not know of, the others when it has stopped."""
        for task in [t for t in self._tasks.waiting if t.command in commands]:
            self._tasks.end(task, "CANCELED", why or f"{task.method} was cancelled.")
        known = [task.command for task in self._tasks.handed_over if task.command in commands]
        if known:
            self._cancel = self._cancel or Cancellation(self._new_id())
            self._cancel.include(known, control)
        elif control:
            self._tasks.say(control, "DONE")

    def _follow_order(self, state: VehicleState, now_s: float) -> None:
        order = self._order
        if order is None:
            return
        if state.order == order.id and order.has_given_up(state.update):
            self._call_back(order)
        elif not order.is_taken and state.order == order.id and state.update >= order.update:
            self._order, self._tries = order.with_taken(), 0
            for task in self._tasks.handed_over:
                if self._tasks.find(task.command) is None:
                    self._tasks.say(task.command, "ACCEPTED")
        elif order.taken >= 0 and state.order != order.id:
            self._end_handed_over("The vehicle no longer has the order; it was started anew, or given another one.")
        elif not order.is_taken:
            self._press_for(order, state, now_s)

    def _press_for(self, order: Order, state: VehicleState, now_s: float) -> None:
        """Look for a refusal of what was sent last, or send it again."""
        if not self._tasks.handed_over and not order.takes_horizon_away:
            self._order_refused(order, "")
        elif error := state.refusal(order.id, order.update, self._errors_before):
            self._order_refused(order, error.sentence)
        elif self._cancel is not None and self._sent_s is None:
            self._sent_s = now_s
        elif self._sent_s is None or now_s - self._sent_s > PATIENCE_S:
            # What is to be cancelled is not sent again; if it comes to be taken all the same, it is nobody's.
            if self._tries >= TRIES or self._cancel is not None:
                self._order_refused(order, NOT_TAKEN)
            else:
                self._send_order(order, now_s)

    def _order_refused(self, order: Order, why: str) -> None:
        kept = int(order.taken_end["sequenceId"]) if order.taken_end else -1
        refused = [t for t in self._tasks.handed_over if t.last > kept or t.actions]
        for task in refused:
            if self._is_cancelled(task):
                self._tasks.end(task, "CANCELED", f"{task.method} was cancelled.")
            else:
                self._tasks.end_refused(task, why)
        if order.takes_horizon_away and self._tasks.head:
            self._tasks.end_refused(self._tasks.head, why)
        if refused:
            self._tasks.drop_drives()
        self._order, self._tries = (order.without_newest() if order.taken_end else None), 0

    def _call_back(self, order: Order) -> None:
        """Have an order cancelled of which the vehicle has taken what was given up; what is wanted is ordered anew.

        A newer update goes on from where the vehicle is not heading, and is taken back.
        """
        self._cancel = self._cancel or Cancellation(self._new_id())
        if order.is_taken:
            return
        self._order, self._tries = order.without_newest(), 0
        for task in [t for t in self._tasks.handed_over if t.last > self._order.end_sequence]:
            if self._is_cancelled(task):
                self._tasks.end(task, "CANCELED", f"{task.method} was cancelled.")
            else:
                task.last = -1

    def _end_handed_over(self, why: str) -> None:
        for task in self._tasks.handed_over:
            self._tasks.end(task, "CANCELED" if self._is_cancelled(task) else "FAILED", why)
        self._tasks.drop_drives()
        self._order = None

    def _give_up_on_fatal(self, state: VehicleState) -> None:
        """End everything when the vehicle needs a person, so that it does not drive on once it was helped."""
        if state.fatal is None or not self._tasks:
            return
        for task in self._tasks:
            self._tasks.end(task, "FAILED", state.fatal.sentence)
        if self._order is not None:
            self._cancel = self._cancel or Cancellation(self._new_id())

    def _finish(self, state: VehicleState, now_s: float) -> None:
        order = self._order
        if order is None or order.taken < 0 or state.order != order.id:
            return
        if order.kind == "act":
            self._finish_actions(state)
            self._give_up_on_missed(state, now_s)
            return
        for task in self._tasks.handed_over:
            if state.last_sequence < task.last or any(s.sequence <= task.last for s in state.ahead):
                break
            self._tasks.end(task, "DONE")
        if order.is_taken and self._cancel is None and self._tasks.handed_over and not state.has_way_left:
            self._end_handed_over("The vehicle ended its order before the end of the way.")

    def _finish_actions(self, state: VehicleState) -> None:
        for task in self._tasks.handed_over:
            states = [state.action(action_id) for action_id in task.actions]
            failed = next((a for a in states if a and a.status == "FAILED"), None)
            if all(a and a.status == "FINISHED" for a in states):
                self._tasks.end(task, "DONE")
            elif failed and not self._is_cancelled(task):
                self._tasks.end(task, "FAILED", state.reason(failed.id) or failed.result or f"{task.method} failed.")
                if not all(a and a.status in ENDED for a in states):
                    self._cancel = self._cancel or Cancellation(self._new_id())

    def _give_up_on_missed(self, state: VehicleState, now_s: float) -> None:
        """End what the vehicle says nothing of any more; the first states after it took the order may be early."""
        head = self._tasks.head
        if head is None or not head.actions or state.ahead or any(state.action(a) for a in head.actions):
            self._missed = None
        elif self._missed is None:
            self._missed = (state, now_s)
        elif self._missed[0] is not state and now_s - self._missed[1] > PATIENCE_S and not self._is_cancelled(head):
            self._missed = None
            self._tasks.end(head, "FAILED", NOT_THERE)

    def _follow_cancel(self, state: VehicleState, now_s: float) -> None:
        """Have the order cancelled: ours when it is wanted, and one of ours that nobody knows of any more."""
        if self._cancel is None and is_orphan(state, self._order.id if self._order else ""):
            self._cancel = Cancellation(self._new_id(), sent_s=self._cancelled_s)
        cancel = self._cancel
        if cancel is None or (self._order is not None and not self._order.is_taken):
            return
        if cancel.is_over(state):
            self._cancelled(cancel, state)
        elif due := cancel.due(state, now_s, self._new_id):
            self.out.append(Send("instantActions", due))

    def _cancelled(self, cancel: Cancellation, state: VehicleState) -> None:
        """Answer what ended with the order; what was not meant goes on from here, in an order of its own."""
        self._cancel, self._cancelled_s = None, cancel.sent_s
        for task in self._tasks.handed_over:
            if task.command in cancel.targets:
                self._tasks.end(task, "CANCELED", f"{task.method} was cancelled.")
            else:
                task.go_on_from(state.last_sequence)
        self._order = None
        for control in cancel.controls:
            self._tasks.say(control, "DONE")

    def _is_cancelled(self, task: Task) -> bool:
        return self._cancel is not None and task.command in self._cancel.targets

    def _steer_pause(self, state: VehicleState, now_s: float) -> None:
        wanted = self._pausing.wants(self._tasks.commands, held=self.held)
        due = self._pausing.steer(state, now_s, self._new_id, wanted=wanted) if self.vehicle.can_pause else None
        if due is not None:
            self.out.append(Send("instantActions", due))
        for command, why in self._pausing.answered(state, now_s, wanted=wanted):
            self._tasks.say(command, "REJECTED" if why else "DONE", why)

    def _hand_over(self, state: VehicleState, now_s: float) -> None:
        """Order what waits: moves in one order that grows, anything else when all before it is done."""
        order, waiting, under_way = self._order, self._tasks.waiting, self._tasks.handed_over
        if not waiting or self._cancel or (order is not None and not order.is_taken) or self._refusal():
            return
        drives, grown = drives_in_front(waiting), growing(order, state, is_under_way=bool(under_way))
        if (under_way and not (drives and grown)) or (state.has_way_left and not under_way):
            return
        if drives and (why := self._why_astray(drives[0], grown)):
            self._tasks.end_refused(drives[0], why)
            self._tasks.drop_drives()
            return
        assert self.located is not None
        self._order = next_order(self.vehicle, self.located, waiting, grown, self._new_id)
        self._tries, self._errors_before = 0, frozenset(state.errors)
        self._send_order(self._order, now_s)

    def _why_astray(self, task: Task, order: Order | None) -> str:
        """Return why a move is not handed over: while it waited, people may have driven the vehicle elsewhere."""
        assert self.located is not None
        here = Pose(*order.end_point) if order else self.located.pose
        return why_astray(self.vehicle.description.name, task.begin, self._in_site(here))

    def _send_order(self, order: Order, now_s: float) -> None:
        self._sent_s = now_s
        self._tries += 1
        self.out.append(Send("order", order.body))

    def _say_running(self) -> None:
        head = self._tasks.head
        if head is None or not head.is_handed_over or self._order is None or self._order.taken < 0:
            return
        said = self._tasks.find(head.command)
        if said is None or said.status != "RUNNING":
            self._tasks.say(head.command, "RUNNING")
