"""Which of the server's messages are too old for a device."""

from __future__ import annotations

import pytest

from vipo_device.kit.fence import Fence
from vipo_device.protocol.messages import (
    DeviceCommand,
    StopMessage,
    command_payload,
    read_command,
    read_stop,
)


def told(fence: int | None, method: str = "cure") -> DeviceCommand:
    return DeviceCommand("c", method, {}, fence)


def test_a_command_from_before_a_stop_does_not_count_also_after_its_reset() -> None:
    fence = Fence()
    assert fence.takes_command(told(5))
    assert fence.takes_stop(StopMessage(True, 7))
    assert not fence.takes_command(told(5))
    assert not fence.takes_command(told(5, "resume"))
    assert fence.takes_command(told(7, "pause"))
    assert fence.takes_stop(StopMessage(False, 8))
    assert [fence.takes_command(told(each)) for each in (5, 7, 8)] == [False, False, True]


def test_a_stop_or_reset_that_is_older_than_the_last_does_not_count() -> None:
    fence = Fence()
    assert fence.takes_stop(StopMessage(True, 7))
    assert not fence.takes_stop(StopMessage(False, 6))
    assert fence.takes_stop(StopMessage(True, 7))
    assert fence.takes_stop(StopMessage(False, 8))
    assert not fence.takes_stop(StopMessage(True, 7))


def test_a_command_that_overtakes_the_reset_waits_until_it_is_sent_again() -> None:
    fence = Fence()
    fence.takes_stop(StopMessage(True, 7))
    assert not fence.takes_command(told(8))
    assert fence.takes_stop(StopMessage(False, 8))
    assert fence.takes_command(told(8))


def test_whoever_names_no_fence_is_heard_as_before() -> None:
    fence = Fence()
    fence.takes_stop(StopMessage(True, 7))
    assert fence.takes_command(told(None))
    assert fence.takes_stop(StopMessage(False))
    assert not fence.takes_stop(StopMessage(True, 6))


@pytest.mark.parametrize("bad", [b'"7"', b"-1", b"true", b"7.5", b"null", b"[7]"])
def test_a_fence_that_is_no_number_is_none(bad: bytes) -> None:
    command = read_command("cure", b'{"id": "c", "v": {}, "fence": ' + bad + b"}")
    assert command is not None
    assert command.fence is None
    assert read_stop(b'{"active": false, "fence": ' + bad + b"}") == StopMessage(False)


def test_a_fence_crosses_the_wire() -> None:
    command = read_command("cure", command_payload("c", {}, 5.0, 1_790_000_000_000))
    assert command == DeviceCommand("c", "cure", {}, 1_790_000_000_000)
    assert read_stop(b'{"active": true, "at": null, "fence": 9}') == StopMessage(True, 9)
    assert (read_stop(b""), read_stop(b"?"), read_stop(b"[]")) == (
        StopMessage(False),
        StopMessage(True),
        StopMessage(True),
    )
