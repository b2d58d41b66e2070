"""How a web process keeps memory that it no longer needs."""

from __future__ import annotations

import ctypes

_TRIM_THRESHOLD, _MMAP_THRESHOLD = -1, -3
"""Numbers of `mallopt` in glibc's malloc.h."""
LARGE_BYTES = 64 * 1024


def give_back_large_blocks() -> bool:
    """Have each large block of memory be one of its own, which goes back to the system once it is freed.

    By itself glibc raises what it calls large up to 32 MB, as blocks are freed. Then messages of a megabyte lie between
    small objects that stay, and a process that was sent a flood of them keeps that memory for good. Returns whether
    there was anything to set: other C libraries do not do so.
    """
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)
    if mallopt is None:
        return False
    return all(mallopt(what, LARGE_BYTES) for what in (_MMAP_THRESHOLD, _TRIM_THRESHOLD))
