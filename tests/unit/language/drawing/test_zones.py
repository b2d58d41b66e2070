"""Zones that a script draws: written, changed, added and taken out as steps are."""

from __future__ import annotations

from typing import Any

from editor.language import compile_document, parse_script, tree_to_document
from tests.kit.demo_site import factory

WET = {"name": "Wet floor", "rule": "keep_out", "points": [[1, 2], [4, 2], [4, 5]], "colour": "red"}
RAMP = {"name": "z2", "rule": "slow", "points": [[0, 0], [3, 0], [3, -3.5]], "speed_m_s": 0.3}
ODD = {"name": "Odd", "rule": "dance", "points": [[0, 0]]}
LINE = 'self.z2 = ctx.zone("z2", [(0, 0), (3, 0), (3, -3.5)], rule="slow", speed=0.3)'


def _document(**zones: Any) -> dict[str, Any]:
    wait = {"kind": "wait", "place": ["program", "body", "V"], "pos": [1, -1], "params": {"duration": 5}}
    return {"format": 2, "start_pos": [0, 0], "steps": {"w": wait}, "zones": zones}


def _script(*lines: str) -> str:
    given = "".join(f"        {line}\n" for line in lines)
    head = "class Task(object):\n    def new_task(self):\n        self.wait(5)\n\n    def run(self, ctx):\n"
    return f"{head}{given}        self.new_task()\n"


def _drawn(text: str, before: dict[str, Any] | None = None) -> dict[str, Any]:
    parsed = parse_script(text, factory())
    assert parsed.tree is not None, parsed.diagnostics
    drawn: Any = tree_to_document(parsed.tree, factory(), before)
    found: dict[str, Any] = drawn["zones"]
    return found


def test_a_script_has_every_zone_with_all_that_it_says() -> None:
    document = _document(z1=WET, z2=RAMP, z3=ODD)
    compiled = compile_document(document, factory())
    wet = 'self.wet_floor = ctx.zone("z1", [(1, 2), (4, 2), (4, 5)], rule="keep out", name="Wet floor")'
    assert compiled.script == _script(wet, LINE)
    assert _drawn(compiled.script, document) == document["zones"]
    assert parse_script(compiled.script, factory()).tree == compiled.tree


def test_a_program_that_is_only_text_has_its_zones_in_the_plan() -> None:
    text = _script('self.hall = ctx.zone("Hall", [(1, 2), (4, 2), (4, 5), (1, 5)], rule="one at a time")', LINE)
    zones = _drawn(text)
    square = [[1, 2], [4, 2], [4, 5], [1, 5]]
    assert zones == {"Hall": {"name": "Hall", "rule": "one_at_a_time", "points": square}, "z2": RAMP}
    plan = compile_document(_document(**zones), factory()).plan
    assert plan is not None
    assert [(zone.id, zone.rule, zone.speed_m_s) for zone in plan.zones] == [
        ("Hall", "one_at_a_time", None),
        ("z2", "slow", 0.3),
    ]


def test_a_line_that_is_changed_changes_only_what_it_says() -> None:
    slower = LINE.replace("speed=0.3", 'speed=0.2, name="Ramp"')
    wet = 'self.wet = ctx.zone("z1", [(1, 2), (4, 2), (4, 6)], rule="one_at_a_time", name="Wet floor")'
    zones = _drawn(_script(wet, slower), _document(z1=WET, z2=RAMP, z3=ODD))
    assert zones["z1"] == {**WET, "rule": "one_at_a_time", "points": [[1, 2], [4, 2], [4, 6]]}
    assert zones["z2"] == {**RAMP, "name": "Ramp", "speed_m_s": 0.2}
    assert zones["z3"] == ODD
    assert "speed_m_s" not in _drawn(_script(LINE.replace(", speed=0.3", "")), _document(z2=RAMP))["z2"]


def test_a_zone_goes_with_its_line_and_stays_where_it_is_only_named() -> None:
    before = _document(z1=WET, z2=RAMP, z3=ODD)
    assert _drawn(_script(LINE), before) == {"z2": RAMP, "z3": ODD}
    assert _drawn(_script('self.wet = ctx.zone("z1")'), before) == {"z1": WET, "z3": ODD}
    assert _drawn(_script('self.gone = ctx.zone("gone")'), before) == {"z3": ODD}
    assert _drawn(_script(LINE, 'self.again = ctx.zone("z2")'), before) == {"z2": RAMP, "z3": ODD}


def test_a_line_gives_a_zone_its_shape_that_had_none() -> None:
    zones = _drawn(_script(LINE.replace('"z2"', '"z3"')), _document(z3=ODD))
    assert zones == {"z3": {**RAMP, "name": "z3"}}


def test_steps_ask_about_a_zone_of_the_script() -> None:
    text = _script('self.turtle_bot_1 = ctx.get("robot01")', LINE).replace(
        "        self.wait(5)\n", "        if self.turtle_bot_1 in self.z2:\n            self.wait(5)\n"
    )
    parsed = parse_script(text, factory())
    assert parsed.tree is not None, parsed.diagnostics
    compiled = compile_document(tree_to_document(parsed.tree, factory()), factory())
    assert compiled.script == text
    assert compiled.plan is not None
