"""A vehicle that speaks VDA 5050 2.1, with what that version added: maps, hints, versions of its own.

vda-5050-lib 1.4.0 knows 2.0 only. This one drives straight from node to node and is as strict as the standard allows:
of instant actions it reads `actions` alone, and it refuses an order whose maps it does not have.
"""

from __future__ import annotations

import json
import threading
from datetime import UTC, datetime
from math import atan2, hypot
from typing import Any

from tests.integration.connectors.factsheet import FACTSHEET
from vipo_device.protocol.mqtt_client import MqttClient

VERSION = "2.1.0"
TICK_S = 0.05
SPEED_M_S = 4.0
MAPS = [
    {"mapId": "hall", "mapVersion": "3.1", "mapDescription": "after the move", "mapStatus": "ENABLED"},
    {"mapId": "hall", "mapVersion": "3.0", "mapStatus": "DISABLED"},
]
Body = dict[str, Any]


def modern_factsheet() -> Body:
    """Return the factsheet with the fields of 2.1."""
    sheet = json.loads(json.dumps(FACTSHEET))
    for each in sheet["protocolFeatures"]["agvActions"]:
        each["blockingTypes"] = ["NONE", "SOFT", "HARD"]
    versions = [{"key": "softwareVersion", "value": "v1.12.4-beta"}]
    network = {"dnsServers": ["10.0.0.1"], "ntpServers": [], "localIpAddress": "10.0.0.7", "netmask": "255.255.255.0"}
    return {**sheet, "vehicleConfig": {"versions": versions, "network": network}, "localizationParameters": {}}


class ModernVehicle:
    """The vehicle; `orders` and `instant` are the messages that it was sent."""

    def __init__(self, port: int, serial: str) -> None:
        self.orders: list[Body] = []
        self.instant: list[Body] = []
        self._base = f"uagv/v2/Acme/{serial}/"
        self._serial = serial
        self._numbers: dict[str, int] = {}
        self._guard = threading.RLock()
        self._way: list[Body] = []
        self._actions: list[Body] = []
        self._at = {"x": 1.0, "y": 2.0, "theta": 0.0}
        self._loads: list[Body] = []
        self._told: Body = {"orderId": "", "orderUpdateId": 0, "lastNodeId": "", "lastNodeSequenceId": 0}
        self._errors: list[Body] = []
        self._paused = False
        will = (self._base + "connection", self._message("connection", connectionState="CONNECTIONBROKEN"), 1, True)
        self._client = MqttClient(
            host="127.0.0.1", port=port, username="", password="", client_id=f"modern-{serial}", will=will
        )
        self._client.subscribe(self._base + "order", 1, lambda _t, payload, _r: self._take_order(json.loads(payload)))
        self._client.subscribe(self._base + "instantActions", 1, lambda _t, p, _r: self._act_now(json.loads(p)))
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run)

    def start(self) -> None:
        self._client.start()
        assert self._client.wait_subscribed(20)
        self._say("connection", retain=True, connectionState="ONLINE")
        self._say("factsheet", retain=True, **modern_factsheet())
        self._thread.start()

    def stop(self) -> None:
        self._ended.set()
        self._thread.join(20)
        self._client.stop()

    def _message(self, topic: str, **body: Any) -> bytes:
        number = self._numbers[topic] = self._numbers.get(topic, -1) + 1
        at = datetime.now(UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")
        header = {"headerId": number, "timestamp": at, "version": VERSION}
        return json.dumps({**header, "manufacturer": "Acme", "serialNumber": self._serial, **body}).encode()

    def _say(self, topic: str, *, retain: bool = False, **body: Any) -> None:
        self._client.publish(self._base + topic, self._message(topic, **body), retain=retain)

    def _tell_state(self, *, driving: bool) -> None:
        nodes = [n for n in self._way if "nodeId" in n]
        edges = [e for e in self._way if "edgeId" in e]
        self._say(
            "state",
            **self._told,
            maps=MAPS,
            nodeStates=[{k: n[k] for k in ("nodeId", "sequenceId", "released", "nodePosition")} for n in nodes],
            edgeStates=[{k: e[k] for k in ("edgeId", "sequenceId", "released")} for e in edges],
            actionStates=self._actions,
            agvPosition={**self._at, "mapId": "hall", "positionInitialized": True, "localizationScore": 0.9},
            velocity={"vx": 0.0, "vy": 0.0, "omega": 0.0},
            batteryState={"batteryCharge": 71.0, "charging": False, "batteryHealth": 98, "reach": 9000},
            driving=driving,
            paused=self._paused,
            newBaseRequest=False,
            operatingMode="AUTOMATIC",
            errors=self._errors,
            information=[{"infoType": "note", "infoLevel": "DEBUG", "infoReferences": []}],
            safetyState={"eStop": "NONE", "fieldViolation": False},
            loads=self._loads,
        )

    def _run(self) -> None:
        tick = 0
        while not self._ended.wait(TICK_S):
            with self._guard:
                driving = self._step()
                if driving or tick % 10 == 0 or any(a["actionStatus"] == "WAITING" for a in self._actions):
                    self._carry_out()
                    self._tell_state(driving=driving)
            tick += 1

    def _step(self) -> bool:
        """Drive on by a tick; tell whether there was somewhere to drive."""
        if self._paused or not self._way or not self._way[0]["released"]:
            return False
        node = next(part for part in self._way if "nodeId" in part)
        goal, speed = node["nodePosition"], min(SPEED_M_S, self._way[0].get("maxSpeed", SPEED_M_S))
        dx, dy = goal["x"] - self._at["x"], goal["y"] - self._at["y"]
        left, step = hypot(dx, dy), speed * TICK_S
        if left > step:
            self._at.update(x=self._at["x"] + dx / left * step, y=self._at["y"] + dy / left * step, theta=atan2(dy, dx))
            return True
        self._at.update(x=goal["x"], y=goal["y"], theta=goal.get("theta", self._at["theta"]))
        self._reach(node)
        self._way = [part for part in self._way if part["sequenceId"] > node["sequenceId"]]
        return True

    def _reach(self, node: Body) -> None:
        self._told |= {"lastNodeId": node["nodeId"], "lastNodeSequenceId": node["sequenceId"]}
        self._actions += [
            {"actionId": a["actionId"], "actionType": a["actionType"], "actionStatus": "WAITING"}
            for a in node["actions"]
        ]

    def _carry_out(self) -> None:
        for action in self._actions:
            if action["actionStatus"] == "WAITING":
                action["actionStatus"] = "FINISHED"
                if action["actionType"] in ("pick", "drop"):
                    self._loads = [{"loadType": "EPAL", "loadPosition": "deck"}] * (action["actionType"] == "pick")

    def _take_order(self, order: Body) -> None:
        with self._guard:
            self.orders.append(order)
            nodes, edges = order["nodes"], order["edges"]
            if any(node["nodePosition"]["x"] > 100 for node in nodes):
                self._refuse(order)
                return
            parts = sorted([*nodes, *edges], key=lambda part: int(part["sequenceId"]))
            is_new = order["orderId"] != self._told["orderId"]
            kept = (
                [] if is_new else [p for p in self._way if p["released"] and p["sequenceId"] <= parts[0]["sequenceId"]]
            )
            if is_new:
                self._actions = [a for a in self._actions if a["actionType"] in ("startPause", "stopPause")]
                self._reach(parts[0])
            self._errors = []
            self._told |= {"orderId": order["orderId"], "orderUpdateId": order["orderUpdateId"]}
            self._way = [*kept, *parts[1:]]
            self._tell_state(driving=False)

    def _refuse(self, order: Body) -> None:
        references = [
            {"referenceKey": "orderId", "referenceValue": order["orderId"]},
            {"referenceKey": "orderUpdateId", "referenceValue": str(order["orderUpdateId"])},
        ]
        error = {"errorType": "noRouteError", "errorLevel": "WARNING", "errorDescription": "there is a wall"}
        self._errors = [{**error, "errorHint": "drive round it", "errorReferences": references}]
        self._tell_state(driving=False)

    def _act_now(self, message: Body) -> None:
        with self._guard:
            self.instant.append(message)
            for action in message["actions"]:
                kind = action["actionType"]
                self._paused = kind == "startPause" or (self._paused and kind != "stopPause")
                if kind == "cancelOrder":
                    self._way = []
                self._actions.append(
                    {"actionId": action["actionId"], "actionType": kind, "actionStatus": "FINISHED"},
                )
            self._tell_state(driving=False)
