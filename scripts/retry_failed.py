"""Tries what failed in `make test` once more, one after the other, with nothing else running.

Three processes of tests share two cores there, and some tests wait for real servers, browsers and clocks. What fails
again has failed. Many failures are no matter of a busy machine and are not tried again.
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

FAILED = Path(".pytest_cache/v/cache/lastfailed")
MOST = 12


def main() -> int:
    """Return 0 if every test that failed passes alone."""
    failed = sorted(json.loads(FAILED.read_text())) if FAILED.exists() else []
    if not 1 <= len(failed) <= MOST:
        _say(f"{len(failed)} tests failed; only 1 to {MOST} are tried again.")
        return 1
    _say(
        f"{len(failed)} of all tests failed beside the others and are tried once more, alone.",
        "Whichever passes now depends on what runs beside it: please look into it.",
        *failed,
    )
    command = [sys.executable, "-m", "pytest", "--tb=native", "--durations=0", "-p", "no:cacheprovider", *failed]
    return subprocess.run(command, check=False).returncode  # noqa: S603 - our own tests' names


def _say(*lines: str) -> None:
    sys.stdout.write("\n  ".join(lines) + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    sys.exit(main())
