"""Runs while processes die and freeze at named points and servers are restarted; `make chaos` plays a thousand."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.integration.breaking.chaos.faults import AT_RANDOM, at_point
from tests.integration.breaking.chaos.game import play
from tests.integration.breaking.chaos.hall import Game

pytestmark = pytest.mark.servers
GAME = Game(runs=6, sites=2, commands=5, seed=12)
FAULTS = (
    at_point("before_commit", "kill"),
    at_point("after_publish", "kill"),
    at_point("after_answer", "freeze"),
    *(fault for fault in AT_RANDOM if fault.kind == "restart mosquitto"),
)
LIMIT_S = 900.0


def test_runs_are_carried_out_exactly_once_while_what_carries_them_dies_and_freezes(tmp_path: Path) -> None:
    tmp_path.chmod(0o755)
    verdict = play(tmp_path, GAME, FAULTS, LIMIT_S)
    assert verdict.wrong == [], verdict.story
    assert (verdict.once, verdict.faults) == (GAME.runs * GAME.commands, len(FAULTS))
    assert verdict.silences.keys() == {fault.kind for fault in FAULTS}
