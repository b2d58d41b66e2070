"""How long a claimed command may wait in the connection to the broker."""

from __future__ import annotations

from dataclasses import replace

from execution.commands.claim import CLAIM_HOLDS_S, OutgoingCommand
from vipo_device.protocol.clock import steady_s


def test_a_command_waits_for_the_broker_no_longer_than_its_claim_holds() -> None:
    fresh = OutgoingCommand("c1", "oven", "topic", b"", 30.0, 1, steady_s() + CLAIM_HOLDS_S)
    assert 0 < fresh.wait_s <= CLAIM_HOLDS_S
    assert replace(fresh, late_at_s=steady_s() - 1).wait_s == 0


def test_one_that_is_told_only_once_waits_as_long_as_it_may_be_on_its_way() -> None:
    assert OutgoingCommand("c1", "oven", "topic", b"", 30.0, 1, steady_s(), told_once=True).wait_s == 30.0
