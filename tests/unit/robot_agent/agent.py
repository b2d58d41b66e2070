"""The robot's agent as the tests import it: it lies beside the product, for it runs on robots."""

import sys

from tests.kit.files import ROOT

sys.path.insert(0, str(ROOT / "firmware" / "robot_agent"))

from vipo_agent.agent import Agent, CannotStart, Navigation
from vipo_agent.config import BadConfig, Config, make_config
from vipo_agent.core import Ack, Answers, Core, Facts, Go, Halt
from vipo_agent.description import describe
from vipo_agent.link import Link
from vipo_agent.messages import Grid, Stop, Told, read_command, read_stop, write_grid

RobotGrid = Grid

__all__ = [
    "Ack",
    "Agent",
    "Answers",
    "BadConfig",
    "CannotStart",
    "Config",
    "Core",
    "Facts",
    "Go",
    "Grid",
    "Halt",
    "Link",
    "Navigation",
    "RobotGrid",
    "Stop",
    "Told",
    "describe",
    "make_config",
    "read_command",
    "read_stop",
    "write_grid",
]
