"""Pure: what a robot says that it carries, in its property `load`."""

from __future__ import annotations

import re

PARTING = ",;:="
"""No name of a load has one of these signs in what a robot says that it carries."""
_LOAD = re.compile(rf"([^{PARTING}]{{1,64}})[:=]\s*(\d{{1,6}})(?!\d)")


def read_load(value: object) -> dict[str, int]:
    """Read what a robot carries: text such as `box:1,can:2`; nothing of anything else."""
    if not isinstance(value, str):
        return {}
    return {name: int(count) for said, count in _LOAD.findall(value) if int(count) and (name := said.strip())}
