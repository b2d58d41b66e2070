"""A device that is chosen for a parameter can do what the program does with it, as far as the run may come there."""

from __future__ import annotations

from textwrap import indent
from typing import Any

import pytest

from editor.language import compile_document, find_misfit, parse_script, tree_to_document
from tests.kit.demo_site import factory

BOOTH, OVEN, MIXER, ROBOT = "paintMachine01", "curingOven01", "paintMixer01", "robot02"
RUN = f"""
self.robot = ctx.any("pick", "drop")
self.oven = ctx.get("{OVEN}")
self.booth = ctx.get("{BOOTH}")
self.m = ctx.parameter("m", "{BOOTH}", Device)
self.n = ctx.parameter("n", "{OVEN}", Device)
self.at = ctx.parameter("at", "dock1", Place)
self.dry = ctx.parameter("dry", True, Boolean)
self.minutes = ctx.parameter("minutes", 3, Number("min"))
"""
PAINT, CURE = "self.m.operate('paint', {'time': 3})", "self.n.operate('curePaint', {'time': 3})"
COOK = "def cook(self, machine: Device):\n    machine.operate('curePaint', {'time': 10})"
BOTH = "for each in [self.m, self.n]:\n    each.operate('curePaint', {'time': 3})"
LATE = "def {}(self):\n    self.m.operate('curePaint', {{'time': 3}})"
EITHER = "if self.dry:\n    self.x = self.oven\nelse:\n    self.x = self.booth\nself.x.operate('paint', {'time': 3})"


def drawn(body: str, functions: str, more: str) -> dict[str, Any]:
    """Return what is drawn for a program without errors that has such parameters."""
    run = indent(f"{RUN}{more}\nself.new_task()", "    ")
    parts = f"def new_task(self):\n{indent(body, '    ')}\n\n{functions}\n\ndef run(self, ctx):\n{run}"
    parsed = parse_script(f"class Task(object):\n{indent(parts, '    ')}\n", factory())
    assert parsed.tree is not None, [each.message for each in parsed.diagnostics]
    document = tree_to_document(parsed.tree, factory())
    assert compile_document(document, factory()).plan is not None
    return document


def found(body: str, functions: str = "", more: str = "", **given: Any) -> tuple[str, str, str] | None:
    """Return the parameter whose device does not fit, the device, and what is told; None where all do."""
    usual = {"m": BOOTH, "n": OVEN, "at": "dock1", "dry": True, "minutes": 3}
    misfit = find_misfit(drawn(body, functions, more), factory(), {**usual, **given})
    return misfit and (misfit.parameter, misfit.device.id, misfit.diagnostic.code)


@pytest.mark.parametrize(
    ("body", "given", "told"),
    [
        (PAINT, {}, None),
        (PAINT, {"m": OVEN}, ("m", OVEN, "unknown_method")),
        (f"{PAINT}\n{CURE}", {"m": OVEN, "n": OVEN}, ("m", OVEN, "unknown_method")),
        (f"{PAINT}\n{CURE}", {"m": BOOTH, "n": BOOTH}, ("n", BOOTH, "unknown_method")),
        ("self.x = self.m\nself.x.operate('paint', {'time': 3})", {"m": MIXER}, ("m", MIXER, "unknown_method")),
        (BOTH, {}, ("m", BOOTH, "unknown_method")),
        (BOTH, {"m": OVEN}, None),
        ("self.wait(until=self.m.read('quality') == 'good')", {"m": MIXER}, ("m", MIXER, "unknown_property")),
        ("self.wait(until=self.m.read('quality') == 'good')", {"m": OVEN}, None),
        ("self.robot.move(self.at.location)", {"at": ROBOT}, ("at", ROBOT, "robot_as_goal")),
        ("self.robot.move(self.at.location)", {"at": OVEN}, None),
        ("self.m.operate('mixPaint', {'time': self.minutes})", {"m": MIXER}, None),
        ("self.m.operate('mixPaint', {'time': self.minutes})", {"m": MIXER, "minutes": 90},
         ("m", MIXER, "out_of_range")),
    ],
)  # fmt: skip
def test_the_first_device_that_cannot_is_found(body: str, given: dict[str, Any], told: Any) -> None:
    assert found(body, **given) == told


def test_functions_count_with_what_calls_give_them_and_not_where_nobody_calls() -> None:
    calls = "self.cook(machine=self.n)\nself.cook(machine=self.m)"
    assert found(calls, COOK, m=OVEN) is None
    assert found(calls, COOK, m=BOOTH) == ("m", BOOTH, "unknown_method")
    assert found(PAINT, LATE.format("nobody")) is None


def test_events_count_with_their_conditions() -> None:
    late, hot = LATE.format("when_e1"), "ctx.when(self.oven.temperature > 60, self.when_e1)"
    assert found(PAINT, late, hot) == ("m", BOOTH, "unknown_method")
    assert found(CURE, late, hot, m=OVEN) is None
    pressed = "ctx.when(self.m.read('pressure') > 6, self.when_e1)"
    assert found(CURE, late, pressed, m=OVEN) == ("m", OVEN, "unknown_property")
    assert found(f"self.m = self.oven\n{CURE}", late, hot) is None


def test_what_is_asked_only_where_something_else_is_chosen_keeps_nobody_from_a_device() -> None:
    body = f"if self.dry:\n    {CURE}\nelse:\n    {PAINT}"
    assert found(body, m=MIXER) is None
    assert found(body, m=MIXER, dry=False) == ("m", MIXER, "unknown_method")
    assert found(f"if self.oven.temperature > 40:\n    {PAINT}", m=MIXER) == ("m", MIXER, "unknown_method")
    assert found(f"self.end()\n{PAINT}", m=MIXER) is None


def test_nobody_is_blamed_for_a_device_that_the_program_names_itself() -> None:
    assert found(EITHER, n=OVEN, dry=True) is None


def either(condition: str, yes: str = "curePaint", no: str = "paint", before: str = "") -> str:
    ways = [f"    self.m.operate('{method}', {{'time': 3}})\n" for method in (yes, no)]
    return f"{before}if {condition}:\n{ways[0]}else:\n{ways[1]}".strip()


@pytest.mark.parametrize(
    "body",
    [
        either("self.m in [self.oven]"),
        either("self.m not in [self.oven]", "paint", "curePaint"),
        either("self.m in self.ovens", before="self.ovens = [self.oven]\n"),
        either("self.m in self.ovens", before="self.ovens = [self.oven] + [self.n]\n"),
        "self.ovens = [self.oven]\nself.wait(1)\nif len(self.ovens) > 0:\n"
        + indent(either("self.m in self.ovens"), "    "),
        either("self.m in [self.n, self.x]", before="self.x = self.oven\n"),
    ],
)
def test_programs_that_choose_by_the_device_take_each_that_they_reckon_with(body: str) -> None:
    assert [found(body, m=device) for device in (BOOTH, OVEN)] == [None, None]
    assert found(body, m=MIXER) == ("m", MIXER, "unknown_method")


TRIED = "try:\n    self.m.operate('curePaint', {'time': 3})\nexcept {}:\n    self.m.operate('paint', {'time': 3})"
CALLED = "def cure(self):\n    self.m.operate('curePaint', {'time': 3})"


def test_what_a_program_catches_keeps_nobody_from_a_device() -> None:
    assert found(TRIED.replace("{}", "TaskError")) is None
    assert found(TRIED.replace("{}", "(Refused, Offline)")) is None
    assert found(TRIED.replace("{}", "Offline")) == ("m", BOOTH, "unknown_method")
    assert found(TRIED.replace("{}", "TaskError"), m=MIXER) == ("m", MIXER, "unknown_method"), "of what is done then"
    inner = f"try:\n{indent(TRIED.replace('{}', 'Offline'), '    ')}\nexcept Refused:\n    self.wait(1)"
    assert found(inner, m=MIXER) is None
    called = "try:\n    self.cure()\nexcept TaskError:\n    self.wait(1)"
    assert found(called, CALLED) is None
    assert found(f"{called}\nself.cure()", CALLED) == ("m", BOOTH, "unknown_method")
    asked = "try:\n    self.x = self.m.read('pressure')\nexcept {}:\n    self.wait(1)"
    assert found(asked.replace("{}", "Failed"), m=OVEN) is None
    assert found(asked.replace("{}", "Refused"), m=OVEN) == ("m", OVEN, "unknown_property")


AWAITED = "try:\n    self.wait(until=self.m.read('quality') == 'good'{})\nexcept {}:\n    self.wait(1)"
SENT = "try:\n    {}\nexcept {}:\n    self.wait(1)"
GOES = "self.robot.move(self.at.location)"


def test_what_is_caught_is_what_the_run_would_fail_with() -> None:
    for_ever, missing = ("", "TaskError"), ("m", MIXER, "unknown_property")
    assert found(AWAITED.format(*for_ever), m=MIXER) == missing, "it would wait and never fail"
    assert found(AWAITED.format("", "TimedOut"), m=MIXER) == missing
    assert found(AWAITED.format(", timeout=60", "TimedOut"), m=MIXER) is None
    assert found(AWAITED.format(", timeout=60", "TaskError"), m=MIXER) is None
    assert found(AWAITED.format(", timeout=60", "Failed"), m=MIXER) == missing
    assert found(SENT.format(GOES, "Blocked"), at=ROBOT) is None
    assert found(SENT.format(GOES, "Refused"), at=ROBOT) == ("at", ROBOT, "robot_as_goal")
