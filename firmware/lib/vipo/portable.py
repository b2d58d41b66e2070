"""What MicroPython's and CPython's clocks call differently."""

import time

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
