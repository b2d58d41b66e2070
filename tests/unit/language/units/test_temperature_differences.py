"""A difference of temperatures goes over into other units by the factor alone, or is refused where it may be none."""

from __future__ import annotations

from dataclasses import replace
from textwrap import indent

import pytest

from editor.language import Compiled, compile_document, parse_script, tree_to_document
from editor.language.site.surroundings import Surroundings
from execution.machine import machine
from execution.machine import messages as m
from tests.kit.demo_site import factory
from vipo_device.protocol.description import ParameterSpec, PropertySpec

OVEN = "curingOven01"
NOW = {(OVEN, "temperature"): 21.0, (OVEN, "before"): 20.0, (OVEN, "kelvins"): 293.15}
"""What the oven tells: two temperatures in °C, and the second of them in K, too."""
T, B, K = (f"self.oven.{name}" for name in ("temperature", "before", "kelvins"))
KEPT = f"self.first = {B}\n"


def site() -> Surroundings:
    found = factory()
    facts = found.devices[OVEN]
    more = (PropertySpec("before", "number", "DEG_C"), PropertySpec("kelvins", "number", "K"))
    time = (ParameterSpec("time", "number", unit="DEG_C"),)
    method = replace(facts.description.methods[0], parameters=time)
    oven = replace(facts.description, properties=(*facts.description.properties, *more), methods=(method,))
    return replace(found, devices={**found.devices, OVEN: replace(facts, description=oven)})


def compiled(body: str, functions: str = "") -> Compiled:
    run = f'self.oven = ctx.get("{OVEN}")\nself.new_task()'
    parts = f"def new_task(self):\n{indent(body, '    ')}\n\n{functions}\n\ndef run(self, ctx):\n{indent(run, '    ')}"
    parsed = parse_script(f"class Task(object):\n{indent(parts, '    ')}\n", site())
    assert parsed.tree is not None, [each.message for each in parsed.diagnostics]
    return compile_document(tree_to_document(parsed.tree, site()), site())


def told(body: str, functions: str = "") -> list[str]:
    return [each.code for each in compiled(body, functions).diagnostics if each.severity == "error"]


def holds(condition: str, before: str = "", functions: str = "") -> bool:
    """Tell whether a condition holds behind some steps, with what the oven tells now."""
    body = f'{before}if {condition}:\n    self.notify("yes", level="info")'
    plan = compiled(body, functions).plan
    assert plan is not None, told(body, functions)
    return any(isinstance(each, m.Tell) for each in machine.start(plan, {}, NOW)[1])


def between(value: str, before: str = "", functions: str = "", middle: tuple[str, str] = ("K", "1")) -> bool:
    """Tell whether a value is what it should be, a tenth more or less."""
    unit, number = middle
    low, high = (f'quantity({float(number) + aside}, "{unit}")' for aside in (-0.1, 0.1))
    return holds(f"{value} > {low} and {value} < {high}", before, functions)


@pytest.mark.parametrize(
    ("value", "before"),
    [
        (f"{T} - {B}", ""),
        (f"abs({B} - {T})", ""),
        (f"{T} - self.first", KEPT),
        ("self.risen", f"self.risen = {T} - {B}\n"),
        ("self.risen", f'self.risen = quantity(0, "K")\nself.risen = max(self.risen, {T} - {B})\n'),
        (f'max({T} - {B}, quantity(0.5, "K"))', ""),
        (f'min({T} - {B}, quantity(9, "°F"))', ""),
        (f"({T} - {B}) * 2 / 2", ""),
        (f"({T} - ({T} + {B}) / 2) * 2", ""),
        ("nth(self.all, 1)", f"self.all = [{T} - {B}]\n"),
        (f"{T} - {K}", ""),
        (f"({K} - {T}) * (-1)", ""),
        (f"{T} - ({B} - ({T} - {T}))", ""),
        (f'quantity(294.15, "K") - {B}', ""),
    ],
)  # fmt: skip
@pytest.mark.parametrize("middle", [("K", "1"), ("°F", "1.8"), ("°C", "1")])
def test_what_meets_a_difference_is_converted_by_the_factor(value: str, before: str, middle: tuple[str, str]) -> None:
    assert between(value, before, middle=middle)


@pytest.mark.parametrize(
    ("value", "before"),
    [
        (T, ""),
        (f"{B} + ({T} - {B})", ""),
        (f'{T} + quantity(5, "K") - quantity(5, "K")', ""),
        (f'({T} + {B}) / 2 + quantity(0.9, "°F")', ""),
        (f"({T} + {K}) / 2 + ({T} - {B}) / 2", ""),
        ("self.t - self.step", f'self.t = {T} + quantity(5, "K")\nself.step = quantity(5, "K")\n'),
        ("self.t", 'self.t = quantity(26, "°C")\nself.t = self.t - 5\n'),
    ],
)  # fmt: skip
def test_a_temperature_is_converted_with_its_offset(value: str, before: str) -> None:
    assert between(value, before, middle=("K", "294.15"))
    assert between(value, before, middle=("°F", "69.8"))


def test_a_function_gives_and_takes_a_difference_in_kelvins() -> None:
    rise = f'def rise(self) -> Number("K"):\n    return {T} - {B}'
    assert between("self.risen", "self.risen = self.rise()\n", rise)
    check = 'def check(self, by: Number("K")):\n    if by < quantity(2, "K"):\n        self.notify("yes", level="info")'
    plan = compiled(f"self.check(by={T} - {B})", check).plan
    assert plan is not None
    assert any(isinstance(each, m.Tell) for each in machine.start(plan, {}, NOW)[1])


@pytest.mark.parametrize("unit", ["°C", "°F"])
def test_a_function_neither_gives_nor_takes_a_difference_in_another_unit(unit: str) -> None:
    rise = f'def rise(self) -> Number("{unit}"):\n    return {T} - {B}'
    assert told("self.risen = self.rise()\nself.wait(1)", rise) == ["difference_needs_kelvins"]
    check = f'def check(self, by: Number("{unit}")):\n    if by < 2:\n        self.notify("yes", level="info")'
    assert told(f"self.check(by={T} - {B})", check) == ["difference_needs_kelvins"]
    assert told(f"self.check(by={T})", check) == []


def test_a_device_is_told_a_difference_in_its_own_unit() -> None:
    plan = compiled(f'self.risen = quantity(0, "K")\nself.risen = {T} - {B}\nself.oven.cure_paint(self.risen)').plan
    assert plan is not None
    asked = [each.order.arguments for each in machine.start(plan, {}, NOW)[1] if isinstance(each, m.Ask)]
    assert asked == [{"time": 1}]


@pytest.mark.parametrize(
    "value",
    [f"{T} - 20", f'{T} - quantity(20, "°C")', f'{T} - quantity(36, "°F")', "self.oven.temperature - self.limit"],
)
def test_what_may_be_a_temperature_or_a_difference_goes_over_into_no_other_unit(value: str) -> None:
    limit = 'self.limit = quantity(20, "°C")\nif {} < quantity(5, "K"):\n    self.notify("yes", level="info")'
    assert told(limit.format(value)) == ["temperature_or_difference"]
    if "°F" not in value:
        assert told(limit.format(value).replace('5, "K"', '5, "°C"')) == []
