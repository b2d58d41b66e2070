"""Faults as data: read with suspicion, lifted to this version; each refusal names the fault and the word."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from math import inf
from typing import Any, Final

from simulation.world import Fault, FaultKind
from vipo_device.protocol.batteries import says_charge
from vipo_device.protocol.description import Description, PropertySpec, Scalar
from vipo_device.protocol.errors import VipoError

VERSION: Final = 1
LADDER: Final[Mapping[int, Callable[[dict[str, Any]], dict[str, Any]]]] = {}
"""For each older version what makes the next one of it; the first version has none before it."""
MOST_FAULTS: Final = 100
LONGEST_S: Final = 7 * 24 * 3600.0
MOST_CHARACTERS: Final = 200
KIND_OF: Final[Mapping[str, FaultKind]] = {
    "fails": "fail_next", "stops": "stop", "silent": "offline", "dead": "dead", "deaf": "deaf", "late": "late",
    "answer_lost": "lose_ack", "answers_twice": "doubled", "wrong_value": "wrong_value", "drops": "drops",
    "battery": "battery", "obstacle": "obstacle",
}  # fmt: skip
"""The word for each kind of fault."""
_WORD_OF: Final = {kind: word for word, kind in KIND_OF.items()}
_LASTS: Final = frozenset({"stops", "silent", "dead", "deaf", "late", "wrong_value", "obstacle"})
_NEEDS: Final[Mapping[str, tuple[str, ...]]] = {
    "late": ("after_s",), "wrong_value": ("property", "value"), "battery": ("percent",), "obstacle": ("x", "y"),
}  # fmt: skip
_MAY: Final[Mapping[str, tuple[str, ...]]] = {"fails": ("error",), "obstacle": ("size_m",)}
_WHEN: Final = ("at_s", "at_step", "odds")
_RANGES: Final[Mapping[str, tuple[float, float]]] = {
    "at_s": (0.0, LONGEST_S), "for_s": (0.001, LONGEST_S), "after_s": (0.001, LONGEST_S), "odds": (1e-6, 1.0),
    "percent": (0.0, 100.0), "x": (-1e4, 1e4), "y": (-1e4, 1e4), "size_m": (0.01, 10.0),
}  # fmt: skip


class BadFaults(VipoError):
    """Faults that cannot be understood; `number` counts them from 1, 0: all of them."""

    code = "bad_faults"
    status = 422

    def __init__(self, why: str, number: int = 0) -> None:
        super().__init__(f"Fault {number}: {why}" if number else why, {"number": number})
        self.number = number


def read_faults(data: object) -> tuple[Fault, ...]:
    """Read `{"version": 1, "faults": […]}`; raises BadFaults."""
    if not isinstance(data, dict):
        raise BadFaults(f'Write the faults as {{"version": {VERSION}, "faults": […]}}.')
    version = data.get("version")
    if type(version) is not int or not 1 <= version <= VERSION:
        raise BadFaults(f"The faults have the version {version!r}; this VIPO reads up to {VERSION}.")
    for step in range(version, VERSION):
        data = LADDER[step](data)
    if unknown := set(data) - {"version", "faults"}:
        raise BadFaults(f"{min(unknown)} is not known beside the faults; remove it.")
    return read_list(data.get("faults", []))


def read_list(entries: object) -> tuple[Fault, ...]:
    """Read a list of faults of this version; raises BadFaults."""
    if not isinstance(entries, list) or len(entries) > MOST_FAULTS:
        raise BadFaults(f"Write the faults as a list of at most {MOST_FAULTS}.")
    return tuple(_fault(entry, number) for number, entry in enumerate(entries, 1))


def faults_to_json(faults: Iterable[Fault]) -> dict[str, Any]:
    """Return what `read_faults` reads."""
    return {"version": VERSION, "faults": [_entry(fault) for fault in faults]}


def check_faults(faults: Iterable[Fault], devices: Iterable[Description], steps: Iterable[str]) -> None:
    """Refuse faults of devices, readings and steps that there are not; raises BadFaults."""
    known, named = {d.id: d for d in devices}, set(steps)
    for number, fault in enumerate(faults, 1):
        if fault.step and fault.step not in named:
            raise BadFaults(f"the program has no step {fault.step!r}.", number)
        if fault.kind == "obstacle":
            continue
        if fault.device not in known:
            raise BadFaults(f"there is no device {fault.device!r} here. There are: {_some(known)}.", number)
        if why := _misfit(fault, known[fault.device]):
            raise BadFaults(why, number)


def _misfit(fault: Fault, device: Description) -> str:
    """Return why a device cannot have this fault, or an empty text."""
    if fault.kind in {"drops", "battery"} and device.kind != "robot":
        return f"{device.name} is no robot; only robots drop things and run on batteries."
    if fault.kind == "battery" and not says_charge(device):
        return f"{device.name} does not say how full its battery is, so it cannot run low."
    if fault.kind != "wrong_value":
        return ""
    spec = device.property(fault.name)
    if spec is None:
        return f"{device.name} has no property {fault.name!r}. It has: {_some(p.name for p in device.properties)}."
    return "" if suits(spec, fault.value) else f"{fault.name} is a {spec.type}; {fault.value!r} is none."


def suits(spec: PropertySpec, value: Scalar) -> bool:
    """Tell whether a value is of the type of a property."""
    if spec.type == "number":
        return isinstance(value, int | float) and not isinstance(value, bool)
    return isinstance(value, bool if spec.type == "boolean" else str)


def _fault(entry: object, number: int) -> Fault:
    if not isinstance(entry, dict):
        raise BadFaults("write it with “device” and “fault”.", number)
    word = entry.get("fault")
    if not isinstance(word, str) or word not in KIND_OF:
        raise BadFaults(f"“fault” is one of {', '.join(KIND_OF)}, not {word!r}.", number)
    _refuse_words(entry, word, number)
    values = {name: _value(name, value, number) for name, value in entry.items() if name not in {"fault", "device"}}
    if "odds" in values and word in _LASTS and "for_s" not in values:
        raise BadFaults(f"a device that is {word} by chance needs “for_s”: how many seconds.", number)
    value = values.get("percent", values.get("value", ""))
    return Fault(
        device=_text("device", entry.get("device", ""), number), kind=KIND_OF[word], at_s=values.get("at_s", 0.0),
        step=values.get("at_step", ""), nth=values.get("nth", 1), odds=values.get("odds", 0.0),
        for_s=values.get("for_s", inf), error=values.get("error", ""), after_s=values.get("after_s", 0.0),
        name=values.get("property", ""), value=value, x=values.get("x", 0.0), y=values.get("y", 0.0),
        size_m=values.get("size_m", 0.5),
    )  # fmt: skip


def _refuse_words(entry: Mapping[str, Any], word: str, number: int) -> None:
    """Refuse words that this kind of fault does not take, and miss those that it needs."""
    needs = _NEEDS.get(word, ()) + (() if word == "obstacle" else ("device",))
    when = tuple(name for name in _WHEN if name in entry)
    allowed = {"fault", *needs, *_MAY.get(word, ()), *(_WHEN[:2] if word == "obstacle" else _WHEN)}
    allowed |= {"for_s"} if word in _LASTS else set()
    allowed |= {"nth"} if "at_step" in entry else set()
    for name in entry:
        if name not in allowed:
            raise BadFaults(f"“{str(name)[:40]}” is not known of {word}. Known are: {_some(allowed)}.", number)
    for name in needs:
        if name not in entry:
            raise BadFaults(f"{word} needs “{name}”.", number)
    if len(when) > 1:
        raise BadFaults(f"it begins once: write {' or '.join(f'“{name}”' for name in when)}, not both.", number)


def _value(name: str, value: object, number: int) -> Any:
    if name in _RANGES:
        return _number(name, value, number)
    if name == "nth":
        if type(value) is not int or not 1 <= value <= 10_000:
            raise BadFaults(f"“nth” is a whole number from 1 to 10000, not {value!r}.", number)
        return value
    if name == "value":
        return _scalar(value, number)
    return _text(name, value, number)


def _number(name: str, value: object, number: int) -> float:
    low, high = _RANGES[name]
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    if not is_number or not low <= value <= high:  # type: ignore[operator]  # no NaN is
        raise BadFaults(f"“{name}” is a number from {low:g} to {high:g}, not {str(value)[:40]!r}.", number)
    return float(value)  # type: ignore[arg-type]  # looked at above


def _scalar(value: object, number: int) -> Scalar:
    if isinstance(value, bool) or (isinstance(value, int | float) and abs(value) < 1e15):  # no NaN is
        return value
    return _text("value", value, number)


def _text(name: str, value: object, number: int) -> str:
    if isinstance(value, int) and not isinstance(value, bool) and name == "at_step":
        value = str(value)  # a step's number such as 3, without quotes
    if not isinstance(value, str) or len(value) > MOST_CHARACTERS:
        raise BadFaults(f"“{name}” is a text of at most {MOST_CHARACTERS} characters.", number)
    return value


def _entry(fault: Fault) -> dict[str, Any]:
    word = _WORD_OF[fault.kind]
    held = {
        "after_s": fault.after_s, "property": fault.name, "value": fault.value, "percent": fault.value,
        "x": fault.x, "y": fault.y, "size_m": fault.size_m, "error": fault.error,
    }  # fmt: skip
    entry: dict[str, Any] = {"fault": word} | ({} if word == "obstacle" else {"device": fault.device})
    entry |= {name: held[name] for name in (*_NEEDS.get(word, ()), *_MAY.get(word, ()))}
    if fault.step:
        entry |= {"at_step": fault.step, "nth": fault.nth}
    else:
        entry |= {"odds": fault.odds} if fault.odds else {"at_s": fault.at_s}
    return entry | ({"for_s": fault.for_s} if word in _LASTS and fault.for_s < inf else {})


def _some(words: Iterable[str]) -> str:
    return ", ".join(sorted(words)[:12])
