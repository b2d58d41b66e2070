"""Pure: what a robot says that it carries, in its property `load`."""

from __future__ import annotations

import re

_LOAD = re.compile(r"([A-Za-z0-9_.-]+)\s*[:=]\s*(\d{1,6})")


def read_load(value: object) -> dict[str, int]:
    """Read what a robot carries: text such as `box:1,can:2`; nothing of anything else."""
    return {name: int(count) for name, count in _LOAD.findall(value) if int(count)} if isinstance(value, str) else {}
