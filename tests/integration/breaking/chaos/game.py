"""A game from its first run to the verdict."""

from __future__ import annotations

import functools
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from random import Random
from typing import Any

from tests.integration.breaking.chaos import judge
from tests.integration.breaking.chaos.clocks import can_shift
from tests.integration.breaking.chaos.faults import PATIENCE_S, Fault, Stuck, pause, wait
from tests.integration.breaking.chaos.hall import Game
from tests.integration.breaking.chaos.plant import Plant, running_plant

START_S, SETTLE_S = 300.0, 3.0
"""So long the processes may take to be there, and so long nothing more may happen once all is done."""


@dataclass
class Verdict:
    """What came of a game; `wrong` is empty when all is well."""

    once: int
    wrong: list[str]
    silences: dict[str, float]
    seconds: float
    restarts: dict[str, int]
    clocks_apart: bool
    faults: int = 0
    story: str = field(default="", repr=False)


def _keep_quiet(_line: dict[str, Any]) -> None:
    """Say nothing."""


def play(
    folder: Path,
    game: Game,
    faults: Sequence[Fault],
    limit_s: float,
    say: Callable[[dict[str, Any]], None] = _keep_quiet,
) -> Verdict:
    """Play a game: with each fault a share of the runs is started, and the next one waits until all sites go on."""
    began = time.monotonic()
    told: list[dict[str, Any]] = []
    stuck: list[str] = []
    with running_plant(folder, game) as plant:
        try:
            for each in _go_through(plant, faults, began + limit_s):
                told.append(each)
                say({key: each[key] for key in ("kind", "took_s", "done")})
        except Stuck as why:
            stuck.append(str(why))
        log = plant.read_log()
        wrong = [*stuck, *judge.find_faults(game, log, plant.statuses())]
        return Verdict(
            once=judge.count_once(game, log),
            wrong=wrong,
            silences=judge.longest_silences(game, log, told),
            seconds=round(time.monotonic() - began, 1),
            restarts=plant.restarts,
            clocks_apart=can_shift(),
            faults=len(told),
            story=plant.story() if wrong else "",
        )


def _go_through(plant: Plant, faults: Sequence[Fault], until: float) -> Iterator[dict[str, Any]]:
    """Carry out the faults, one for each item, then wait for the end."""
    course, chance = _Course(plant, until), Random(plant.game.seed)
    course.warm_up()
    for number, fault in enumerate(faults, 1):
        yield course.carry_out(fault, plant.game.runs * number // len(faults), chance)
    course.finish()


class _Course:
    """The faults one after the other, each beside work under way."""

    def __init__(self, plant: Plant, until: float) -> None:
        self._plant, self._until = plant, until

    def warm_up(self) -> None:
        """Wait until all processes are there: the first run of each site goes on."""
        self._plant.allow(self._plant.game.sites)
        self._wait("the first command of each site", lambda: all(map(self._begun, self._plant.game.slugs)), START_S)

    def carry_out(self, fault: Fault, runs: int, chance: Random) -> dict[str, Any]:
        if time.monotonic() > self._until:
            raise Stuck("The time was over before all faults had happened")
        plant = self._plant
        if fault.arms:
            (plant.faults / fault.arms).write_text(fault.kind.partition(" ")[0])
        before, at = len(plant.read_log()), time.monotonic()
        plant.allow(max(runs, plant.game.sites, plant.wanted))
        if not fault.arms and self._open():
            self._wait(f"work before {fault.kind}", lambda: len(plant.read_log()) > before)
        fault.carry_out(plant, chance)
        healed = time.monotonic()
        waiting = set(self._open())
        self._wait(f"work at {sorted(waiting)} after {fault.kind}", lambda: not (waiting & self._silent_since(healed)))
        done = len([line for line in plant.read_log() if line["is"] == "end"])
        if bad := [
            f"run {run} has {status}" for run, status in plant.statuses().items() if status.startswith("failed")
        ]:
            raise Stuck(f"After {fault.kind}: {'; '.join(bad[:3])}")
        ended = time.monotonic()
        return {"kind": fault.kind, "at": at, "until": ended, "took_s": round(ended - at, 1), "done": done,
                "runs": plant.wanted}  # fmt: skip

    def finish(self) -> None:
        plant = self._plant
        plant.allow(plant.game.runs)
        while (before := self._left()) > 0:  # whatever is left, something has to move
            self._wait(f"the end of {before} commands", functools.partial(self._is_less, before))
        self._wait("the end of all runs", self._all_over)
        pause(plant, SETTLE_S)

    def _left(self) -> int:
        ended = [line for line in self._plant.read_log() if line["is"] == "end"]
        return self._plant.game.runs * self._plant.game.commands - len(ended)

    def _is_less(self, before: int) -> bool:
        return self._left() < before

    def _all_over(self) -> bool:
        statuses = self._plant.statuses()
        open_ones = ("pending", "running", "paused")
        return len(statuses) == self._plant.game.runs and not any(s.startswith(open_ones) for s in statuses.values())

    def _begun(self, site: str) -> bool:
        return any(line["device"].startswith(f"{site}.") for line in self._plant.read_log())

    def _open(self) -> list[str]:
        """Return the sites with commands still to be begun, of runs that may have been started."""
        game, begun = self._plant.game, dict.fromkeys(self._plant.game.slugs, 0)
        for line in self._plant.read_log():
            begun[line["device"].partition(".")[0]] += line["is"] == "begin"
        return [s for s in game.slugs if begun[s] < game.count_at(s, self._plant.wanted) * game.commands]

    def _silent_since(self, at: float) -> set[str]:
        """Return the sites that have work and have begun nothing since then."""
        lines = (line for line in self._plant.read_log() if line["at"] > at and line["is"] == "begin")
        heard = {line["device"].partition(".")[0] for line in lines}
        return set(self._open()) - heard

    def _wait(self, what: str, ready: Callable[[], bool], limit_s: float = PATIENCE_S) -> None:
        wait(self._plant, what, ready, min(limit_s, max(self._until - time.monotonic(), 1.0)))
