"""Kill web processes while people draw, and judge what was called saved: `python -m scripts.room_kills 1000 [SEED]`.

Prints a JSON line after each kill. Starts PostgreSQL, Redis and two web processes of its own.
"""

from __future__ import annotations

import json
import os
import secrets
import sys
import tempfile
from contextlib import ExitStack
from dataclasses import asdict
from pathlib import Path

import django

os.environ.setdefault("DJANGO_SETTINGS_MODULE", "tests.settings")
django.setup()

from tests.integration.editor.kills.rounds import Judged, play  # noqa: E402 - Django is set up first
from tests.integration.editor.web_pairs import running_pair  # noqa: E402
from tests.kit.databases import migrate  # noqa: E402
from tests.kit.servers import run_postgres, run_redis  # noqa: E402


def main() -> int:
    """Play the rounds that the command line asks for; return the exit code."""
    rounds, seed = int(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else secrets.randbelow(10**6)
    judged = Judged()
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        postgres, redis = stack.enter_context(run_postgres(folder)), stack.enter_context(run_redis(folder))
        migrate(postgres.url, folder)
        pair = stack.enter_context(running_pair(folder, postgres.url, redis))
        for judged in play(pair, rounds, seed):
            sys.stdout.write(json.dumps({"seed": seed, **asdict(judged)}) + "\n")
            sys.stdout.flush()
    return 1 if judged.lost else 0


if __name__ == "__main__":
    sys.exit(main())
