"""How the child processes of a worker's pool hear that their worker is to end, or is gone.

The settings ask for a pool of threads, which hear what their process hears. Started with `--pool processes` (where
`--pool prefork` is named Celery takes what the settings say) a worker carries sites out in child processes, to which
Celery says nothing before their tasks are over. So all of them share a pipe of which the worker alone has the writing
end: that it is closed is the word, also where nobody is left to say it.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from dataclasses import dataclass, field


@dataclass
class EndOfWorker:
    """The pipe between a worker and the children that it will fork."""

    _ends: tuple[int, int] | None = field(default=None)

    def prepare(self) -> None:
        """Make the pipe; called in the worker before it forks."""
        self._ends = os.pipe()

    def say(self) -> None:
        """Let all children know that the worker is to end; a second time changes nothing."""
        if self._ends is not None:
            reading, writing = self._ends
            self._ends = None
            os.close(writing)
            os.close(reading)

    def listen(self, leave: Callable[[], None]) -> None:
        """Call `leave` once the worker says so or is gone; called in a child, as soon as it is there."""
        if self._ends is None:
            return
        reading, writing = self._ends
        self._ends = None
        os.close(writing)

        def wait() -> None:
            os.read(reading, 1)
            os.close(reading)
            leave()

        threading.Thread(target=wait, name="end-of-worker", daemon=True).start()


end_of_worker = EndOfWorker()
"""That of this process."""
