"""What Python's garbage collector goes through in a web process."""

from __future__ import annotations

import gc

from django.urls import get_resolver


def leave_out_what_stays() -> None:
    """Have collections pass over all that is loaded now, the pages' addresses included.

    It is a quarter of a million objects, which stay until the process ends. To go through them stops all threads and
    the event loop for 0.13 s, each time that somebody opens a large program, among others.
    """
    _ = get_resolver().url_patterns
    gc.collect()
    gc.freeze()
