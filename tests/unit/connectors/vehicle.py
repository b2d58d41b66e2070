"""A vehicle as the tests of its control see it: its factsheet, and states as it would tell them."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from itertools import count
from typing import Any

from connectors.vda5050.control import Send, VehicleControl
from connectors.vda5050.coordinates import Frame
from connectors.vda5050.factsheet import describe, device_id, read_factsheet
from connectors.vda5050.messages import VehicleName, VehicleState, read_state
from connectors.vda5050.tasks import Vehicle
from tests.integration.connectors.factsheet import FACTSHEET
from vipo_device.protocol.description import Pose
from vipo_device.protocol.messages import AckMessage, DeviceCommand

NAME = VehicleName("Acme", "1")
HEADER = {
    "headerId": 1,
    "timestamp": "2026-01-01T12:00:00.00Z",
    "version": "2.0.0",
    "manufacturer": "Acme",
    "serialNumber": "1",
}
STATE: dict[str, Any] = {
    **HEADER,
    "orderId": "",
    "orderUpdateId": 0,
    "lastNodeId": "0",
    "lastNodeSequenceId": 0,
    "nodeStates": [],
    "edgeStates": [],
    "actionStates": [],
    "agvPosition": {"x": 0.0, "y": 0.0, "theta": 0.0, "mapId": "hall", "positionInitialized": True},
    "batteryState": {"batteryCharge": 55.4, "charging": False},
    "driving": False,
    "paused": False,
    "operatingMode": "AUTOMATIC",
    "errors": [],
    "safetyState": {"eStop": "NONE", "fieldViolation": False},
    "loads": [],
}


def payload(body: dict[str, Any], **changes: Any) -> bytes:
    return json.dumps({**body, **changes}).encode()


def state(**changes: Any) -> VehicleState:
    return read_state(payload(STATE, **changes), NAME)


def ids() -> Callable[[], str]:
    numbers = count(1)
    return lambda: f"n{next(numbers)}"


def make_vehicle(without: str = "", frame: Frame | None = None, more: Sequence[dict[str, Any]] = ()) -> Vehicle:
    features = FACTSHEET["protocolFeatures"]
    actions = [*(a for a in features["agvActions"] if a["actionType"] != without), *more]
    sheet = read_factsheet(payload({**HEADER, **FACTSHEET}, protocolFeatures={**features, "agvActions": actions}), NAME)
    frame = frame or Frame()
    return Vehicle(describe(NAME, sheet, Pose(0.0, 0.0), "hall", device_id(NAME)), sheet, frame, "2.0.0")


class Bench:
    """A control whose vehicle does what the test says; time passes when it says so."""

    def __init__(self, vehicle: Vehicle | None = None) -> None:
        self.now_s = 100.0
        self.control = VehicleControl(vehicle or make_vehicle(), ids())
        self.control.online = True
        self.hear()

    def tell(self, method: str, command: str, /, **arguments: Any) -> None:
        self.control.command(DeviceCommand(command, method, arguments), self.now_s)

    def hear(self, **changes: Any) -> None:
        self.control.hear_state(state(**changes), self.now_s)

    def wait(self, seconds: float) -> None:
        self.now_s += seconds
        self.control.settle(self.now_s)

    def said(self) -> list[str]:
        """Take the answers since the last time: `id STATUS` or `id STATUS why`; messages to the vehicle stay."""
        acks = [item for item in self.control.out if isinstance(item, AckMessage)]
        self.control.out = [item for item in self.control.out if isinstance(item, Send)]
        return [f"{a.command} {a.status} {a.why}".strip() for a in acks]

    def sent(self) -> list[dict[str, Any]]:
        """Take the messages to the vehicle since the last time; answers stay."""
        sends = [item for item in self.control.out if isinstance(item, Send)]
        self.control.out = [item for item in self.control.out if isinstance(item, AckMessage)]
        return [dict(item.body) for item in sends]


def ahead(*released: int, horizon: tuple[int, ...] = ()) -> dict[str, Any]:
    """Return the nodes and edges that are still before a vehicle."""
    stretches = [
        {"sequenceId": s, "released": s in released, "nodeId": f"{s}", "edgeId": f"{s}"} for s in (*released, *horizon)
    ]
    return {
        "nodeStates": [s for s in stretches if s["sequenceId"] % 2 == 0],
        "edgeStates": [s for s in stretches if s["sequenceId"] % 2],
    }


ORDER = "vipo-n1"


def error(kind: str, *, level: str = "WARNING", text: str = "", **references: str) -> dict[str, Any]:
    named = [{"referenceKey": key, "referenceValue": value} for key, value in references.items()]
    return {"errorType": kind, "errorLevel": level, "errorDescription": text, "errorReferences": named}


def driving() -> Bench:
    """Return a vehicle that has taken the piece `a`, two nodes long, and has passed the first of them."""
    bench = Bench()
    bench.tell("move", "a", path=[[1, 0], [2, 0]])
    bench.hear(orderId=ORDER, driving=True, **ahead(1, 2, 3, 4))
    bench.hear(orderId=ORDER, driving=True, lastNodeSequenceId=2, **ahead(3, 4))
    bench.said(), bench.sent()
    return bench
