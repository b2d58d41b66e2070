"""Runs of the demo as archives have them, and in decisions.json what the machine decided at each of their inputs."""

from __future__ import annotations

import hashlib
from pathlib import Path

from execution.engine.replayed import replay_runs

FOLDER = Path(__file__).parent


def decisions_of(file: Path) -> list[str]:
    """Return a digest of what today's machine makes of each input of a file's runs: its actions, and its state."""
    with file.open("rb") as archive:
        runs = list(replay_runs(archive))
    decisions = [decision for run in runs for decision in run.decisions]
    return [hashlib.sha256(f"{each.actions!r}\n{each.state}".encode()).hexdigest()[:16] for each in decisions]
