"""What the lines of a log belong to: the run, the command, the request that a thread is at, bound while it is at it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Literal, get_args

LogId = Literal["request", "site", "program", "run", "step", "command", "device"]
NAMES: tuple[LogId, ...] = get_args(LogId)
_bound: ContextVar[Mapping[LogId, str]] = ContextVar("log_ids", default={})  # noqa: B039 - never changed in place


def add_ids(ids: Mapping[LogId, object]) -> None:
    """Bind ids until the `bind_ids` around this ends; empty ones are left out."""
    _bound.set({**_bound.get(), **{name: str(value) for name, value in ids.items() if value not in (None, "")}})


@contextmanager
def bind_ids(ids: Mapping[LogId, object]) -> Iterator[None]:
    """Bind ids to all that is logged within the block, by this thread and by what it awaits."""
    token = _bound.set(_bound.get())
    try:
        add_ids(ids)
        yield
    finally:
        _bound.reset(token)


def bound_ids() -> Mapping[LogId, str]:
    """Return the ids that are bound now."""
    return _bound.get()
