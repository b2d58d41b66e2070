"""Python's collector of circles, which only costs time where a great many objects are made and none is in a circle."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def without_collector() -> Iterator[None]:
    """Make objects without looking for circles among them; memory is given back by counting references as ever.

    It looks through all that is new again and again while a large tree grows, for up to a quarter of the time of
    reading a script (docs/adr/0012).
    """
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()
