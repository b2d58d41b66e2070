"""How long a program takes from its document to what is wrong with it, a script and a plan, and back from a script."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

from bench.blockly import measure_blockly
from bench.figures import best_cpu_ms, figure
from bench.programs import make_chosen_machine, make_functions, make_program, with_step
from editor.language import Surroundings, compile_document, parse_script, surroundings_from_json
from editor.language.compiler import EditedProgram

Json = dict[str, Any]
SITE = Path(__file__).resolve().parent.parent / "examples" / "painting-factory.json"
CURVE = (10, 100, 500, 1000, 2000, 5000)
WAIT: Json = {"kind": "wait", "pos": [3, -3], "params": {"duration": 7}}
LINES = 5000


def measure() -> Iterator[dict[str, object]]:
    site = surroundings_from_json(json.loads(SITE.read_text()))
    yield from measure_curve(site)
    yield from measure_functions(site)
    yield from measure_edits(site)
    yield from measure_chosen_machines(site)
    yield from measure_parsing(site)
    yield from measure_blockly(1000)


def measure_curve(site: Surroundings) -> Iterator[dict[str, object]]:
    """Check, compile and print programs of more and more steps; twice the growth of a line would be 2."""
    per_step: list[float] = []
    for count in CURVE:
        document = make_program(count)
        assert compile_document(document, site).plan is not None
        took = best_cpu_ms(lambda document=document: compile_document(document, site), 25 if count < 2000 else 8)
        per_step.append(took / count)
        yield figure("check, compile and print", took, "ms", steps=count, us_per_step=round(took * 1000 / count, 2))
    yield figure("growth beyond a straight line", per_step[-1] / per_step[-2], "times", steps=list(CURVE[-2:]))


def measure_functions(site: Surroundings) -> Iterator[dict[str, object]]:
    """Compile programs that are made of functions: one after another, and each called by the one before it."""
    for count in (1000, 8000):
        for shape in ("one after another", "in a chain"):
            document = make_functions(count, chain=shape == "in a chain")
            assert compile_document(document, site).plan is not None
            took = best_cpu_ms(lambda document=document: compile_document(document, site), 5)
            yield figure(f"check, compile and print functions {shape}", took, "ms", functions=count)


def measure_edits(site: Surroundings) -> Iterator[dict[str, object]]:
    """Change one step of a program of 1,000, again and again, as in a room; until the diagnostics are there."""
    for name, edit in EDITS.items():
        times = [*_times_of(make_program(1000), edit, site)]
        yield figure(f"from an edit to diagnostics: {name}", min(times), "ms", steps=1000)


def measure_chosen_machines(site: Surroundings) -> Iterator[dict[str, object]]:
    """Change one step of a program at a machine that people choose, on sites of more and more machines."""
    oven = site.devices["curingOven01"]
    for machines in (0, 500):
        names = [f"oven{number}" for number in range(machines)]
        more = {name: replace(oven, description=replace(oven.description, id=name)) for name in names}
        where = replace(site, devices={**site.devices, **more})
        times = [*_times_of(make_chosen_machine(300), _other_minutes, where)]
        yield figure("from an edit to diagnostics at a chosen machine", min(times), "ms", steps=300, more=machines)


def _times_of(document: Json, edit: Callable[[Json, int], Json], site: Surroundings) -> Iterator[float]:
    program = EditedProgram()
    program.look(document, site).compiled(with_plan=False)
    for number in range(40):
        edited = edit(document, number)
        yield best_cpu_ms(lambda edited=edited: program.look(edited, site).diagnostics(), 1)


def _value(document: Json, number: int) -> Json:
    return with_step(document, "s503", {**document["steps"]["s503"], "params": {"duration": 7 + number}})


def _other_minutes(document: Json, number: int) -> Json:
    step = document["steps"]["o7"]
    params = {**step["params"], "args": {"time": {"quantity": [11 + number, "min"]}}}
    return with_step(document, "o7", {**step, "params": params})


def _new_step(document: Json, number: int) -> Json:
    return with_step(document, "new", {**WAIT, "place": ["s500", "then", f"z{number}"]})


def _moved_step(document: Json, number: int) -> Json:
    step = document["steps"]["s503"]
    return with_step(document, "s503", {**step, "place": [f"s{10 * number + 4}", "body", "zz"]})


def _gone_step(document: Json, number: int) -> Json:
    return with_step(document, f"s{500 + number}", None)


def _missing_value(document: Json, number: int) -> Json:
    return with_step(document, f"s{10 * number + 3}", {**document["steps"]["s503"], "params": {}})


EDITS: dict[str, Callable[[Json, int], Json]] = {
    "another value": _value,
    "a new step": _new_step,
    "a step elsewhere": _moved_step,
    "a step taken away": _gone_step,
    "a value taken away, which is told": _missing_value,
}


def measure_parsing(site: Surroundings) -> Iterator[dict[str, object]]:
    """Read a script back that was printed from a program without two like steps."""
    count = next(count for count in range(1000, 20000, 100) if _script(count, site).count("\n") >= LINES)
    script = _script(count, site)
    assert parse_script(script, site).tree is not None
    took = best_cpu_ms(lambda: parse_script(script, site), 10)
    lines = script.splitlines()
    yield figure("read a script", took, "ms", lines=len(lines), different_lines=len({*lines}))


def _script(count: int, site: Surroundings) -> str:
    return compile_document(make_program(count), site).script
