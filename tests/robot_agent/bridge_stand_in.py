"""A small stand-in for rosbridge with Nav2 behind it: topics, and the action NavigateToPose with its cancelling."""

from __future__ import annotations

import json
import threading
import time
from math import atan2, cos, sin
from typing import Any

from websockets.exceptions import ConnectionClosed
from websockets.sync.server import Server, ServerConnection, serve

from tests.robot_agent.pretend_robot import HEIGHT, SPEED_M_S, WIDTH, PretendRobot, map_cells

STEP_S = 0.05
SUCCEEDED, CANCELED, ABORTED = 4, 5, 6


class BridgeStandIn:
    """Serves until it is closed; what clients publish and ask for is kept in `heard`."""

    def __init__(self, port: int) -> None:
        self.robot = PretendRobot()
        self.heard: list[dict[str, Any]] = []
        self.port = port
        self._goal: dict[str, Any] | None = None
        self._guard = threading.Lock()
        self._server: Server = serve(self._talk, "127.0.0.1", port, max_size=2**24)
        self._thread = threading.Thread(target=self._server.serve_forever)
        self._thread.start()

    def close(self) -> None:
        self._server.shutdown()
        self._thread.join(10)

    def _talk(self, socket: ServerConnection) -> None:
        topics: set[str] = set()
        last = time.monotonic()
        try:
            while True:
                try:
                    self._hear(socket, json.loads(socket.recv(timeout=STEP_S)), topics)
                except TimeoutError:
                    now = time.monotonic()
                    self._move(socket, now - last, topics)
                    last = now
        except ConnectionClosed:
            return

    def _hear(self, socket: ServerConnection, body: dict[str, Any], topics: set[str]) -> None:
        self.heard.append(body)
        if body["op"] == "subscribe":
            topics.add(body["topic"])
            once = {"/battery_state": {"percentage": 0.876}, "/map": grid()}
            if body["topic"] in once:
                say(socket, op="publish", topic=body["topic"], msg=once[body["topic"]])
        elif body["op"] == "publish" and body["topic"] == "/speed_limit":
            said = body["msg"]
            self.robot.limit_m_s = SPEED_M_S if said["percentage"] else said["speed_limit"]
        elif body["op"] == "send_action_goal":
            self._end(socket, ABORTED, "preempted by another goal")
            self._goal = body
        elif body["op"] == "cancel_action_goal" and self._goal and self._goal["id"] == body["id"]:
            self._end(socket, CANCELED, "canceled")

    def _move(self, socket: ServerConnection, dt_s: float, topics: set[str]) -> None:
        if self._goal is not None:
            pose = self._goal["args"]["pose"]["pose"]
            theta = 2 * atan2(pose["orientation"]["z"], pose["orientation"]["w"])
            if not self.robot.can_reach(pose["position"]["x"]):
                self._end(socket, ABORTED, "no valid path")
            elif self.robot.step(pose["position"]["x"], pose["position"]["y"], theta, dt_s):
                self._end(socket, SUCCEEDED, "")
        if "/amcl_pose" in topics:
            z, w = sin(self.robot.theta / 2), cos(self.robot.theta / 2)
            at = {"position": {"x": self.robot.x, "y": self.robot.y, "z": 0.0}, "orientation": {"z": z, "w": w}}
            say(socket, op="publish", topic="/amcl_pose", msg={"pose": {"pose": at}})

    def _end(self, socket: ServerConnection, status: int, text: str) -> None:
        goal, self._goal = self._goal, None
        if goal is not None:
            values = {"error_code": 0, "error_msg": text}
            ended = {"id": goal["id"], "action": goal["action"], "values": values, "status": status}
            say(socket, op="action_result", result=status == SUCCEEDED, **ended)


def say(socket: ServerConnection, **body: Any) -> None:
    socket.send(json.dumps(body))


def grid() -> dict[str, Any]:
    origin = {"position": {"x": -1.0, "y": -2.0, "z": 0.0}, "orientation": {"x": 0, "y": 0, "z": 0.0, "w": 1.0}}
    info = {"width": WIDTH, "height": HEIGHT, "resolution": 0.05, "origin": origin}
    return {"info": info, "data": map_cells()}
