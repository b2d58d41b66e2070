"""Values that never change and are made in great numbers: it is mypy that sees to it that nobody changes one."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import TypeVar

Value = TypeVar("Value")


def dataclass(*, frozen: bool = False, slots: bool) -> Callable[[type[Value]], type[Value]]:
    """Make a class what `dataclasses.dataclass` makes it, but for its objects' refusal to be changed.

    For that refusal each field is set by a call, which takes several times as long as setting it (docs/adr/0011).
    Meant to be imported in the place of `dataclasses.dataclass` where mypy does not look, so that mypy knows of no
    difference.
    """
    return dataclasses.dataclass(slots=slots, unsafe_hash=frozen)
