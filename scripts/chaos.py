"""Runs while all beneath them is killed, frozen, flushed, restarted and cut off: `python -m scripts.chaos --help`.

Prints a JSON line after each fault and one for each seed; ends with 1 where a command was not carried out exactly
once, in order, or a run was lost or stuck. Starts PostgreSQL, Redis, Mosquitto and all processes of its own.
"""

from __future__ import annotations

import argparse
import functools
import json
import os
import signal
import sys
import tempfile
from dataclasses import asdict
from pathlib import Path
from typing import Any

import django

os.environ["DJANGO_SETTINGS_MODULE"] = "tests.settings"
django.setup()  # what starts the servers imports models; the processes are told their own settings
del os.environ["DJANGO_SETTINGS_MODULE"]

from tests.integration.breaking.chaos.faults import AT_RANDOM, NAMED, choose  # noqa: E402 - Django is set up first
from tests.integration.breaking.chaos.game import play  # noqa: E402
from tests.integration.breaking.chaos.hall import STEPS_MOST, Game  # noqa: E402

MOST_SHOWN, RUNS_A_FAULT = 20, 8
FAULTS = len(NAMED) + len(AT_RANDOM)


def main() -> int:
    """Play a game for each seed; return the exit code."""
    told = _read_arguments()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # and everything that was started ends with it
    is_well = True
    for seed in told.seed:
        game = Game(told.runs, told.sites, told.commands, seed)
        faults = list(choose(seed, told.faults or max(FAULTS, told.runs // RUNS_A_FAULT)))
        with tempfile.TemporaryDirectory(prefix="vipo-chaos-") as name:
            folder = Path(name)
            folder.chmod(0o755)
            verdict = play(folder, game, faults, told.limit, functools.partial(_say, seed=seed))
        is_well &= not verdict.wrong
        sys.stderr.write(verdict.story)
        shown = {key: value for key, value in asdict(verdict).items() if key != "story"}
        if len(verdict.wrong) > MOST_SHOWN:
            shown["wrong"] = [*verdict.wrong[:MOST_SHOWN], f"and {len(verdict.wrong) - MOST_SHOWN} more"]
        _say(asdict(game) | {"of": game.runs * game.commands} | shown)
    return 0 if is_well else 1


def _read_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=1000)
    parser.add_argument("--sites", type=int, default=3)
    parser.add_argument("--commands", type=int, default=5, help=f"of each run, fewer than {STEPS_MOST}")
    parser.add_argument("--seed", type=int, nargs="+", default=[1, 2, 3], help="one game for each")
    parser.add_argument("--faults", type=int, help=f"how many; at least {FAULTS}, each once, and one for 8 runs")
    parser.add_argument("--limit", type=float, default=3600.0, help="seconds for a game; then it is said to be stuck")
    return parser.parse_args()


def _say(line: dict[str, Any], **more: Any) -> None:
    sys.stdout.write(json.dumps(more | line) + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    sys.exit(main())
