"""The agent that makes a ROS robot a device of VIPO."""
