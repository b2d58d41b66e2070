"""What changes hands between robots and machines, of which one may be real and the other simulated."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Mapping
from dataclasses import dataclass

from simulation.actors.machine import shown_stock
from vipo_device.kit.arguments import counted_object
from vipo_device.protocol.description import Description, Scalar
from vipo_device.protocol.messages import AckMessage, DeviceCommand

MOST_ORDERS = 2_000


@dataclass(frozen=True, slots=True)
class HandOver:
    """Something that a robot has fetched from a machine (`count` below 0) or brought to it."""

    machine: str
    object: str
    count: int


def hand_over_of(command: DeviceCommand) -> HandOver | None:
    """Return what changes hands where a robot carries this out; None for anything else."""
    machine, goods = command.arguments.get("device"), counted_object(command.arguments)
    if command.method not in {"pick", "drop"} or not isinstance(machine, str) or isinstance(goods, str):
        return None
    return HandOver(machine, goods[0], goods[1] if command.method == "drop" else -goods[1])


def stock_for(description: Description, readings: Mapping[str, Scalar], order: HandOver) -> Mapping[str, int]:
    """Return what a real machine holds as far as it shows it; where it does not, it is taken to do as it is asked."""
    shown = shown_stock(description, readings)
    if shown is not None:
        return shown
    return {order.object: -order.count} if order.count < 0 else {}


class HandOvers:
    """The orders of robots, each until its robot has said what came of it; one that is asked again counts once."""

    def __init__(self) -> None:
        self._orders: OrderedDict[tuple[str, str], HandOver | None] = OrderedDict()

    def note(self, robot: str, command: DeviceCommand) -> HandOver | None:
        """Note what a robot was told to fetch or to bring; None where it is neither."""
        order = hand_over_of(command)
        if order is not None:
            self._orders.setdefault((robot, command.id), order)
            if len(self._orders) > MOST_ORDERS:
                self._orders.popitem(last=False)
        return order

    def take(self, robot: str, answer: AckMessage) -> HandOver | None:
        """Return what has changed hands by a robot's answer, if anything has."""
        order = self._orders.get((robot, answer.command))
        if order is None or not answer.is_final:
            return None
        self._orders[robot, answer.command] = None
        return order if answer.status == "DONE" else None

    def forget(self) -> None:
        """Forget all orders."""
        self._orders.clear()
