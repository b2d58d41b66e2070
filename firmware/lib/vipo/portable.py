"""What MicroPython and CPython do differently: clocks, closing a connection, showing an error; and a file written safely."""

import asyncio
import gc
import os
import sys
import time

CLOSING_S = 1
UNIX_AND_CHIP_S = 946684800
CLOCK_IS_SET_S = 1700000000

try:
    from time import ticks_diff, ticks_ms
except ImportError:

    def ticks_ms():
        """Return milliseconds of a clock that only goes forward."""
        return int(time.monotonic() * 1000)

    def ticks_diff(later, earlier):
        """Return how many milliseconds lie between two ticks."""
        return later - earlier


def seconds_since(ticks):
    """Return the seconds since an earlier `ticks_ms()`; right for up to six days on the chip."""
    return ticks_diff(ticks_ms(), ticks) / 1000


def unix_time():
    """Return seconds since 1970; the chip's clock counts from 2000."""
    return int(time.time()) + (UNIX_AND_CHIP_S if time.gmtime(0)[0] == 2000 else 0)


def clock_is_set():
    """Tell whether the clock shows a day that can be today."""
    return unix_time() > CLOCK_IS_SET_S


def write_file(path, content):
    """Write a text so that a power cut leaves the old one or the new one."""
    with open(path + ".new", "w") as file:
        file.write(content)
    os.rename(path + ".new", path)


async def close_stream(writer):
    """Close a connection at once: MicroPython's `close()` alone leaves the socket open."""
    try:
        writer.close()
        await asyncio.wait_for(writer.wait_closed(), CLOSING_S)
    except (OSError, EOFError, ValueError, MemoryError, asyncio.TimeoutError):
        pass  # it is gone already, or goes when it is collected
    gc.collect()


def forget(*names):
    """Let modules of this package go that are not needed any more: their code takes room on the chip."""
    import vipo

    for name in names:
        if sys.implementation.name == "micropython" and sys.modules.pop("vipo." + name, None):
            delattr(vipo, name)
    gc.collect()


def load(*names):
    """Import modules of this package one by one: loaded within each other they would leave the heap full of holes."""
    for name in names:
        gc.collect()
        __import__("vipo." + name)
    gc.collect()


def show_error(error):
    """Write an unexpected error with its lines to the console."""
    if hasattr(sys, "print_exception"):
        sys.print_exception(error)
    else:
        sys.excepthook(type(error), error, error.__traceback__)
