"""A device that a variable holds is given and tells values in its own units, as one that is named."""

from __future__ import annotations

from dataclasses import replace
from textwrap import indent
from typing import Any

import pytest

from editor.language import Compiled, compile_document, parse_script, tree_to_document
from editor.language.compiler import EditedProgram
from editor.language.site.surroundings import DeviceFacts, Surroundings
from execution.machine import machine
from execution.machine import messages as m
from tests.kit.demo_site import factory
from vipo_device.protocol.description import ParameterSpec, PropertySpec

OVEN, TWIN = "curingOven01", "curingOven02"
HOT = {(OVEN, "temperature"): 80.0, (OVEN, "left"): 2.0}
CURE = 'machine.operate("curePaint", {"time": t})'
COOK = f'def cook(self, machine: Device, t: Number("s")):\n    {CURE}'
READ = 'for oven in [self.oven]:\n    self.t = oven.read("temperature")\n'
TELL = 'def tell(self, machine: Device):\n    if machine.read("temperature") > quantity(300, "K"):\n        self.say()'
IN_TURN = f"def in_turn(self, oven: Device):\n    for each in [oven]:\n        self.cook(machine=each)\n{COOK}"


def site(twin_unit: str = "MIN", twin_temperature: str = "DEG_C") -> Surroundings:
    """Return the factory with two ovens, of which the second may count in other units; both tell minutes left."""
    found = factory()
    facts = found.devices[OVEN]
    left = (*facts.description.properties, PropertySpec("left", "number", "MIN"))
    oven = replace(facts, description=replace(facts.description, properties=left))
    return replace(found, devices={**found.devices, OVEN: oven, TWIN: twin_of(oven, twin_unit, twin_temperature)})


def twin_of(facts: DeviceFacts, unit: str, temperature: str) -> DeviceFacts:
    told = facts.description.properties
    properties = [replace(p, unit=temperature) if p.name == "temperature" else p for p in told]
    method = replace(facts.description.methods[0], parameters=(ParameterSpec("time", "number", unit=unit),))
    changed = replace(facts.description, id=TWIN, name="Twin", properties=tuple(properties), methods=(method,))
    return replace(facts, description=changed)


def document_of(body: str, functions: str, where: Surroundings, more: str = "") -> dict[str, Any]:
    """Return what is drawn for a program that knows both ovens."""
    run = f'self.oven = ctx.get("{OVEN}")\nself.twin = ctx.get("{TWIN}")\n{more}\nself.new_task()'
    parts = f"def new_task(self):\n{indent(body, '    ')}\n\n{functions}\n\ndef run(self, ctx):\n{indent(run, '    ')}"
    parsed = parse_script(f"class Task(object):\n{indent(parts, '    ')}\n", where)
    assert parsed.tree is not None, [each.message for each in parsed.diagnostics]
    return tree_to_document(parsed.tree, where)


def compiled(body: str, functions: str = "", where: Surroundings | None = None, more: str = "") -> Compiled:
    where = where or site()
    return compile_document(document_of(body, functions, where, more), where)


def told(body: str, functions: str = "", where: Surroundings | None = None, more: str = "") -> list[str]:
    return [each.code for each in compiled(body, functions, where, more).diagnostics]


def begun(body: str, functions: str = "", parameters: dict[str, Any] | None = None, more: str = "") -> list[Any]:
    """Return the first actions of a run."""
    plan = compiled(body, functions, more=more).plan
    assert plan is not None, told(body, functions, more=more)
    return list(machine.start(plan, parameters or {}, HOT)[1])


@pytest.mark.parametrize(
    ("body", "functions"),
    [
        (f"for machine in [self.oven]:\n    {CURE}".replace("t}", 'quantity(120, "s")}'), ""),
        (f"for machine in [self.oven, self.twin]:\n    {CURE}".replace("t}", 'quantity(120, "s")}'), ""),
        ('self.cook(machine=self.oven, t=quantity(120, "s"))', COOK),
        ("self.in_turn(oven=self.oven)", IN_TURN.replace('Number("s")', 'Number("s") = 120')),
        ('self.ovens = [self.oven]\nself.m = nth(self.ovens, 1)\nself.m.operate("curePaint", {"time": T})', ""),
        ('self.m = self.oven\nself.use()', 'def use(self):\n    self.m.operate("curePaint", {"time": T})'),
        ('self.m = self.find()\nself.m.operate("curePaint", {"time": T})',
         "def find(self) -> Device:\n    return self.oven"),
    ],
)  # fmt: skip
def test_a_device_that_a_variable_holds_is_told_its_own_unit(body: str, functions: str) -> None:
    actions = begun(body.replace("T}", 'quantity(120, "s")}'), functions.replace("T}", 'quantity(120, "s")}'))
    calls = [each.order.arguments for each in actions if isinstance(each, m.Ask)]
    assert calls == [{"time": 2}]


@pytest.mark.parametrize(
    ("body", "functions"),
    [
        ('for oven in [self.oven]:\n    if oven.read("temperature") > quantity(300, "K"):\n        self.say()', ""),
        ("self.tell(machine=self.oven)", TELL),
        (f"{READ}if self.t > quantity(300, 'K'):\n    self.say()", ""),
    ],
)  # fmt: skip
def test_what_a_device_tells_that_a_variable_holds_is_converted(body: str, functions: str) -> None:
    say = 'def say(self):\n    self.notify("hot", level="info")\n'
    assert [each.text for each in begun(body, say + functions) if isinstance(each, m.Tell)] == ["hot"]


def test_what_is_waited_is_what_a_device_tells_that_a_variable_holds() -> None:
    actions = begun('for oven in [self.oven]:\n    self.wait(oven.read("left"))')
    assert [each.seconds for each in actions if isinstance(each, m.SetTimer)] == [120]


def test_devices_that_count_in_different_units_are_not_given_a_measure_by_one_step() -> None:
    body = 'for machine in [self.oven, self.twin]:\n    machine.operate("curePaint", {"time": quantity(9, "min")})'
    assert "units_differ" in told(body, where=site("SEC"))
    assert told(body) == []
    assert "units_differ" not in told(body.replace(", self.twin", ""), where=site("SEC"))
    assert told(body.replace('quantity(9, "min")', "9"), where=site("SEC")) == []


def test_devices_that_tell_in_different_units_are_not_read_by_one_step() -> None:
    body = 'for oven in [self.oven, self.twin]:\n    if oven.read("temperature") > 40:\n        self.say()'
    say = 'def say(self):\n    self.notify("hot", level="info")'
    assert told(body, say, site("MIN", "K")) == ["units_differ"]
    assert told(body, say) == []


def test_of_a_device_that_nobody_knows_all_devices_of_the_site_must_count_alike() -> None:
    body = 'self.m.operate("curePaint", {"time": quantity(120, "s")})'
    given = 'self.m = ctx.parameter("m", "curingOven01", Device)'
    actions = begun(body, parameters={"m": OVEN}, more=given)
    assert [each.order.arguments for each in actions if isinstance(each, m.Ask)] == [{"time": 2}]
    assert told(body, where=site("SEC"), more=given) == ["units_differ"]
    assert told(body.replace('"s")', '"kg")'), more=given) == ["wrong_unit"]
    assert told(body.replace('"curePaint"', '"polish"'), more=given) == ["unit_not_taken"]


def test_an_edit_that_puts_another_device_into_a_variable_is_seen_where_it_is_used() -> None:
    where, edited = site("SEC"), EditedProgram()
    body = "self.cook(machine=self.{}, t=quantity(120, 's'))"
    first = document_of(body.format("twin"), COOK, where)
    assert edited.compile(first, where).diagnostics == ()
    call = next(step for step, drawn in first["steps"].items() if drawn["kind"] == "call")
    changed = {**first["steps"][call], "params": {**first["steps"][call]["params"]}}
    changed["params"]["args"] = {**changed["params"]["args"], "machine": {"device": OVEN}}
    second = {**first, "steps": {**first["steps"], call: changed}}
    plan = edited.compile(second, where).plan
    assert plan == compile_document(second, where).plan
    assert plan is not None
    orders = [each.order.arguments for each in machine.start(plan, {}, HOT)[1] if isinstance(each, m.Ask)]
    assert orders == [{"time": 2}]
