"""A ROS 1 node that stands in for move_base, amcl, a battery and a map server. Runs with Debian's Python and rospy."""

from __future__ import annotations

import sys
from math import atan2, cos, sin
from pathlib import Path

import actionlib
import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped
from move_base_msgs.msg import MoveBaseAction, MoveBaseResult
from nav_msgs.msg import OccupancyGrid
from sensor_msgs.msg import BatteryState

sys.path.insert(0, str(Path(__file__).parent))
from pretend_robot import HEIGHT, WIDTH, PretendRobot, map_cells

STEP_S = 0.05


def drive(server, robot) -> None:
    goal = server.current_goal.get_goal().target_pose.pose
    theta = 2 * atan2(goal.orientation.z, goal.orientation.w)
    if not robot.can_reach(goal.position.x):
        server.set_aborted(MoveBaseResult(), "Failed to find a valid plan.")
        return
    while not rospy.is_shutdown():
        if server.is_preempt_requested():
            server.set_preempted(MoveBaseResult(), "")
            return
        if robot.step(goal.position.x, goal.position.y, theta, STEP_S):
            server.set_succeeded(MoveBaseResult(), "Goal reached.")
            return
        rospy.sleep(STEP_S)


def main() -> None:
    rospy.init_node("stand_in")
    robot = PretendRobot()
    server = actionlib.SimpleActionServer(
        "move_base", MoveBaseAction, execute_cb=lambda _goal: drive(server, robot), auto_start=False
    )
    server.start()
    poses = rospy.Publisher("/amcl_pose", PoseWithCovarianceStamped, queue_size=1)
    battery = rospy.Publisher("/battery_state", BatteryState, queue_size=1, latch=True)
    maps = rospy.Publisher("/map", OccupancyGrid, queue_size=1, latch=True)
    grid = OccupancyGrid()
    grid.info.width, grid.info.height, grid.info.resolution = WIDTH, HEIGHT, 0.05
    grid.info.origin.position.x, grid.info.origin.position.y = -1.0, -2.0
    grid.info.origin.orientation.w = 1.0
    grid.data = map_cells()
    maps.publish(grid)
    battery.publish(BatteryState(percentage=0.876))
    sys.stdout.write("ready\n")
    sys.stdout.flush()
    while not rospy.is_shutdown():
        said = PoseWithCovarianceStamped()
        said.header.frame_id = "map"
        said.pose.pose.position.x, said.pose.pose.position.y = robot.x, robot.y
        said.pose.pose.orientation.z, said.pose.pose.orientation.w = sin(robot.theta / 2), cos(robot.theta / 2)
        poses.publish(said)
        rospy.sleep(STEP_S)


if __name__ == "__main__":
    main()
