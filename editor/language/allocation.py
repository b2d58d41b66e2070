"""How the many small objects of a large program are made quickly: two ways around what Python does for each of them."""

from __future__ import annotations

import dataclasses
import gc
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TypeVar

Value = TypeVar("Value")


def dataclass(*, frozen: bool = False, slots: bool) -> Callable[[type[Value]], type[Value]]:
    """Make a class what `dataclasses.dataclass` makes it; it is mypy alone that sees to it that nobody changes a value.

    A class that refuses changes itself sets each field by a call, which takes several times as long as setting it
    (docs/adr/0011).
    To be imported in the place of `dataclasses.dataclass` where mypy does not look, so that mypy knows of no
    difference.
    """
    return dataclasses.dataclass(slots=slots, unsafe_hash=frozen)


@contextmanager
def paused_collector() -> Iterator[None]:
    """Make objects without a search for cycles among them; reference counts free memory as ever.

    The collector looks through all that is new again and again while a large tree grows, for up to a quarter of the
    time of reading a script (docs/adr/0012).
    """
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()
