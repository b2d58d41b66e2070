"""`python3 -m vipo_agent CONFIG.json`: make this robot a device of VIPO."""

from __future__ import annotations

import logging
import signal
import sys
import threading
from pathlib import Path
from typing import Any

from vipo_agent.agent import Agent, CannotStart, Navigation
from vipo_agent.config import BadConfig, Config, read_config

MISSING = {
    1: "Source the robot's ROS before (`. /opt/ros/noetic/setup.bash`) and use its own Python.",
    2: "Install it: pip install roslibpy==2.1.0.",
}


def main(arguments: list[str]) -> int:
    """Run until SIGTERM or Ctrl-C; returns 2 when the configuration cannot be used, 1 when the robot cannot."""
    if len(arguments) != 1:
        sys.stderr.write("Name the configuration: python3 -m vipo_agent CONFIG.json\n")
        return 2
    try:
        config = read_config(Path(arguments[0]))
    except BadConfig as error:
        sys.stderr.write(f"{error}\n")
        return 2
    logging.basicConfig(level=logging.WARNING, format="%(asctime)s %(levelname)s %(name)s: %(message)s")
    stopping = threading.Event()

    def stop(_signal: int, _frame: Any) -> None:
        stopping.set()

    signal.signal(signal.SIGTERM, stop)
    signal.signal(signal.SIGINT, stop)
    try:
        Agent(config, make_navigation(config)).run(stopping)
    except CannotStart as error:
        sys.stderr.write(f"{error}\n")
        return 1
    return 0


def make_navigation(config: Config) -> Navigation:
    """Return the shell for the robot's ROS; only that one's packages are needed. Raises CannotStart."""
    try:
        if config.ros == 1:
            from vipo_agent.ros1 import MoveBase

            return MoveBase(config)
        from vipo_agent.ros2 import NavigateToPose

        return NavigateToPose(config)
    except ModuleNotFoundError as error:
        raise CannotStart(f"{error.name} is missing. {MISSING[config.ros]}") from None


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
