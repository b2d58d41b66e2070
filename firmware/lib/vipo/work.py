"""A piece of work that takes time and can be held, let go on, and cancelled."""

import asyncio

from vipo.portable import ticks_diff, ticks_ms

STEP_S = 0.1


class Cancelled(Exception):
    """Somebody asked for the end of this work."""


class Failure(Exception):
    """The machine could not do it; the text says why."""


class Work:
    """The command that is carried out now; `speed` makes a second of the process shorter than one of the clock."""

    def __init__(self, command, speed, is_stopped, output):
        self.command = command
        self.speed = speed
        self.paused = False
        self.cancelled = False
        self._is_stopped = is_stopped
        self._output = output

    async def spend(self, seconds, progress=None):
        """Let `seconds` of work pass with the output on; `progress(fraction, elapsed_s)` is called on the way.

        While the work is held the output is off and no time passes; it is off when this ends, however it ends.
        """
        try:
            await self._spend(seconds, progress, True)
        finally:
            self._output(False)

    async def rest(self, seconds):
        """Let `seconds` of work pass with the output off."""
        await self._spend(seconds, None, False)

    async def _spend(self, seconds, progress, on):
        elapsed, last = 0.0, ticks_ms()
        while elapsed < seconds:
            held = self.paused or self._is_stopped()
            self._output(on and not held)
            await asyncio.sleep(min(STEP_S, max(0.001, (seconds - elapsed) / self.speed)))
            now = ticks_ms()
            step, last = ticks_diff(now, last) / 1000 * self.speed, now
            if self.cancelled:
                raise Cancelled
            if held or self.paused or self._is_stopped():
                continue
            elapsed = min(seconds, elapsed + step)
            if progress:
                progress(elapsed / seconds, step)
