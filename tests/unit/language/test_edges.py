"""The edges of the language, found by changing it and seeing that no test noticed."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from editor.language import compile_document, parse_script, tree_to_document
from editor.language.expressions.nodes import MISSING, Constant, Operation, Reading
from editor.language.expressions.ranges import ANY, Here, Range
from editor.language.expressions.values import LARGEST, is_number, read_value
from editor.language.parsing.script import LONGEST_SCRIPT
from tests.kit.demo_site import codes, factory, with_device
from vipo_device.protocol.description import ParameterSpec
from vipo_device.protocol.units import conversion, convert

EMPTY = "class Task(object):\n    def new_task(self):\n        pass\n"
CARRY = {"role": "robot", "object": "box", "quantity": 1}
TIMES = [{"quantity": [1, "SEC"]}, {"quantity": [2, "SEC"]}]
SHELF, BOOTH = {"device": "itemInventory01"}, {"device": "paintMachine01"}


def program(*steps: tuple[str, dict[str, Any]]) -> dict[str, Any]:
    body = {
        f"s{i}": {"kind": kind, "place": ["program", "body", f"{i}V"], "params": params}
        for i, (kind, params) in enumerate(steps)
    }
    return {"format": 2, "steps": body}


def refused(text: str) -> str:
    parsed = parse_script(text, factory())
    assert parsed.tree is None
    return parsed.diagnostics[0].message


@pytest.mark.parametrize(
    ("value", "source", "target", "expected"),
    [(1500, "MilliM-PER-SEC", "M-PER-SEC", 1.5), (2, "M-PER-SEC", "MilliM-PER-SEC", 2000)],
)
def test_speeds_are_converted(value: float, source: str, target: str, expected: float) -> None:
    assert convert(value, source, target) == expected


def test_a_unit_goes_over_into_itself_unchanged() -> None:
    assert conversion("MIN", "MIN") == (1, 0)
    assert conversion("widgets", "widgets") == (1, 0)


@pytest.mark.parametrize(
    ("value", "is_one"),
    [(LARGEST, True), (-LARGEST, True), (LARGEST * 2, False), (-LARGEST * 2, False), (True, False), ("1", False)],
)
def test_a_number_is_one_up_to_the_largest(value: object, is_one: bool) -> None:
    assert is_number(value) is is_one


def test_a_number_beyond_the_largest_reads_as_missing() -> None:
    assert read_value({"op": "+", "args": [LARGEST * 10, 1]}, {}) != read_value({"op": "+", "args": [1, 1]}, {})
    assert read_value(LARGEST * 10, {}) == MISSING


@pytest.mark.parametrize("name", ["min", "max", "nearest"])
def test_one_thing_alone_has_no_least_and_no_nearest(name: str) -> None:
    assert read_value({"op": name, "args": [1]}, {}) == MISSING


def test_only_readings_that_are_numbers_have_a_range() -> None:
    temperature = Reading(Constant("curingOven01"), "temperature")
    assert Here(factory()).range(temperature) == Range(15.0, 250.0)
    assert Here(factory()).range(Reading(Constant("curingOven01"), "quality")) == ANY
    assert Here(factory()).range(Operation("abs", (Constant(-3),))) == Range(3, 3)


def test_run_gives_nothing_after_new_task_was_called() -> None:
    text = (
        "class Task(object):\n    def new_task(self):\n        self.robot.move(self.dock.location)\n\n"
        '    def run(self, ctx):\n        """Runs."""\n        self.new_task()\n'
        '        self.robot = ctx.get("robot01")\n        self.dock = ctx.place("dock1")\n'
    )
    assert refused(text).startswith("Line 8, column 9: ")
    assert refused(text).endswith("self.new_task() ends run. Put this before it, or leave it out.")


@pytest.mark.parametrize("call", ['ctx.place("")', 'ctx.get("")', 'ctx.zone("")', 'ctx.place("dock1", at="x")'])
def test_what_run_gives_has_a_name(call: str) -> None:
    text = f"{EMPTY}\n    def run(self, ctx):\n        self.x = {call}\n"
    assert refused(text).startswith(f"Line 6, column 18: “{call.replace(chr(34), chr(39))}”")


def test_a_refusal_quotes_the_first_line_only() -> None:
    body = "        with a:\n            b()\n            c()\n"
    text = EMPTY.replace("        pass\n", body) + "\n    def run(self, ctx):\n        self.new_task()\n"
    assert "“with a:”" in refused(text)


@pytest.mark.parametrize(("seconds", "found"), [(0, []), (0.5, []), (1, []), (-1, [("s0", "out_of_range")])])
def test_a_wait_may_be_short_but_not_negative(seconds: float, found: list[tuple[str, str]]) -> None:
    assert codes(program(("wait", {"duration": seconds}))) == found


def test_what_a_robot_carries_is_counted_one_by_one() -> None:
    pick, drop = ("pick", {**CARRY, "at": SHELF}), ("drop", {**CARRY, "at": BOOTH})
    assert codes(program(pick, pick, drop, drop)) == []
    assert codes(program(pick, pick, pick)) == [("s2", "carrying_too_much")]
    assert codes(program(pick, pick, drop, drop, drop)) == [("s4", "drops_nothing")]


def test_two_waits_of_one_branch_do_not_wait_for_each_other() -> None:
    waits = {"until": {"op": "==", "args": [{"param": "x"}, 1]}}
    steps = {
        "i": {"kind": "set", "place": ["program", "body", "1V"], "params": {"variable": "x", "value": 0}},
        "p": {"kind": "parallel", "place": ["program", "body", "2V"], "params": {"branches": ["a", "b"]}},
        "w": {"kind": "wait", "place": ["p", "a", "1V"], "params": waits},
        "v": {"kind": "wait", "place": ["p", "a", "2V"], "params": waits},
        "s": {"kind": "set", "place": ["p", "b", "1V"], "params": {"variable": "x", "value": 1}},
    }
    assert codes({"format": 2, "steps": steps}) == []


def test_new_steps_never_lie_on_each_other() -> None:
    lines = "\n".join("        self.curing_oven.cure_paint(10)" for _ in range(30))
    text = (
        f"class Task(object):\n    def new_task(self):\n{lines}\n\n"
        '    def run(self, ctx):\n        self.curing_oven = ctx.get("curingOven01")\n        self.new_task()\n'
    )
    parsed = parse_script(text, factory())
    assert parsed.tree is not None
    spots = [step["pos"] for step in tree_to_document(parsed.tree, factory())["steps"].values()]
    near = [
        (a, b) for i, a in enumerate(spots) for b in spots[i + 1 :] if abs(a[0] - b[0]) < 2.0 and abs(a[1] - b[1]) < 0.5
    ]
    assert (len(spots), near) == (30, [])


@pytest.mark.parametrize("given", ["", "self, a, /", "self, *a", "self, *, a", "this"])
def test_parameters_of_other_forms_are_refused(given: str) -> None:
    text = f"{EMPTY}\n    def dry({given}):\n        pass\n\n    def run(self, ctx):\n        self.new_task()\n"
    assert refused(text).startswith("Line 5, column 5: This form of parameters is not part of the language.")


def test_a_role_and_a_variable_of_one_name_are_told_apart() -> None:
    document = program(
        ("set", {"variable": "carrier", "value": 1}),
        ("move", {"role": "r1", "to": {"place": "dock1"}}),
        ("notify", {"message": {"op": "text", "args": [{"param": "carrier"}]}, "level": "info"}),
    )
    document["roles"] = {"r1": {"name": "Carrier", "can": []}}
    compiled = compile_document(document, factory())
    assert compiled.script.splitlines()[2:5] == [
        "        self.carrier = 1",
        "        self.Carrier.move(self.dock_1.location)",
        '        self.notify(f"{self.carrier}", level="info")',
    ]
    assert parse_script(compiled.script, factory()).tree == compiled.tree


def test_a_robot_in_a_value_is_its_role_where_steps_drive_it() -> None:
    far = {"op": ">", "args": [{"op": "distance", "args": [{"at": {"role": "r1"}}, {"at": SHELF}]}, 2]}
    driven = program(("move", {"role": "r1", "to": {"place": "dock1"}}), ("wait", {"until": far, "timeout": 60}))
    driven["roles"] = {"r1": {"name": "Carrier", "can": []}}
    compiled = compile_document(driven, factory())
    assert compiled.diagnostics == ()
    assert "self.wait(until=distance(self.Carrier, self.item_inventory) > 2, timeout=60)" in compiled.script
    idle = program(("wait", {"until": far, "timeout": 60}))
    idle["roles"] = {"r1": {"name": "Carrier", "device": "robot02"}}
    assert "distance(self.turtle_bot_2, self.item_inventory) > 2" in compile_document(idle, factory()).script


def test_what_a_role_can_is_read_only_where_it_is_a_text() -> None:
    document = program(("move", {"role": "r1", "to": {"place": "dock1"}}))
    document["roles"] = {"r1": {"name": "Carrier", "can": ["pick", "", 3, None, "pick"]}}
    assert [role.can for role in compile_document(document, factory()).tree.roles if role.id == "r1"] == [
        ("pick", "move")
    ]


def test_what_a_pick_and_drop_lacks_is_told_once() -> None:
    params = {"role": "robot", "source": SHELF, "target": BOOTH}
    assert codes(program(("pick_and_drop", params))) == [("s0", "missing_object"), ("s0", "missing_quantity")]


def test_a_machine_that_a_parameter_names_is_written_by_its_name() -> None:
    document = program(("call", {"function": "f", "args": {"machine": {"device": "paintMixer01"}}}))
    operate = {"device": {"param": "machine"}, "method": "mixPaint", "args": {"time": 3}}
    document["steps"]["o"] = {"kind": "operate", "place": ["f", "body", "1V"], "params": operate}
    document["functions"] = {"f": {"name": "mix", "parameters": [{"name": "machine", "type": "device"}]}}
    assert (
        '        machine.operate("mixPaint", {"time": 3})' in compile_document(document, factory()).script.splitlines()
    )


def test_a_function_is_found_again_only_by_what_it_has_in_common() -> None:
    text = f"{EMPTY}\n    def {{}}(self):\n        {{}}\n\n    def run(self, ctx):\n        self.new_task()\n"
    before = parse_script(text.format("dry", "self.wait(1)"), factory()).tree
    same = parse_script(text.format("rest", "self.wait(1)"), factory()).tree
    other = parse_script(text.format("rest", 'self.notify("x", level="info")'), factory()).tree
    assert before is not None
    assert same is not None
    assert other is not None
    document = tree_to_document(before, factory())
    assert list(tree_to_document(same, factory(), document)["functions"]) == list(document["functions"])
    assert list(tree_to_document(other, factory(), document)["functions"]) == ["rest"]


def test_the_most_that_a_robot_may_carry_counts_what_it_may_have_had_before() -> None:
    drop = {**CARRY, "at": BOOTH}
    document = program(("ask", {"question": "Two?", "answer": {"type": "boolean"}, "variable": "two"}))
    document["steps"] |= {
        "i": {"kind": "if", "place": ["program", "body", "1V"], "params": {"condition": {"param": "two"}}},
        "p": {"kind": "pick", "place": ["i", "then", "1V"], "params": {**CARRY, "at": SHELF}},
        "q": {"kind": "pick", "place": ["program", "body", "2V"], "params": {**CARRY, "at": SHELF}},
        "d": {"kind": "drop", "place": ["program", "body", "3V"], "params": drop},
        "e": {"kind": "drop", "place": ["program", "body", "4V"], "params": drop},
    }
    assert codes(document) == [("e", "may_drop_nothing")]


def test_what_a_function_picks_is_known_behind_its_call() -> None:
    document = program(("call", {"function": "f"}), ("drop", {**CARRY, "at": BOOTH, "quantity": 2}))
    fetch = {"kind": "pick", "place": ["f", "body", "V"], "params": {**CARRY, "at": SHELF}}
    steps = {**document["steps"], "fetch": fetch}
    called = {**document, "steps": steps, "functions": {"f": {"name": "fetch", "parameters": []}}}
    assert ("s1", "drops_nothing") in codes(called)
    steps["fetch"] = {**fetch, "params": {**fetch["params"], "quantity": 2}}
    assert not [code for code in codes(called) if "drop" in code[1] or "carr" in code[1]]


def test_the_chip_of_an_order_stands_right_above_its_machine() -> None:
    oven = factory().devices["curingOven01"].description
    text = EMPTY.replace("pass", "self.oven.cure_paint(10)")
    run = '    def run(self, ctx):\n        self.oven = ctx.get("curingOven01")\n        self.new_task()\n'
    tree = parse_script(text + run, factory()).tree
    assert tree is not None
    steps = tree_to_document(tree, factory())["steps"]
    assert isinstance(steps, dict)
    x, y = next(iter(steps.values()))["pos"]
    above = oven.pose.y + oven.size.y / 2
    assert x == oven.pose.x
    assert above < y < above + 1


@pytest.mark.parametrize("given", ["self", "self, c", "self, d", "self, ctx, more", "ctx, self"])
def test_run_takes_the_task_and_its_context(given: str) -> None:
    assert "Write def run(self, ctx):." in refused(f"{EMPTY}    def run({given}):\n        self.new_task()\n")


def test_a_script_may_be_long_but_not_endless() -> None:
    assert "The script is too long." in refused("#" * (LONGEST_SCRIPT + 1))
    assert "The script is too long." not in refused("#" * LONGEST_SCRIPT)


def test_only_the_variable_of_the_loop_belongs_to_the_loop() -> None:
    document = program(("for_each", {"variable": "minutes", "items": TIMES}))
    place = ["s0", "body", "V"]
    document["steps"]["a"] = {"kind": "set", "place": place, "params": {"variable": "count", "value": 1}}
    document["steps"]["b"] = {"kind": "set", "place": place, "params": {"variable": "minutes", "value": 3}}
    lines = compile_document(document, factory()).script.splitlines()
    assert lines[3:5] == ["            self.count = 1", "            minutes = 3"]


def test_nothing_is_known_of_loads_behind_calls_as_deep_as_can_be() -> None:
    hot = {"op": ">", "args": [{"property": ["curingOven01", "temperature"]}, 30]}
    drop = {**CARRY, "at": BOOTH, "quantity": 2}
    document = program(("pick", {**CARRY, "at": SHELF}), ("call", {"function": "f"}), ("drop", drop))
    document["functions"] = {"f": {"name": "again", "parameters": []}}
    document["steps"]["i"] = {"kind": "if", "place": ["f", "body", "V"], "params": {"condition": hot}}
    document["steps"]["c"] = {"kind": "call", "place": ["i", "then", "V"], "params": {"function": "f"}}
    document["steps"]["d"] = {"kind": "wait", "place": ["i", "else", "V"], "params": {"duration": 1}}
    assert [code for step, code in codes(document) if step == "s2" and "drop" in code] == ["drops_nothing"]
    more = {"kind": "pick", "place": ["i", "else", "V"], "params": {**CARRY, "at": SHELF}}
    document["steps"]["d"] = more
    assert [code for step, code in codes(document) if step == "s2" and "drop" in code] == []


def test_a_step_without_a_role_drives_the_robot_whose_place_can_be_asked_for() -> None:
    far = {"op": ">", "args": [{"op": "distance", "args": [{"at": {"role": "robot"}}, {"at": BOOTH}]}, 2]}
    document = program(("move", {"role": "", "to": SHELF}), ("wait", {"until": far}))
    assert "distance(self.robot, self." in compile_document(document, factory()).script


def test_a_loop_hides_what_is_known_of_a_name() -> None:
    parameters = {"p": {"name": "minutes", "type": "text"}}
    wait = {"duration": {"param": "minutes"}}
    document = program(("for_each", {"variable": "minutes", "items": TIMES}))
    document["steps"]["w"] = {"kind": "wait", "place": ["s0", "body", "V"], "params": wait}
    assert codes({**document, "parameters": parameters}) == []
    assert codes({**program(("wait", wait)), "parameters": parameters}) == [("s0", "wrong_type")]


def test_what_need_not_be_given_is_left_out_only_at_the_end() -> None:
    description = factory().devices["curingOven01"].description
    method = replace(
        description.methods[0],
        parameters=tuple(ParameterSpec(name, "number", required=name == "a") for name in ("a", "b", "c")),
    )
    site = with_device("curingOven01", description=replace(description, methods=(method,)))
    params = {"device": {"device": "curingOven01"}, "method": method.name}
    given = [{"a": 1}, {"a": 1, "b": 2}, {"a": 1, "c": 3}]
    document = program(*(("operate", {**params, "args": args}) for args in given))
    lines = compile_document(document, site).script.splitlines()[2:5]
    assert [line[line.index("(") :] for line in lines] == ["(1)", "(1, 2)", "(1, None, 3)"]


def test_branches_are_handed_names_as_they_are() -> None:
    head = f"{EMPTY.replace('pass', 'for x in [1]:')}            "
    branches = "".join(f"    def branch_1a_1{letter}(self, x):\n        self.wait(x)\n" for letter in "ab")
    run = "    def run(self, ctx):\n        self.new_task()\n"
    call = "self.parallel(self.branch_1a_1a, self.branch_1a_1b, x={})\n"
    assert parse_script(f"{head}{call.format('x')}{branches}{run}", factory()).diagnostics == ()
    for other in ("self", "1"):
        assert "a method for each branch." in refused(f"{head}{call.format(other)}{branches}{run}")


def test_a_plan_says_what_its_values_look_at() -> None:
    hot = {"op": ">", "args": [{"property": ["curingOven01", "temperature"]}, 30]}
    both = {"op": "and", "args": [hot, {"op": "not", "args": [{"op": "<", "args": hot["args"]}]}]}
    plan = compile_document(program(("wait", {"until": both})), factory()).plan
    assert plan is not None
    assert plan.reads == (("curingOven01", "temperature"),)
