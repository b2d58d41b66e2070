"""What the devices' log says of a game: what was lost, doubled, out of order, and how long nobody did anything."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from tests.integration.breaking.chaos.hall import STEPS_MOST, Game

Line = Mapping[str, Any]


def find_faults(game: Game, log: Sequence[Line], statuses: Mapping[int, str]) -> list[str]:
    """Return a sentence for each thing that is not as it should be; `statuses` are the runs' in the database."""
    shown = {run: statuses.get(run, "not there") for run in range(game.runs)}
    unfinished = [f"run {run} is {status}" for run, status in shown.items() if status != "finished"]
    return [*_find_counts(game, log), *_find_disorder(game, log), *_find_overlaps(log), *unfinished]


def _find_counts(game: Game, log: Sequence[Line]) -> Iterator[str]:
    wanted = {value: device for run in range(game.runs) for device, value in game.steps_of(run)}
    for word in ("begin", "end"):
        counted = Counter(line["value"] for line in log if line["is"] == word)
        for value, device in wanted.items():
            if counted[value] != 1:
                ids = sorted({line["id"] for line in log if line["value"] == value})
                yield f"{_name(value)} on {device}: {counted[value]} times {word}, commands {ids}"
        yield from (f"{_name(value)} was never asked for" for value in counted if value not in wanted)
    for line in log:
        if wanted.get(line["value"], line["device"]) != line["device"]:
            yield f"{_name(line['value'])} was done by {line['device']}"


def _find_disorder(game: Game, log: Sequence[Line]) -> Iterator[str]:
    done: defaultdict[int, list[tuple[int, str]]] = defaultdict(list)
    for line in log:
        run, step = divmod(line["value"], STEPS_MOST)
        done[run].append((step, line["is"]))
    for run in range(game.runs):
        once = list(dict.fromkeys(done[run]))
        if once != sorted(once):
            yield f"run {run} was done in the order {once}"


def _find_overlaps(log: Sequence[Line]) -> Iterator[str]:
    busy: dict[str, int] = {}
    for line in log:
        if line["is"] == "begin" and line["device"] in busy:
            yield f"{line['device']} began {_name(line['value'])} in the midst of {_name(busy[line['device']])}"
        if line["is"] == "begin":
            busy[line["device"]] = line["value"]
        else:
            busy.pop(line["device"], None)


def _name(value: int) -> str:
    return "step {1} of run {0}".format(*divmod(value, STEPS_MOST))


def count_once(game: Game, log: Sequence[Line]) -> int:
    """Return how many of the commands were begun and ended exactly once."""
    counted = Counter((line["value"], line["is"]) for line in log)
    values = (value for run in range(game.runs) for _, value in game.steps_of(run))
    return sum(counted[value, "begin"] == counted[value, "end"] == 1 for value in values)


def longest_silences(game: Game, log: Sequence[Line], faults: Sequence[Line]) -> dict[str, float]:
    """Return for each kind of fault how long a site that had work did nothing, in seconds, the longest time.

    A line of `faults` has its `kind`, when it began (`at`) and was over (`until`), and how many runs might be started.
    """
    found: dict[str, float] = {}
    for fault in faults:
        for site in game.slugs:
            gap = _longest_gap([line for line in log if line["device"].startswith(f"{site}.")], fault, game, site)
            found[fault["kind"]] = round(max(found.get(fault["kind"], 0.0), gap), 2)
    return found


def _longest_gap(log: Sequence[Line], fault: Line, game: Game, site: str) -> float:
    wanted = game.count_at(site, fault["runs"]) * game.commands
    ended = sum(line["is"] == "end" and line["at"] < fault["at"] for line in log)
    last, longest = fault["at"], 0.0
    for line in log:
        if fault["at"] <= line["at"] <= fault["until"] and ended < wanted:
            longest, last = max(longest, line["at"] - last), line["at"]
            ended += line["is"] == "end"
    return max(longest, fault["until"] - last) if ended < wanted else longest
