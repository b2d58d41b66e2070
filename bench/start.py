"""How long the demo takes from its command to a page that answers, the second time."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from tests.kit.demo import running_demo


def measure() -> Iterator[dict[str, object]]:
    with tempfile.TemporaryDirectory() as folder:
        for attempt in ("first, with an empty database", "second"):
            began = time.perf_counter()
            with running_demo(Path(folder) / "state", speed=1):
                yield {"what": "demo start", "attempt": attempt, "seconds": round(time.perf_counter() - began, 2)}
