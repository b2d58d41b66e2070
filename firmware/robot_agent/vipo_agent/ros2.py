"""ROS 2: Nav2's NavigateToPose over rosbridge, by roslibpy. Needs nothing of ROS where the agent runs."""

from __future__ import annotations

from typing import Any

import roslibpy
from roslibpy.core import RosTimeoutError

from vipo_agent.agent import Agent, CannotStart, Navigation
from vipo_agent.config import Config
from vipo_agent.core import Go
from vipo_agent.geometry import quaternion, yaw
from vipo_agent.messages import Grid

CONNECT_S = 20
SUCCEEDED = 4
FULL_SPEED = {"percentage": True, "speed_limit": 100.0}
"""What the topic of nav2_msgs/SpeedLimit is told when there is no limit."""


class NavigateToPose(Navigation):
    """Drives a robot by goals for Nav2; with `speed_topic` it can be told to drive slower."""

    def __init__(self, config: Config) -> None:
        self._config = config
        self.limits_speed = bool(config.speed_topic)
        self._ros = roslibpy.Ros(config.bridge_host, config.bridge_port)
        self._client = roslibpy.ActionClient(self._ros, config.action, "nav2_msgs/action/NavigateToPose")
        self._speed = roslibpy.Topic(self._ros, config.speed_topic or "/speed_limit", "nav2_msgs/msg/SpeedLimit")
        self._goal_id: Any = None
        self._number = 0
        self._agent: Any = None

    def start(self, agent: Agent) -> None:
        """Connect to the bridge, and listen to the robot's pose, battery and map."""
        self._agent = agent
        try:
            self._ros.run(CONNECT_S)
        except RosTimeoutError:
            self._ros.close()
            where = f"{self._config.bridge_host}:{self._config.bridge_port}"
            raise CannotStart(f"rosbridge does not answer at {where}; is rosbridge_server running?") from None
        self._ros.on("close", self._lost)
        if self.limits_speed:
            # Whoever listens needs a moment to find a new topic, and would miss what is said at once.
            self._speed.advertise()
        hear = {
            (self._config.pose_topic, "geometry_msgs/msg/PoseWithCovarianceStamped"): self._hear_pose,
            (self._config.battery_topic, "sensor_msgs/msg/BatteryState"): self._hear_battery,
            (self._config.map_topic, "nav_msgs/msg/OccupancyGrid"): self._hear_map,
        }
        for (name, kind), callback in hear.items():
            roslibpy.Topic(self._ros, name, kind).subscribe(callback)

    def go(self, goal: Go) -> None:
        """Send a goal, in whose favour Nav2 gives up the one before it."""
        if not self._ros.is_connected:
            self._agent.failed(goal.number, "The robot's rosbridge is not connected.")
            return
        self._limit_speed(goal)
        z, w = quaternion(goal.theta)
        pose = {"position": {"x": goal.x, "y": goal.y, "z": 0.0}, "orientation": {"x": 0.0, "y": 0.0, "z": z, "w": w}}
        stamped = {"header": {"frame_id": self._config.frame}, "pose": pose}
        self._number = goal.number
        self._goal_id = self._client.send_goal(
            roslibpy.Goal({"pose": stamped, "behavior_tree": ""}),
            lambda result: self._ended(goal.number, result),
            lambda _feedback: None,
            lambda result: self._ended(goal.number, result),
        )

    def halt(self) -> None:
        """Cancel the goal that is being driven to."""
        if self._goal_id is not None and self._ros.is_connected:
            self._client.cancel_goal(self._goal_id)
        self._goal_id = None

    def stop(self) -> None:
        """End the connection to the bridge."""
        self._ros.off("close", self._lost)
        self._ros.close()

    def _limit_speed(self, goal: Go) -> None:
        """Tell Nav2 how fast to drive, with each goal: one that started anew knows nothing of what it was told."""
        if not self.limits_speed:
            return
        limit = {"percentage": False, "speed_limit": goal.speed_m_s} if goal.speed_m_s else FULL_SPEED
        self._speed.publish(roslibpy.Message(limit))

    def _ended(self, number: int, result: Any) -> None:
        status = getattr(result.get("status"), "value", result.get("status"))
        if status == SUCCEEDED:
            self._agent.reached(number)
            return
        values = result.get("values")
        text = values.get("error_msg") if isinstance(values, dict) else values
        self._agent.failed(number, f"{self._config.action}: {text or f'it ended with the status {status}'}")

    def _lost(self, *_: Any) -> None:
        """What becomes of a goal cannot be known without the bridge."""
        if self._goal_id is not None:
            self._goal_id = None
            self._agent.failed(self._number, "The robot's rosbridge is not connected.")

    def _hear_pose(self, message: dict[str, Any]) -> None:
        pose = message["pose"]["pose"]
        position, orientation = pose["position"], pose["orientation"]
        self._agent.moved((position["x"], position["y"], yaw(orientation["z"], orientation["w"])))

    def _hear_battery(self, message: dict[str, Any]) -> None:
        if isinstance(message.get("percentage"), (int, float)):
            self._agent.charged(100.0 * message["percentage"])

    def _hear_map(self, message: dict[str, Any]) -> None:
        info = message["info"]
        position, turned = info["origin"]["position"], info["origin"]["orientation"]
        origin = (position["x"], position["y"], yaw(turned["z"], turned["w"]))
        cells = bytes(value & 0xFF for value in message["data"])
        self._agent.mapped(Grid(info["width"], info["height"], round(info["resolution"], 6), origin, cells))
