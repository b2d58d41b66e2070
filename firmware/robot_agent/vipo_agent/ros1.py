"""ROS 1: `move_base` through actionlib. Runs with the robot's own Python, which has rospy."""

from __future__ import annotations

from typing import Any

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import PoseWithCovarianceStamped
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal
from nav_msgs.msg import OccupancyGrid
from sensor_msgs.msg import BatteryState

from vipo_agent.agent import Agent, Navigation
from vipo_agent.config import Config
from vipo_agent.core import Go
from vipo_agent.geometry import quaternion, yaw
from vipo_agent.messages import Grid

CONNECT_S = 5.0


class MoveBase(Navigation):
    """Drives a robot by goals for move_base; it cannot be told to drive slower."""

    def __init__(self, config: Config) -> None:
        self._config = config
        rospy.init_node("vipo_agent", anonymous=True, disable_signals=True)
        self._client = actionlib.SimpleActionClient(config.action, MoveBaseAction)
        self._agent: Any = None

    def start(self, agent: Agent) -> None:
        """Listen to the robot's pose, battery and map."""
        self._agent = agent
        self._client.wait_for_server(rospy.Duration(CONNECT_S))
        rospy.Subscriber(self._config.pose_topic, PoseWithCovarianceStamped, self._hear_pose, queue_size=1)
        rospy.Subscriber(self._config.battery_topic, BatteryState, self._hear_battery, queue_size=1)
        rospy.Subscriber(self._config.map_topic, OccupancyGrid, self._hear_map, queue_size=1)

    def go(self, goal: Go) -> None:
        """Send a goal, which takes the place of the one before it."""
        if not self._client.wait_for_server(rospy.Duration(CONNECT_S)):
            self._agent.failed(goal.number, f"{self._config.action} does not answer.")
            return
        target = MoveBaseGoal()
        target.target_pose.header.frame_id = self._config.frame
        target.target_pose.header.stamp = rospy.Time.now()
        target.target_pose.pose.position.x, target.target_pose.pose.position.y = goal.x, goal.y
        z, w = quaternion(goal.theta)
        target.target_pose.pose.orientation.z, target.target_pose.pose.orientation.w = z, w
        self._client.send_goal(target, done_cb=lambda status, _result: self._ended(goal.number, status))

    def halt(self) -> None:
        """Cancel whatever goal there is, also one of an agent that died."""
        self._client.cancel_all_goals()

    def stop(self) -> None:
        """Leave ROS."""
        rospy.signal_shutdown("The agent ends.")

    def _ended(self, number: int, status: int) -> None:
        if status == GoalStatus.SUCCEEDED:
            self._agent.reached(number)
        else:
            text = self._client.get_goal_status_text() or GoalStatus.to_string(status).lower()
            self._agent.failed(number, f"{self._config.action}: {text}")

    def _hear_pose(self, message: Any) -> None:
        pose = message.pose.pose
        self._agent.moved((pose.position.x, pose.position.y, yaw(pose.orientation.z, pose.orientation.w)))

    def _hear_battery(self, message: Any) -> None:
        if message.percentage == message.percentage:  # ROS says NaN where it does not know
            self._agent.charged(100.0 * message.percentage)

    def _hear_map(self, message: Any) -> None:
        info = message.info
        origin = (
            info.origin.position.x,
            info.origin.position.y,
            yaw(info.origin.orientation.z, info.origin.orientation.w),
        )
        cells = bytes(value & 0xFF for value in message.data)
        self._agent.mapped(Grid(info.width, info.height, round(info.resolution, 6), origin, cells))
