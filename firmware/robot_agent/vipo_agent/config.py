"""The agent's configuration: one JSON file."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any

from vipo_agent.messages import is_number

ID = re.compile(r"[A-Za-z0-9_.-]{1,64}")
TOPICS = ("pose_topic", "battery_topic", "map_topic", "speed_topic")


class BadConfig(Exception):
    """The configuration cannot be used; the message says what to mend."""


@dataclass
class Config:
    """Who the robot is, where VIPO is, and what its parts are called in ROS. Metres, metres a second, radians."""

    id: str
    site: str
    radius_m: float
    speed_m_s: float
    ros: int
    password: str = ""
    join_key: str = ""
    host: str = "127.0.0.1"
    port: int = 1883
    ca: str = ""
    name: str = ""
    device_class: str = "turtlebot"
    height_m: float = 0.4
    home: list[float] = field(default_factory=lambda: [0.0, 0.0, 0.0])
    capacity: int = 0
    handling_s: float = 2.0
    state: str = "vipo-agent.json"
    frame: str = "map"
    action: str = ""
    pose_topic: str = "/amcl_pose"
    battery_topic: str = "/battery_state"
    map_topic: str = "/map"
    speed_topic: str = ""
    bridge_host: str = "127.0.0.1"
    bridge_port: int = 9090


def read_config(path: Path) -> Config:
    """Read the file. Raises BadConfig."""
    try:
        body = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise BadConfig(f"{path} cannot be read: {error.strerror}.") from None
    except ValueError as error:
        raise BadConfig(f"{path} is not JSON: {error}.") from None
    if not isinstance(body, dict):
        raise BadConfig(f"{path} must hold one JSON object.")
    return make_config(body)


def make_config(body: dict[str, Any]) -> Config:
    """Return the configuration of a JSON object. Raises BadConfig."""
    known = {f.name for f in fields(Config)}
    unknown = sorted(set(body) - known)
    if unknown:
        raise BadConfig(f"{unknown[0]!r} means nothing here; known are {', '.join(sorted(known))}.")
    missing = [name for name in ("id", "site", "radius_m", "speed_m_s", "ros") if name not in body]
    if missing:
        raise BadConfig(f"{missing[0]} is missing.")
    config = Config(**body)
    _check(config)
    _check_places(config)
    _check_keys(config)
    config.name = config.name or config.id
    config.action = config.action or ("move_base" if config.ros == 1 else "/navigate_to_pose")
    return config


def _check(config: Config) -> None:
    for name in ("id", "site", "device_class"):
        if ID.fullmatch(str(getattr(config, name))) is None:
            raise BadConfig(f"{name} must be 1 to 64 letters, digits, '_', '.' or '-'.")
    for name in ("radius_m", "speed_m_s", "height_m"):
        if not is_number(getattr(config, name)) or getattr(config, name) <= 0:
            raise BadConfig(f"{name} must be a number above 0.")
    if not is_number(config.handling_s) or config.handling_s < 0:
        raise BadConfig("handling_s must be a number of seconds from 0.")
    if config.ros not in (1, 2):
        raise BadConfig("ros must be 1 or 2.")
    if not (isinstance(config.home, list) and len(config.home) == 3 and all(is_number(v) for v in config.home)):
        raise BadConfig("home must be [x, y, theta]: metres and radians.")
    if not isinstance(config.capacity, int) or not 0 <= config.capacity <= 1000:
        raise BadConfig("capacity must be a whole number from 0 to 1000.")
    if not isinstance(config.name, str) or not config.name.isprintable() or len(config.name) > 100:
        raise BadConfig("name must be printable text of at most 100 characters.")


def _check_places(config: Config) -> None:
    for name in ("host", "ca", "state", "frame", "action", "bridge_host", *TOPICS):
        if not isinstance(getattr(config, name), str):
            raise BadConfig(f"{name} must be text.")
    for name in ("port", "bridge_port"):
        if type(getattr(config, name)) is not int or not 0 < getattr(config, name) < 65536:
            raise BadConfig(f"{name} must be a whole number from 1 to 65535, without quotes.")
    if config.ca and not Path(config.ca).is_file():
        raise BadConfig(f"ca: there is no file {config.ca}.")


def _check_keys(config: Config) -> None:
    if not all(isinstance(key, str) for key in (config.password, config.join_key)):
        raise BadConfig("password and join_key must be text.")
    if not (config.password or config.join_key):
        raise BadConfig("password is missing; a new device needs join_key, the site's, instead.")
