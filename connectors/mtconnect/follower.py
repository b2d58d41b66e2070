"""Following an agent: its probe, how it is, then what it says from number to number; in a thread of its own."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass
from threading import Event
from time import monotonic

from connectors.mtconnect.agent import Agent, AgentAway
from connectors.mtconnect.documents import BadDocument, Devices, Document, Machine, Observation, Refusal, Streams

log = logging.getLogger(__name__)
COUNT = 1_000
PROBE_AGAIN_S = 60.0
"""An agent may get machines without beginning anew; so its probe is looked at now and then."""
MOST_PAUSE_S = 60.0
GONE_AFTER = 3
MOST_HURRIES = 20
"""So often it is asked without a pause between, by one who is behind."""


@dataclass(frozen=True, slots=True)
class MachinesListed:
    """The agent's machines are these."""

    machines: tuple[Machine, ...]


@dataclass(frozen=True, slots=True)
class Observed:
    """The agent said this; `is_whole` when it replaces all that was known."""

    observations: tuple[Observation, ...]
    is_whole: bool


@dataclass(frozen=True, slots=True)
class AgentLost:
    """The agent has not answered several times in a row."""


AgentEvent = MachinesListed | Observed | AgentLost


class Restarted(Exception):
    """The agent has begun a new life: its numbers mean nothing any more."""


class Follower:
    """Asks an agent again and again, and gives what it hears to `hear`."""

    def __init__(self, agent: Agent, interval_s: float, hear: Callable[[AgentEvent], None]) -> None:
        self._agent, self._interval_s, self._hear = agent, interval_s, hear
        self._instance: int | None = None
        self._machines: tuple[Machine, ...] = ()
        self._next, self._count = 0, COUNT
        self._probed_s = 0.0
        self._failures = self._hurries = 0

    def run(self, stopping: Event) -> None:
        """Follow until `stopping` is set."""
        while not stopping.wait(self._follow()):
            pass

    def _follow(self) -> float:
        """Ask once, and return how long to wait before asking again, in seconds."""
        try:
            has_more = self._step()
        except Restarted:
            self._instance = None
            return self._fail("it has begun anew")
        except (AgentAway, BadDocument) as error:
            return self._fail(str(error))
        if self._failures:
            log.warning("The agent answers again.")
        self._failures = 0
        self._hurries = self._hurries + 1 if has_more else 0
        return 0.0 if has_more and self._hurries % MOST_HURRIES else self._interval_s

    def _fail(self, why: str) -> float:
        self._failures += 1
        pause_s = min(self._interval_s * 2.0 ** min(self._failures - 1, 12), MOST_PAUSE_S)
        if self._failures in {1, GONE_AFTER}:
            log.warning("The agent cannot be read (%s). It is asked again, up to %d s apart.", why, MOST_PAUSE_S)
        if self._failures == GONE_AFTER:
            self._instance = None
            self._hear(AgentLost())
        return pause_s

    def _step(self) -> bool:
        """Ask what is due; True when there is more to be had at once."""
        if self._instance is None or monotonic() - self._probed_s >= PROBE_AGAIN_S:
            return self._probe()
        return self._sample(self._instance)

    def _probe(self) -> bool:
        document = self._agent.ask("probe")
        if not isinstance(document, Devices):
            raise BadDocument("The agent answers `probe` with something else.")
        instance = document.header.instance
        is_new = self._instance is None or document.machines != self._machines
        self._probed_s, self._machines = monotonic(), document.machines
        if is_new or instance != self._instance:
            self._instance = None
            self._hear(MachinesListed(document.machines))
            self._current(instance)
        return True

    def _current(self, instance: int) -> None:
        """Take in how all is, and where to go on; from then on it is this life of the agent that is followed."""
        document = self._ask("current", instance)
        if not isinstance(document, Streams):
            raise BadDocument(_why(document, "current"))
        self._instance, self._next = instance, max(document.header.next, 1)
        self._count = min(COUNT, document.header.size or COUNT)  # more than it keeps may not be asked for
        self._hear(Observed(document.observations, is_whole=True))

    def _sample(self, instance: int) -> bool:
        document = self._ask("sample", instance, **{"from": self._next, "count": self._count})
        if isinstance(document, Refusal) and "OUT_OF_RANGE" in document.codes:
            return self._fill_gap(instance)
        if not isinstance(document, Streams):
            raise BadDocument(_why(document, "sample"))
        header = document.header
        if header.first > self._next or header.next < self._next:
            return self._fill_gap(instance)
        has_more = self._next < header.next <= header.last
        self._next = header.next
        self._hear(Observed(document.observations, is_whole=False))
        return has_more

    def _fill_gap(self, instance: int) -> bool:
        log.warning("The agent does not keep what it said since number %d; it is asked how all is.", self._next)
        self._current(instance)
        return False

    def _ask(self, call: str, instance: int, **query: int) -> Document:
        document = self._agent.ask(call, **query)
        if document.header.instance != instance:
            raise Restarted
        return document


def _why(document: Document, call: str) -> str:
    if isinstance(document, Refusal):
        return f"The agent refuses `{call}`: {', '.join(document.codes)[:80]} {document.sentence}"
    return f"The agent answers `{call}` with something else."
