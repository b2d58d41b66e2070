"""What a test of a program is: what is given, how it is rehearsed, and what then holds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from simulation.world import Fault
from vipo_device.protocol.description import Scalar

ExpectationKind = Literal["ends", "fails", "within_s", "item", "never_two_in", "commands", "property", "step"]
Counts = Mapping[str, Mapping[str, int]]


@dataclass(frozen=True, slots=True)
class Expectation:
    """Something that holds in a rehearsal; `says` is what stands in the file, `line` where."""

    kind: ExpectationKind
    line: int
    says: Any


@dataclass(frozen=True, slots=True)
class Trial:
    """One test; steps are named as people see them (7b) or by their ids, until the program is known."""

    name: str
    line: int
    then: tuple[Expectation, ...]
    seed: int = 0
    driver: Literal["physics", "kinematic"] = "kinematic"
    limit_s: float = 4 * 3600.0
    parameters: Mapping[str, Scalar] = field(default_factory=dict)
    faults: tuple[Fault, ...] = ()
    faults_line: int = 0
    stocks: Counts = field(default_factory=dict)
    carrying: Counts = field(default_factory=dict)
    readings: Mapping[str, Mapping[str, Scalar]] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class TrialFile:
    """A file of tests; `program` and `site` are paths seen from it, `site` empty where the program names its own."""

    program: str
    site: str
    trials: tuple[Trial, ...]
