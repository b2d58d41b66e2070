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


ORDER = 'self.m.operate("curePaint", {"time": quantity(120, "s")})'
FIND = "def find(self) -> Device:\n    return self.oven"
HEAT = f'def heat(self, machine: Device = "{OVEN}"):\n    machine.operate("curePaint", {{"time": quantity(120, "s")}})'
LOOK = TELL.replace("machine: Device", f'machine: Device = "{OVEN}"')
SAY = 'def say(self):\n    self.notify("hot", level="info")\n'


@pytest.mark.parametrize(
    ("body", "functions"),
    [
        (f"self.m = self.find()\n{ORDER}", FIND),
        ("self.heat()", HEAT),
        (f'for o in ["{OVEN}"]:\n    {ORDER}'.replace("self.m", "o"), ""),
        (f'self.m = "{OVEN}"\n{ORDER}', ""),
    ],
)  # fmt: skip
def test_of_two_ovens_that_count_differently_the_one_that_is_held_is_told_its_own_unit(
    body: str, functions: str
) -> None:
    plan = compiled(body, functions, site("SEC")).plan
    assert plan is not None, told(body, functions, site("SEC"))
    calls = [each.order.arguments for each in machine.start(plan, {}, HOT)[1] if isinstance(each, m.Ask)]
    assert calls == [{"time": 2}]


@pytest.mark.parametrize(
    ("body", "functions"),
    [
        ('self.m = self.find()\nif self.m.read("temperature") > quantity(300, "K"):\n    self.say()', FIND),
        ("self.tell()", LOOK),
        (f'for o in ["{OVEN}"]:\n    if o.read("temperature") > quantity(300, "K"):\n        self.say()', ""),
    ],
)
def test_of_two_ovens_that_report_differently_the_one_that_is_held_is_read(body: str, functions: str) -> None:
    plan = compiled(body, SAY + functions, site("MIN", "K")).plan
    assert plan is not None, told(body, SAY + functions, site("MIN", "K"))
    assert [each.text for each in machine.start(plan, {}, HOT)[1] if isinstance(each, m.Tell)] == ["hot"]


def test_a_function_that_nobody_calls_holds_no_device_of_which_units_are_told() -> None:
    where = site("SEC", "K")
    assert told('self.notify("hi", level="info")', SAY + TELL, where) == ["unused_function"] * 2
    heat = HEAT.replace(f' = "{OVEN}"', "")
    assert told('self.notify("hi", level="info")', heat, where) == ["unused_function"]
    assert told(f"self.heat(machine=self.oven)\n{CALL_LATER}", f"{heat}\n{LATER}", where) == []


CALL_LATER = "self.later(m=self.oven)"
LATER = "def later(self, m: Device):\n    self.heat(machine=m)"
CHOSEN = f'self.m = ctx.parameter("m", "{OVEN}", Device)'


@pytest.mark.parametrize("body", [
    f'{ORDER}\nif self.m.read("temperature") > 40:\n    self.say()',
    f'self.use(machine=self.m)\n{ORDER}',
])  # fmt: skip
def test_of_devices_that_people_choose_those_do_not_count_that_can_do_nothing_of_what_is_done(
    body: str,
) -> None:
    use = TELL.replace("tell", "use")
    functions = SAY + (use if "self.use" in body else "")
    assert told(body, functions, with_thermometer(), CHOSEN) == []
    assert told(body, functions, site("MIN", "K"), CHOSEN) == ["units_differ"]


def test_who_can_do_a_part_of_what_is_done_with_a_device_that_people_choose_counts_with_its_readings() -> None:
    where = site("MIN", "K")
    twin = where.devices[TWIN]
    less = replace(twin.description, methods=tuple(each for each in twin.description.methods if each.name != "beep"))
    oven = where.devices[OVEN]
    beep = replace(oven.description.methods[0], name="beep", parameters=())
    more = replace(oven.description, methods=(*oven.description.methods, beep))
    devices = {**where.devices, TWIN: replace(twin, description=less), OVEN: replace(oven, description=more)}
    body = f'{ORDER}\nself.m.operate("beep")\nif self.m.read("temperature") > 40:\n    self.say()'
    assert "units_differ" in told(body, SAY, replace(where, devices=devices), CHOSEN)


def test_a_machine_that_people_may_choose_is_never_told_a_number_in_another_unit() -> None:
    where = site("SEC")
    twin = where.devices[TWIN]
    silent = replace(twin, description=replace(twin.description, properties=()))
    where = replace(where, devices={**where.devices, TWIN: silent})
    body = f'{ORDER}\nif self.m.read("temperature") > 40:\n    self.say()'
    assert told(body, SAY, where, CHOSEN) == ["units_differ"]


def with_thermometer() -> Surroundings:
    """Return the site with a device that reports a temperature in K, and has no method."""
    found = site()
    facts = found.devices[TWIN]
    kelvins = (PropertySpec("temperature", "number", "K"),)
    thermometer = replace(facts.description, id="thermometer01", name="Thermometer", properties=kelvins, methods=())
    return replace(found, devices={**found.devices, "thermometer01": replace(facts, description=thermometer)})


def test_a_device_that_says_no_unit_is_taken_to_count_as_the_others_do() -> None:
    body = (
        'for oven in [self.oven, self.twin]:\n    if oven.read("temperature") > quantity(300, "K"):\n        self.say()'
    )
    assert told(body, SAY, site("MIN", "")) == []
    plan = compiled(body, SAY, site("MIN", "")).plan
    assert plan is not None
    both = {(OVEN, "temperature"): 20.0, (TWIN, "temperature"): 30.0}
    assert [each.text for each in machine.start(plan, {}, both)[1] if isinstance(each, m.Tell)] == ["hot"]


@pytest.mark.parametrize("shown", ['{oven.read("temperature")}', '{round(oven.read("temperature"))}'])
def test_what_is_only_shown_needs_no_unit(shown: str) -> None:
    shown = shown.replace('"', "'")
    body = f'for oven in [self.oven, self.twin]:\n    self.notify(f"It has {shown}", level="info")'
    assert told(body, where=site("MIN", "K")) == []
    assert told(body.replace("{", "{1 + "), where=site("MIN", "K")) == ["units_differ"]


def test_a_measure_that_no_machine_takes_is_told_once() -> None:
    body = 'for machine in [self.oven, self.twin]:\n    machine.operate("curePaint", {"time": quantity(9, "kg")})'
    assert told(body, where=site("SEC")) == ["wrong_unit"]
    assert told(body.replace("kg", "min"), where=site("KG")) == ["wrong_unit"]
    either = f"self.m = self.oven\nif self.oven.temperature > 40:\n    self.m = self.twin\n{ORDER}"
    assert told(either, where=site("KG")) == ["wrong_unit"]
    assert told(body.replace("curePaint", "polish"), where=site("KG")) == ["unknown_method"]


def test_a_measure_that_one_machine_does_not_take_hides_no_other_machine_that_does_not_fit() -> None:
    either = f"self.m = self.oven\nif self.oven.temperature > 40:\n    self.m = self.twin\n{ORDER}"
    third = either.replace(ORDER, f"if self.oven.temperature > 60:\n    self.m = self.mixer\n{ORDER}")
    given = 'self.mixer = ctx.get("paintMixer01")'
    assert told(third, where=site("KG"), more=given) == ["wrong_unit", "may_not_fit"]
    assert told(third, more=given) == ["may_not_fit"]
    assert told(third.replace("self.mixer", "self.oven"), where=site("KG")) == ["wrong_unit"]


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
