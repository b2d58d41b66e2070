"""Zones that a script draws: written, changed, added and taken out as steps are."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from editor.language import compile_document, parse_script, plan_from_json, plan_to_json, tree_to_document
from tests.kit.demo_site import factory, with_device
from vipo_device.protocol.description import Description, MethodSpec

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


GATE = {"name": "Gate", "rule": "door", "points": [[0, 0], [1, 0], [1, 2]], "door": "gate01"}
GATE_LINE = 'self.gate = ctx.zone("g", [(0, 0), (1, 0), (1, 2)], rule="door", door="gate01", name="Gate")'


def test_a_script_says_which_door_a_passage_has() -> None:
    document = _document(g=GATE)
    compiled = compile_document(document, factory())
    assert compiled.script == _script(GATE_LINE)
    assert _drawn(compiled.script, document) == document["zones"]
    assert _drawn(_script(GATE_LINE)) == {"g": GATE}
    assert _drawn(_script(GATE_LINE.replace("gate01", "gate02")), document)["g"] == {**GATE, "door": "gate02"}


def test_a_passage_whose_door_is_still_to_be_chosen_reads_back() -> None:
    open_yet = {key: value for key, value in GATE.items() if key != "door"}
    script = compile_document(_document(g=open_yet), factory()).script
    assert script == _script(GATE_LINE.replace('"gate01"', "None"))
    assert _drawn(script) == {"g": open_yet}


def test_a_door_goes_with_its_rule() -> None:
    slow = _drawn(_script(GATE_LINE.replace('rule="door", door="gate01"', 'rule="slow"')), _document(g=GATE))
    assert slow == {"g": {"name": "Gate", "rule": "slow", "points": GATE["points"]}}
    forgotten = {**GATE, "rule": "slow"}
    script = compile_document(_document(g=forgotten), factory()).script
    assert "door" not in script
    assert _drawn(script, _document(g=forgotten)) == {"g": forgotten}


def test_what_is_wrong_with_a_door_is_said_with_what_to_write() -> None:
    def said(line: str) -> str:
        return "\n".join(d.message for d in parse_script(_script(line), factory()).diagnostics)

    assert 'door="gate01"' in said(GATE_LINE.replace(', door="gate01"', ""))
    assert 'Only a passage has a door: rule="door".' in said(GATE_LINE.replace('rule="door"', 'rule="slow"'))
    assert 'Write the id of the device that opens: door="gate01".' in said(GATE_LINE.replace('"gate01"', "7"))
    assert 'Write the id of the device that opens: door="gate01".' in said(GATE_LINE.replace('"gate01"', '""'))


def test_the_plan_has_the_door_and_older_plans_have_none() -> None:
    document = _document(g=GATE, z2=RAMP)
    steps = {"w": {"kind": "wait", "place": ["program", "body", "V"], "pos": [1, -1], "params": {"duration": 5}}}
    site = with_device("curingOven01", description=_opening(factory().devices["curingOven01"].description))
    gate = {**GATE, "door": "curingOven01"}
    plan = compile_document({**document, "steps": steps, "zones": {"g": gate, "z2": RAMP}}, site).plan
    assert plan is not None
    kept = plan_to_json(plan)
    assert [zone.get("door") for zone in kept["zones"]] == ["curingOven01", None]
    assert "door" not in kept["zones"][1]
    assert plan_from_json(kept) == plan


def _opening(oven: Description) -> Description:
    return replace(oven, methods=(MethodSpec("openLid", "x"), MethodSpec("closeLid", "y")))
