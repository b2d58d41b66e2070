"""A unit goes with its value from the script to the run: what is waited is what was said, or it is refused."""

from __future__ import annotations

from dataclasses import replace
from math import isclose
from textwrap import indent
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from editor.language import Diagnostic, compile_document, parse_script, tree_to_document
from execution.machine import machine
from execution.machine import messages as m
from tests.kit.demo_site import factory
from vipo_device.protocol.description import PropertySpec
from vipo_device.protocol.units import UNITS

OVEN = {("curingOven01", "temperature"): 80.0, ("curingOven01", "speed"): 0.5, ("curingOven01", "left"): 3}
RUN = """
    def run(self, ctx):
        self.curing_oven = ctx.get("curingOven01")
        {parameters}
        self.new_task()
"""


def site() -> Any:
    """Return the factory with an oven that also says a speed in m/s, and a number of which it says no unit."""
    found = factory()
    facts = found.devices["curingOven01"]
    more = (PropertySpec("speed", "number", "M-PER-SEC"), PropertySpec("left", "number", ""))
    description = replace(facts.description, properties=(*facts.description.properties, *more))
    return replace(found, devices={**found.devices, "curingOven01": replace(facts, description=description)})


def script(body: str, functions: str = "", parameters: str = "") -> str:
    """Return the script of a program with this body."""
    others = indent(functions.strip(), "    ")
    task = f"class Task(object):\n    def new_task(self):\n{indent(body.strip(), '        ')}\n\n{others}\n"
    return task + RUN.format(parameters=parameters.strip() or "pass").replace("        pass\n", "")


def document_of(text: str) -> dict[str, Any]:
    """Return what is drawn for a script."""
    parsed = parse_script(text, site())
    assert parsed.tree is not None, [each.message for each in parsed.diagnostics]
    return tree_to_document(parsed.tree, site())


def errors(text: str) -> list[Diagnostic]:
    """Return the errors of a script."""
    return [each for each in compile_document(document_of(text), site()).diagnostics if each.severity == "error"]


def waits(document: dict[str, Any]) -> list[float]:
    """Carry a program out that only waits and asks, and return for how many seconds it waits, in turn."""
    compiled = compile_document(document, site())
    assert compiled.plan is not None, [each.message for each in compiled.diagnostics]
    state, actions = machine.start(compiled.plan, {}, OVEN)
    waited = []
    while state.status == "running":
        timer = next((each for each in actions if isinstance(each, m.SetTimer)), None)
        question = next((each for each in actions if isinstance(each, m.AskPeople)), None)
        if question is not None:
            state, actions = machine.step(compiled.plan, state, m.Answered(question.question, 2))
        else:
            assert timer is not None
            waited.append(timer.seconds)
            state, actions = machine.step(compiled.plan, state, m.TimerFired(timer.timer))
    assert state.status == "finished", state
    return waited


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ('self.total = 0\nself.total = self.total + quantity(1, "min")\nself.wait(self.total)', [60]),
        ('self.total = quantity(1, "min") + self.total\nself.wait(30)', None),
        ('self.a = quantity(2, "min")\nself.a = quantity(30, "s")\nself.wait(self.a)', [30]),
        ('self.a = quantity(2, "min")\nself.b = self.a * 3\nself.wait(self.b)', [360]),
        ('self.b = self.a * 2\nself.a = quantity(2, "min")\nself.b = self.a\nself.wait(self.b)', None),
        ('for t in [quantity(1, "min"), quantity(30, "s")]:\n    self.wait(t)', [60, 30]),
        (
            'self.sum = 0\nfor t in [quantity(1, "min"), quantity(30, "s")]:\n    self.sum = self.sum + t\n'
            "self.wait(self.sum)",
            [90],
        ),
        ('self.n = quantity(3, "min") / quantity(30, "s")\nself.wait(self.n * quantity(1, "s"))', [6]),
        ('self.wait(quantity(50, "%") * quantity(2, "min"))', [60]),
        ('self.wait(quantity(3, "m") / self.curing_oven.speed)', [6]),
        ('self.wait(quantity(1, "km") / quantity(10, "m/s"))', [100]),
        ("self.wait(self.curing_oven.left)", [3]),
        ('self.wait(self.curing_oven.left + quantity(1, "min"))', [240]),
        ('self.left = quantity(1, "min")\nself.left = self.curing_oven.left\nself.wait(self.left)', [180]),
    ],
)
def test_what_is_waited_is_what_was_said(body: str, expected: list[float] | None) -> None:
    if expected is None:
        assert {each.code for each in compile_document(document_of(script(body)), site()).diagnostics} & {
            "unset_variable", "may_be_unset"
        }  # fmt: skip
    else:
        assert waits(document_of(script(body))) == pytest.approx(expected)


def test_a_result_is_kept_in_the_unit_of_its_variable() -> None:
    half = 'def half(self, of: Number("s")) -> Number("s"):\n    return of / 2'
    body = 'self.t = quantity(2, "min")\nself.t = self.half(of=self.t)\nself.wait(self.t)'
    assert waits(document_of(script(body, half))) == [60]


def test_an_answer_is_kept_in_the_unit_of_its_variable() -> None:
    body = 'self.t = quantity(30, "s")\nself.t = self.ask("How long?", type="number", unit="min")\nself.wait(self.t)'
    assert waits(document_of(script(body))) == [120]


@pytest.mark.parametrize(
    ("body", "parameters", "told", "waited"),
    [
        ('self.a = quantity(2, "min")\nself.a = 30\nself.wait(self.a)', "", ["plain_number"], [1800]),
        ("self.a = 30\nself.wait(self.a)", "", ["plain_number"], [30]),
        ("self.wait(self.pause)", 'self.pause = ctx.parameter("pause", 5, Number)', ["plain_number"], [5]),
        ('self.wait(quantity(2, "min") * quantity(3, "min"))', "", ["no_such_product"], None),
        ('self.wait(quantity(1, "h") / self.curing_oven.temperature)', "", ["no_such_product"], None),
        ('self.wait(quantity(5, "m"))', "", ["wrong_unit"], None),
        ('self.a = quantity(5, "m")\nself.a = quantity(5, "s")\nself.wait(self.a)', "", ["wrong_unit"] * 2, None),
        ('for _ in range(quantity(2, "min")):\n    self.wait(1)', "", ["unit_not_taken"], None),
        ('self.n = 2\nself.t = quantity(5, "min") + self.n\nself.wait(self.t)', "", ["plain_number"], None),
        ('self.t = quantity(0, "°C")\nself.t = 0\nself.notify(f"{self.t}")', "", ["plain_number"], None),
    ],
)
def test_a_number_that_lost_its_unit_is_refused_and_mended_by_one_click(
    body: str, parameters: str, told: list[str], waited: list[float] | None
) -> None:
    document = document_of(script(body, parameters=parameters))
    found = [each for each in compile_document(document, site()).diagnostics if each.severity == "error"]
    assert [each.code for each in found] == told
    if waited is not None:
        for each in found:
            assert each.fix is not None
            document["steps"][each.fix.step]["params"][each.fix.field] = each.fix.value
        assert waits(document) == pytest.approx(waited)


def test_a_function_says_in_which_unit_it_takes_a_number() -> None:
    plain = "def rest(self, t: Number):\n    self.notify(f'{t}')"
    assert [each.code for each in errors(script('self.rest(t=quantity(2, "min"))', plain))] == ["unit_not_taken"]
    told = 'def rest(self, t: Number("min")):\n    self.wait(t)'
    assert waits(document_of(script('self.rest(t=quantity(90, "s"))', told))) == [90]
    assert waits(document_of(script("self.rest(t=3)", told))) == [180]


SECONDS = st.sampled_from([unit for unit in UNITS.values() if unit.dimension == "time"])
AMOUNTS = st.integers(1, 500)


@given(st.lists(st.tuples(AMOUNTS, SECONDS, st.sampled_from(["+", "-", "max", "min"])), min_size=2, max_size=6))
def test_time_is_worked_out_whatever_unit_each_part_is_in(parts: list[tuple[int, Any, str]]) -> None:
    lines, total = [f'self.t = quantity({parts[0][0]}, "{parts[0][1].symbol}")'], parts[0][0] * parts[0][1].factor
    for amount, unit, name in parts[1:]:
        value = amount * unit.factor
        said = f'quantity({amount}, "{unit.symbol}")'
        if name in {"max", "min"}:
            lines.append(f"self.t = {name}(self.t, {said})")
            total = max(total, value) if name == "max" else min(total, value)
        else:
            lines.append(f"self.t = self.t {name} {said}")
            total = total + value if name == "+" else total - value
    lines.append('self.wait(max(self.t, quantity(0, "s")))')
    [waited] = waits(document_of(script("\n".join(lines))))
    assert isclose(waited, max(total, 0), rel_tol=1e-6, abs_tol=1e-4)
