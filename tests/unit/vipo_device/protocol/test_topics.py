from __future__ import annotations

import pytest

from vipo_device.protocol.topics import find_topic_fault, is_own

HOSTILE = (
    *("vipo/v1/dev/m2/down/a", "vipo/v1/dev/m1/up/state", "vipo/v1/site/hall/stop", "vipo/v1/srv/status", "vipo"),
    *("VIPO/v1/dev/m2/down/a", "vipo/v1/dev/m1/down/a/b", "vipo/v1/dev/m1/down/", "vipo/v2/anything"),
    *("$SYS/broker", "$CONTROL/dynamic-security/v1", "$share/g/plant", "#", "+", "plant/+", "plant/#", "plant/a#"),
    *("", "/", "/plant", "plant/", "plant//a", "plant/a\0", "plant/a\n", "plant/a b", "plant/%u", "pl\u00e4nt/a"),
    "p" * 201,
)


@pytest.mark.parametrize("topic", HOSTILE)
def test_a_hostile_topic_can_never_be_asked_for(topic: str) -> None:
    found = find_topic_fault("m1", "mix", topic)
    assert found is not None
    assert "use vipo/v1/dev/m1/down/mix" in found.text
    assert not is_own("m1", topic)


@pytest.mark.parametrize("method", ["pause", "resume", "cancel", "credential"])
def test_what_the_protocol_itself_says_to_a_device_keeps_its_topic(method: str) -> None:
    found = find_topic_fault("m1", method, "plant/m1")
    assert found is not None
    assert found.code == "topic_fixed"
    assert find_topic_fault("m1", method, f"vipo/v1/dev/m1/down/{method}") is None


@pytest.mark.parametrize("topic", ["dev05_mixPaint", "plant/hall-2/mixer.1/start", "p" * 200])
def test_a_plain_topic_may_be_asked_for(topic: str) -> None:
    assert find_topic_fault("m1", "mix", topic) is None
