"""Who may do what on the embedded broker."""

from __future__ import annotations

import base64
import hashlib
import json

import pytest

from registry.broker.mosquitto_file import account_file, role_of
from vipo_device.protocol.credentials import broker_hash
from vipo_site.embedded_broker.access_control import may_publish, may_subscribe


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
        ("vipo/v1/site/+/stop", False),
        ("vipo/v1/site/yard/stop", False),
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
    assert may_subscribe("robot01", topic_filter, "hall") is allowed


def test_a_kept_key_is_what_mosquitto_checks() -> None:
    _, scheme, rounds, salt, digest = broker_hash("word", b"twelve bytes").split("$")
    assert (scheme, rounds) == ("7", "101")
    assert base64.b64decode(salt) == b"twelve bytes"
    assert base64.b64decode(digest) == hashlib.pbkdf2_hmac("sha512", b"word", b"twelve bytes", 101)


@pytest.mark.parametrize(
    ("topic", "allowed"),
    [
        ("vipo/v1/join/hall/new01", True),
        ("vipo/v1/join/other/new01", False),
        ("vipo/v1/join/hall/oven 1", True),  # it is refused by who hears it, and told to admins
        ("vipo/v1/join/hall/new01/more", False),
        ("vipo/v1/join/hall/+", False),
        ("vipo/v1/dev/join:hall/up/state", False),
    ],
)
def test_whoever_has_the_enrolment_key_may_ask_to_enrol_and_nothing_else(topic: str, allowed: bool) -> None:
    assert may_publish("join:hall", topic) is allowed
    assert not may_subscribe("join:hall", topic, "hall")
    assert not may_subscribe("join:hall", "vipo/v1/srv/status", "hall")


@pytest.mark.parametrize(
    ("topic_filter", "allowed"),
    [
        ("vipo/v1/site/hall/things/#", True),
        ("vipo/v1/site/hall/things/+/properties/#", True),
        ("vipo/v1/site/hall/things/mixer01/properties/jobStatus", True),
        ("vipo/v1/site/hall/stop", True),
        ("vipo/v1/site/hall/#", False),
        ("vipo/v1/site/hall/+", False),
        ("vipo/v1/site/hallo/things/#", False),
        ("vipo/v1/site/+/things/#", False),
        ("vipo/v1/srv/status", False),
        ("vipo/v1/dev/token:0a/down/#", False),
        ("#", False),
    ],
)
def test_a_token_hears_its_sites_things_and_stop(topic_filter: str, allowed: bool) -> None:
    assert may_subscribe("token:0a", topic_filter, "hall") is allowed


@pytest.mark.parametrize(
    "topic", ["vipo/v1/site/hall/things/a/status", "vipo/v1/dev/token:0a/up/state", "vipo/v1/join/hall/a", "a"]
)
def test_a_token_publishes_nothing(topic: str) -> None:
    assert not may_publish("token:0a", topic)


def test_mosquittos_file_has_the_tokens_with_the_site_of_each() -> None:
    hashes = {"server": broker_hash("word"), "token:0a": broker_hash("a"), "token:0b": broker_hash("b")}
    written = json.loads(account_file(hashes, {"token:0a": "hall", "token:0b": "yard"}, server="server"))
    roles = {role["rolename"]: {acl["topic"] for acl in role["acls"]} for role in written["roles"]}
    assert roles["reader 0b"] == {"vipo/v1/site/yard/things/#", "vipo/v1/site/yard/stop"}
    clients = {client["username"]: client["roles"][0]["rolename"] for client in written["clients"]}
    assert clients == {"server": "server", "token:0a": "reader 0a", "token:0b": "reader 0b"}


def test_mosquitto_is_given_the_same_rights_of_a_token() -> None:
    role = role_of("token:0a", "hall")
    assert role["rolename"] == "reader 0a"
    assert {(acl["acltype"], acl["topic"]) for acl in role["acls"]} == {
        (act, topic)
        for act in ("publishClientReceive", "subscribePattern")
        for topic in ("vipo/v1/site/hall/things/#", "vipo/v1/site/hall/stop")
    }
