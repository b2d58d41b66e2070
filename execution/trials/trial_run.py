"""One test carried out: the program rehearsed as the test says, and what was expected held against it."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, replace

from editor.language import PlaceFacts, ZoneFacts
from editor.language.plan.instructions import Plan
from execution.machine import messages as r
from execution.rehearsals.rehearsal import Conditions, Follow, rehearse
from execution.trials.coverage import Coverage
from execution.trials.expectations import Seen, Verdict, judge
from execution.trials.trial import Expectation, Trial
from execution.trials.yaml_lines import BadTrialFile
from simulation.fault_form import BadFaults, check_faults, suits
from simulation.world import Scene
from vipo_device.protocol.description import Description, Scalar


@dataclass(frozen=True, slots=True)
class Subject:
    """The program under test in its site; `numbers` has the number of each step, `lines` the script.

    `zones` are those of the site's floor; the program's own are in its plan.
    """

    plan: Plan
    scene: Scene
    places: tuple[PlaceFacts, ...]
    numbers: Mapping[str, str]
    lines: tuple[str, ...]
    zones: tuple[ZoneFacts, ...] = ()

    def outlines(self) -> dict[str, tuple[tuple[float, float], ...]]:
        """Return the outlines of all zones by their names and ids; the program's own come first."""
        named = [(z.id, z.name, z.points) for z in self.zones] + [(z.id, z.name, z.points) for z in self.plan.zones]
        return {name: points for _, name, points in named} | {zone: points for zone, _, points in named}


@dataclass(frozen=True, slots=True)
class Outcome:
    """How a test ended."""

    trial: Trial
    verdicts: tuple[Verdict, ...]
    duration_s: float
    coverage: Coverage
    said: tuple[str, ...]
    """What went wrong in the rehearsal, whether expected or not."""

    @property
    def ok(self) -> bool:
        """True when all that was expected holds."""
        return all(verdict.ok for verdict in self.verdicts)


class _Watcher:
    """Hands to the coverage what the run does, and keeps what machines hold at the end."""

    def __init__(self, plan: Plan) -> None:
        self.coverage = Coverage(plan)
        self.stocks: Mapping[str, Mapping[str, int]] = {}

    def carried(self, thread: int, at: int, to: int) -> None:
        self.coverage.carried(thread, at, to)

    def did(self, action: r.Action) -> None:
        if isinstance(action, r.StepEntered):
            self.coverage.did(action.step)
        elif isinstance(action, r.StepFailed):
            self.coverage.did(action.step, action.kind)

    def ended(self, stocks: Mapping[str, Mapping[str, int]]) -> None:
        self.stocks = stocks
        self.coverage.end()


def settle(trial: Trial, subject: Subject) -> Trial:
    """Return the test with steps by their ids; raises BadTrialFile for what the program or the site does not have."""
    faults = tuple(replace(f, step=_step(f.step, subject, trial.faults_line)) if f.step else f for f in trial.faults)
    try:
        check_faults(faults, subject.scene.devices, _steps(subject.plan))
    except BadFaults as error:
        raise BadTrialFile(trial.faults_line, error.detail) from error
    _check_given(trial, subject)
    return replace(trial, faults=faults, then=tuple(_settled(each, subject) for each in trial.then))


def run_trial(trial: Trial, subject: Subject, limit_s: float | None = None, follow: Follow | None = None) -> Outcome:
    """Carry out a settled test; `limit_s` ends it sooner than it says itself, `follow` is told how far it is."""
    watcher = _Watcher(subject.plan)
    conditions = Conditions(trial.driver, trial.parameters, limit_s or trial.limit_s, watcher)
    scene = _scene(trial, subject.scene)
    result = rehearse(
        subject.plan, scene, places=subject.places, zones=subject.zones, conditions=conditions, follow=follow
    )
    places = {place.id: (place.x, place.y) for place in subject.places}
    places |= {d.id: (d.pose.x, d.pose.y) for d in subject.scene.devices if d.kind == "machine"}
    seen = Seen(result, watcher.stocks, subject.outlines(), places, subject.numbers)
    verdicts = tuple(judge(expectation, seen) for expectation in trial.then)
    said = tuple(f"{e['t']:g} s: {e['message']}" for e in result["errors"])
    return Outcome(trial, verdicts, result["duration_s"], watcher.coverage, said)


def _scene(trial: Trial, scene: Scene) -> Scene:
    readings: dict[str, dict[str, Scalar]] = {device: dict(values) for device, values in scene.readings.items()}
    for device, values in trial.readings.items():
        readings.setdefault(device, {}).update(values)
    return replace(
        scene, seed=trial.seed, faults=trial.faults, readings=readings, stocks={**scene.stocks, **trial.stocks},
        carrying={**scene.carrying, **trial.carrying},
    )  # fmt: skip


def _check_given(trial: Trial, subject: Subject) -> None:
    known = {d.id: d for d in subject.scene.devices}
    _check_devices((*trial.stocks, *trial.carrying, *trial.readings), known, trial.line)
    for table, kind, other in ((trial.stocks, "robot", "carrying"), (trial.carrying, "machine", "stock")):
        for device in table:
            if known[device].kind == kind:
                raise BadTrialFile(trial.line, f"{device} is a {kind}; write what it holds under “{other}”.")
    _check_readings(trial, known)
    for name in trial.parameters:
        if name not in subject.plan.parameters:
            raise BadTrialFile(
                trial.line, f"The program has no parameter “{name}”. {_there_are(subject.plan.parameters)}"
            )


def _check_readings(trial: Trial, known: Mapping[str, Description]) -> None:
    for device, values in trial.readings.items():
        for name, value in values.items():
            spec = known[device].property(name)
            if spec is None:
                raise BadTrialFile(trial.line, f"{device} has no property “{name}”.")
            if not suits(spec, value):
                raise BadTrialFile(trial.line, f"The reading {name} of {device} is a {spec.type}; {value!r} is none.")


def _settled(expectation: Expectation, subject: Subject) -> Expectation:
    """Look up what an expectation names."""
    says, line = expectation.says, expectation.line
    devices = {d.id: d for d in subject.scene.devices}
    if expectation.kind == "step":
        return replace(expectation, says={**says, "step": _step(says["step"], subject, line)})
    if expectation.kind == "commands":
        _check_devices([named.rpartition(".")[0] for named in says if "." in named], devices, line)
    if expectation.kind == "item":
        _check_devices([says["at"]], devices, line)
    if expectation.kind == "property":
        _check_devices([says["device"]], devices, line)
        if devices[says["device"]].property(says["name"]) is None:
            raise BadTrialFile(line, f"{says['device']} has no property “{says['name']}”.")
    if expectation.kind == "never_two_in":
        places = {place.id for place in subject.places} | {d for d in devices if devices[d].kind == "machine"}
        word, known = ("zone", set(subject.outlines())) if "zone" in says else ("place", places)
        if says[word] not in known:
            raise BadTrialFile(line, f"There is no {word} “{says[word]}”. {_there_are(known)}")
    return expectation


def _check_devices(named: Iterable[str], known: Collection[str], line: int) -> None:
    for device in named:
        if device not in known:
            raise BadTrialFile(line, f"There is no device “{device}” in the site. {_there_are(known)}")


def _step(named: str, subject: Subject, line: int) -> str:
    """Return the id of a step that is named by its number or its id."""
    known = _steps(subject.plan)
    if named in known:
        return named
    found = [step for step, number in subject.numbers.items() if number == named and step in known]
    if not found:
        numbers = [subject.numbers.get(step, step) for step in known]
        raise BadTrialFile(line, f"The program has no step “{named}”. {_there_are(numbers)}")
    return found[0]


def _steps(plan: Plan) -> set[str]:
    return {step for i in plan.instructions for step in (i.step, *i.enters) if step}


def _there_are(words: Iterable[str]) -> str:
    listed = sorted(words)
    return f"There are: {', '.join(listed[:40])}{', …' if len(listed) > 40 else ''}." if listed else "There is none."
