"""Who may do what on the embedded broker."""

from __future__ import annotations

import base64
import hashlib

import pytest

from vipo_site.broker import may_publish, may_subscribe
from vipo_site.passwords import password_line


@pytest.mark.parametrize(
    ("topic", "allowed"),
    [
        ("vipo/v1/dev/robot01/up/state", True),
        ("vipo/v1/dev/robot01/up/a/b", True),
        ("vipo/v1/dev/robot01/down/move", False),
        ("vipo/v1/dev/robot011/up/state", False),
        ("vipo/v1/dev/robot02/up/state", False),
        ("vipo/v1/dev/robot01/up/#", False),
        ("vipo/v1/site/hall/stop", False),
        ("vipo/v1/srv/status", False),
    ],
)
def test_a_device_publishes_only_under_its_own_up(topic: str, allowed: bool) -> None:
    assert may_publish("robot01", topic) is allowed


@pytest.mark.parametrize(
    ("topic_filter", "allowed"),
    [
        ("vipo/v1/dev/robot01/down/#", True),
        ("vipo/v1/dev/robot01/down/move", True),
        ("vipo/v1/site/hall/stop", True),
        ("vipo/v1/site/+/stop", True),
        ("vipo/v1/srv/status", True),
        ("vipo/v1/dev/+/down/#", False),
        ("vipo/v1/dev/robot01/#", False),
        ("vipo/v1/dev/robot02/down/#", False),
        ("vipo/v1/site/#/stop", False),
        ("vipo/v1/site/hall/#", False),
        ("#", False),
        ("$SYS/#", False),
    ],
)
def test_a_device_hears_only_its_commands_the_stop_and_the_servers_births(topic_filter: str, allowed: bool) -> None:
    assert may_subscribe("robot01", topic_filter) is allowed


def test_a_password_line_is_what_mosquitto_checks() -> None:
    line = password_line("robot01", "word", b"twelve bytes")
    name, scheme, rounds, salt, digest = line.replace(":$", "$").split("$")
    assert (name, scheme, rounds) == ("robot01", "7", "101")
    assert base64.b64decode(salt) == b"twelve bytes"
    assert base64.b64decode(digest) == hashlib.pbkdf2_hmac("sha512", b"word", b"twelve bytes", 101)
