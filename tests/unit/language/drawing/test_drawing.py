"""A script that was edited, drawn over the document that it was printed from: only what was edited changes."""

from __future__ import annotations

import json
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from editor.language import compile_document, parse_script, tree_to_document
from editor.language.document.format_migrations import migrate
from editor.language.drawing.alignment import common_row
from editor.language.drawing.merge import with_named_zones
from tests.kit.demo_site import factory
from tests.unit.language.strategies import broken_documents, documents, json_values

TASK = {
    "role": "robot",
    "source": {"device": "itemInventory01"},
    "target": {"device": "paintMachine01"},
    "object": "box",
    "quantity": 1,
}


def step(kind: str, parent: str, order: str, params: dict[str, Any], branch: str = "body") -> dict[str, Any]:
    return {"kind": kind, "place": [parent, branch, order], "pos": [float(ord(order[0])), -3.0], "params": params}


def order_of_paint() -> dict[str, Any]:
    oven = {"device": {"device": "curingOven01"}, "method": "curePaint", "args": {"time": 10}}
    hot = {"op": ">", "args": [{"property": ["curingOven01", "temperature"]}, 60]}
    return {
        "format": 2,
        "start_pos": [1.0, -1.0],
        "steps": {
            "task": step("pick_and_drop", "program", "1", {**TASK, "route": [[2, -3]]}),
            "cure": step("operate", "program", "3", oven),
            "hot": step("if", "program", "5", {"condition": hot}),
            "cool": step("wait", "hot", "V", {"duration": 30}, "then"),
            "mix": step("call", "program", "7", {"function": "f-mix", "args": {"Pause length": 3}}),
            "last": step("wait", "program", "9", {"duration": 5}),
            "inner": step("wait", "f-mix", "V", {"duration": {"param": "Pause length"}}),
            "draft": {"kind": "wait", "place": None, "pos": [8.0, -8.0], "params": {"duration": 99}},
            "note": {"kind": "comment", "place": None, "pos": [9.0, -9.0], "params": {"text": "Mind the gap"}},
            "odd": {"kind": "hologram", "place": ["program", "body", "4"], "pos": [7.0, -7.0], "params": {"x": 1}},
        },
        "functions": {
            "f-mix": {
                "name": "Mix paint",
                "parameters": [{"name": "Pause length", "type": "number", "unit": "MIN", "default": 2}],
                "source": {"library": "l1", "version": 3},
            }
        },
        "roles": {"spare": {"name": "spare robot", "can": ["pick"]}},
        "parameters": {},
        "zones": {"z1": {"name": "Slow", "rule": "slow", "points": [[0, 0], [1, 0], [1, 1]]}},
    }


def redraw(document: dict[str, Any], *changes: tuple[str, str], times: int = 1) -> dict[str, Any]:
    """Print the document, change its text, and draw it again; what changes stands in it so many times."""
    text = compile_document(document, factory()).script
    for old, new in changes:
        assert text.count(old) == times, f"{old!r} is {text.count(old)} times in\n{text}"
        text = text.replace(old, new)
    parsed = parse_script(text, factory())
    assert parsed.tree is not None, parsed.diagnostics
    return tree_to_document(parsed.tree, factory(), document)


def differences(before: Any, after: Any, path: str = "") -> list[str]:
    """Say where two documents differ."""
    if isinstance(before, dict) and isinstance(after, dict):
        keys = sorted({*before, *after})
        return [d for key in keys for d in differences(before.get(key), after.get(key), f"{path}.{key}".strip("."))]
    if before == after and type(before) is type(after):
        return []
    return [f"+{path}" if before is None else f"-{path}" if after is None else path]


CURE = "        self.curing_oven.cure_paint(10)\n"
LAST = "        self.wait(5)\n"
CALL = "        self.mix_paint(pause_length=3)\n"


def test_a_script_that_was_not_edited_changes_nothing() -> None:
    assert redraw(order_of_paint()) == order_of_paint()


def test_one_number_changes_one_value() -> None:
    after = redraw(order_of_paint(), ("cure_paint(10)", "cure_paint(12)"))
    assert differences(order_of_paint(), after) == ["steps.cure.params.args.time"]
    assert after["steps"]["cure"]["params"]["args"] == {"time": 12}


def test_true_is_another_value_than_1() -> None:
    after = redraw(order_of_paint(), ("cure_paint(10)", "cure_paint(True)"))
    again = redraw(after, ("cure_paint(True)", "cure_paint(1)"))
    assert differences(after, again) == ["steps.cure.params.args.time"]


def test_a_line_in_the_middle_is_one_new_step() -> None:
    after = redraw(order_of_paint(), (CURE, f"{CURE}        self.wait(7)\n"))
    new = after["steps"].pop("s1")
    assert differences(order_of_paint(), after) == []
    assert (new["kind"], new["params"], new["place"]) == ("wait", {"duration": 7}, ["program", "body", "4"])
    others = [each["pos"] for each in after["steps"].values()]
    assert all(abs(new["pos"][0] - x) >= 2.6 or abs(new["pos"][1] - y) >= 0.8 for x, y in others)


def test_two_lines_that_are_swapped_keep_their_ids() -> None:
    after = redraw(order_of_paint(), (CURE, ""), (LAST, LAST + CURE))
    assert differences(order_of_paint(), after) == ["steps.cure.place"]
    assert after["steps"]["cure"]["place"][2] > after["steps"]["last"]["place"][2]


def test_neighbours_that_are_swapped_keep_their_ids() -> None:
    after = redraw(order_of_paint(), (CALL + LAST, LAST + CALL))
    assert [d for d in differences(order_of_paint(), after) if not d.endswith(".place")] == []
    assert after["steps"]["last"]["place"] < after["steps"]["mix"]["place"]


def test_three_lines_that_are_wrapped_in_an_if_keep_ids_and_positions() -> None:
    before = order_of_paint()
    for name, order in (("w1", "A"), ("w2", "B"), ("w3", "C")):
        before["steps"][name] = step("wait", "program", order, {"duration": ord(order)})
    lines = [f"        self.wait({ord(order)})\n" for order in "ABC"]
    wrapped = "        if self.curing_oven.temperature < 20:\n" + "".join(f"    {line}" for line in lines)
    after = redraw(before, ("".join(lines), wrapped))
    assert differences(before, after) == ["+steps.s1", "steps.w1.place", "steps.w2.place", "steps.w3.place"]
    assert [after["steps"][name]["place"][:2] for name in ("w1", "w2", "w3")] == [["s1", "then"]] * 3
    assert after["steps"]["s1"]["kind"] == "if"


def test_an_if_that_is_taken_away_leaves_its_steps() -> None:
    text = "        if self.curing_oven.temperature > 60:\n            self.wait(30)\n"
    after = redraw(order_of_paint(), (text, "        self.wait(30)\n"))
    assert differences(order_of_paint(), after) == ["steps.cool.place", "-steps.hot"]
    assert after["steps"]["cool"]["place"] == ["program", "body", "5"]


def test_an_if_whose_condition_changes_keeps_what_stands_in_it() -> None:
    after = redraw(order_of_paint(), ("temperature > 60", "temperature > 65"))
    assert differences(order_of_paint(), after) == ["steps.hot.params.condition.args"]


def test_a_line_that_is_deleted_takes_its_step_alone() -> None:
    assert differences(order_of_paint(), redraw(order_of_paint(), (CURE, ""))) == ["-steps.cure"]


def test_a_new_load_stays_the_same_pick_and_drop() -> None:
    text = compile_document(order_of_paint(), factory()).script
    parsed = parse_script(text.replace('"value": 1', '"value": 2'), factory())
    assert parsed.tree is not None
    after = tree_to_document(parsed.tree, factory(), order_of_paint())
    assert differences(order_of_paint(), after) == ["steps.task.params.quantity"]


def test_a_function_that_is_renamed_keeps_its_steps() -> None:
    text = compile_document(order_of_paint(), factory()).script.replace("mix_paint", "stir_paint")
    tree = parse_script(text, factory()).tree
    assert tree is not None
    after = tree_to_document(tree, factory(), order_of_paint())
    assert differences(order_of_paint(), after) == ["functions.f-mix.name"]
    assert after["functions"]["f-mix"]["name"] == "stir_paint"


def test_a_function_that_goes_takes_its_steps_along() -> None:
    body = '    def mix_paint(self, pause_length: Number("MIN")=2):\n        self.wait(pause_length)\n\n'
    script = compile_document(order_of_paint(), factory()).script
    start = script.index("    def mix_paint")
    body = script[start : script.index("    def run")]
    after = redraw(order_of_paint(), (body, ""), (CALL, ""))
    assert differences(order_of_paint(), after) == ["-functions.f-mix", "-steps.inner", "-steps.mix"]


def test_a_changed_argument_keeps_the_name_that_the_document_has_for_it() -> None:
    after = redraw(order_of_paint(), ("pause_length=3", "pause_length=4"))
    assert differences(order_of_paint(), after) == ["steps.mix.params.args.Pause length"]


def test_a_value_that_is_new_speaks_of_parameters_by_the_documents_names() -> None:
    after = redraw(order_of_paint(), ("self.wait(pause_length)", "self.wait(pause_length + 1)"))
    assert {d.split(".")[1] for d in differences(order_of_paint(), after)} == {"inner"}
    wanted = {"op": "+", "args": [{"param": "Pause length"}, 1]}
    assert after["steps"]["inner"]["params"]["duration"] == wanted


def test_a_role_can_be_bound_to_a_robot() -> None:
    after = redraw(order_of_paint(), ('self.robot = ctx.any("pick", "drop")', 'self.robot = ctx.get("robot01")'))
    assert differences(order_of_paint(), after) == ["+roles.robot"]
    assert after["roles"]["robot"] == {"name": "robot", "device": "robot01"}


def test_a_role_that_is_renamed_is_one_value_of_each_step() -> None:
    before = order_of_paint()
    before["roles"]["carrier"] = {"name": "box carrier", "can": ["pick", "drop"]}
    before["steps"]["task"]["params"]["role"] = "carrier"
    text = compile_document(before, factory()).script.replace("box_carrier", "porter")
    tree = parse_script(text, factory()).tree
    assert tree is not None
    assert differences(before, tree_to_document(tree, factory(), before)) == ["roles.carrier.name"]


def test_a_pick_and_drop_that_counts_by_a_robots_reading_names_its_role_by_its_id() -> None:
    before = order_of_paint()
    before["roles"]["carrier"] = {"name": "box carrier", "can": ["pick", "drop"]}
    counted = {"role": "carrier", "quantity": {"property": [{"role": "carrier"}, "battery"]}}
    before["steps"]["task"]["params"].update(counted)
    after = redraw(before, ("box_carrier.battery", "box_carrier.battery + 1"), times=2)
    assert after["steps"]["task"]["params"]["quantity"] == {"op": "+", "args": [counted["quantity"], 1]}


def test_variables_keep_the_names_that_the_document_has_for_them() -> None:
    before = order_of_paint()
    before["steps"]["set"] = step("set", "program", "A", {"variable": "My count", "value": 1})
    before["steps"]["if"] = step(
        "while", "program", "B", {"condition": {"op": "<", "args": [{"param": "My count"}, 9]}}
    )
    after = redraw(before, ("self.my_count < 9", "self.my_count < 8"), ("self.my_count = 1\n", "self.my_count = 2\n"))
    assert after["steps"]["set"]["params"] == {"variable": "My count", "value": 2}
    assert after["steps"]["if"]["params"] == {"condition": {"op": "<", "args": [{"param": "My count"}, 8]}}
    more = redraw(before, ("self.my_count = 1\n", "self.my_count = 1\n        self.my_count = self.my_count + 1\n"))
    new = more["steps"]["s1"]["params"]
    assert new == {"variable": "My count", "value": {"op": "+", "args": [{"param": "My count"}, 1]}}


def test_events_keep_their_ids_and_bodies() -> None:
    before = order_of_paint()
    hot = {"op": ">", "args": [{"property": ["curingOven01", "temperature"]}, 80]}
    event = {"kind": "on_event", "place": ["program", "events", "V"], "pos": [3.0, -2.0]}
    before["steps"]["e"] = {**event, "params": {"condition": hot, "starts": "branch"}}
    before["steps"]["tell"] = step("notify", "e", "V", {"message": "Hot!", "level": "warning"})
    assert redraw(before) == before
    after = redraw(before, ("temperature > 80", "temperature > 85"), ('"Hot!"', '"Very hot!"'))
    assert {d.split(".")[1] for d in differences(before, after)} == {"e", "tell"}


def test_separate_picks_and_drops_stay_separate() -> None:
    before = order_of_paint()
    load = {"role": "robot", "object": "box", "quantity": 1}
    before["steps"]["task"] = step("pick", "program", "1", {**load, "at": {"device": "itemInventory01"}})
    before["steps"]["way"] = step("move", "program", "11", {"role": "robot", "to": {"device": "paintMachine01"}})
    before["steps"]["put"] = step("drop", "program", "12", {**load, "at": {"device": "paintMachine01"}})
    assert redraw(before) == before
    assert differences(before, redraw(before, (LAST, "        self.wait(6)\n"))) == ["steps.last.params.duration"]


def test_a_wait_in_the_middle_of_a_pick_and_drop_parts_it() -> None:
    drop = '        self.robot.drop({"value": 1, "object": "box"})\n'
    after = redraw(order_of_paint(), (drop, f"        self.wait(1)\n{drop}"))
    kinds = {name: after["steps"][name]["kind"] for name in after["steps"].keys() - order_of_paint()["steps"].keys()}
    assert sorted(kinds.values()) == ["drop", "move", "pick", "wait"]
    assert "task" not in after["steps"]


def test_drafts_do_not_come_into_the_program_by_the_way() -> None:
    before = order_of_paint()
    before["steps"]["p"] = step("parallel", "program", "Z", {"branches": ["a", "c"]})
    before["steps"]["pa"] = step("wait", "p", "V", {"duration": 1}, "a")
    before["steps"]["pc"] = step("wait", "p", "V", {"duration": 2}, "c")
    before["steps"]["lost"] = step("wait", "p", "V", {"duration": 3}, "b")
    assert redraw(before) == before
    call = "self.parallel(self.branch_6a, self.branch_6b)"
    third = "    def run(self, ctx):"
    changes = (call, f"{call[:-1]}, self.branch_6c)"), (third, f"    def branch_6c(self):\n        pass\n\n{third}")
    after = redraw(before, *changes)
    assert after["steps"]["p"]["params"]["branches"] == ["a", "c", "b"]
    assert differences(before, after) == ["-steps.lost.place", "steps.p.params.branches"]


def test_a_script_without_a_document_before_is_drawn_anew() -> None:
    tree = parse_script(compile_document(order_of_paint(), factory()).script, factory()).tree
    assert tree is not None
    drawn = tree_to_document(tree, factory())
    steps: Any = drawn["steps"]
    assert sorted(each["kind"] for each in steps.values()) == [
        "call", "if", "operate", "pick_and_drop", "wait", "wait", "wait"
    ]  # fmt: skip
    spots = [tuple(each["pos"]) for each in steps.values()]
    assert len(set(spots)) == len(spots)


@pytest.mark.parametrize(
    ("first", "second", "row"),
    [
        ("abc", "abc", [(0, 0), (1, 1), (2, 2)]),
        ("abc", "ac", [(0, 0), (2, 1)]),
        ("axb", "ayb", [(0, 0), (2, 2)]),
        ("ab", "ba", [(1, 0)]),
        ("", "a", []),
        ("xaby", "zabw", [(1, 1), (2, 2)]),
    ],
)
def test_a_longest_common_row(first: str, second: str, row: list[tuple[int, int]]) -> None:
    assert common_row(first, second) == row


def test_what_a_wait_is_for_gets_no_sense_from_a_name_that_is_new() -> None:
    def waiting(until: object, parameter: str) -> dict[str, Any]:
        step = {"kind": "wait", "place": ["program", "body", "1"], "pos": [0, 0], "params": {"until": until}}
        parameters = {"p": {"name": parameter, "type": "number", "default": 2}}
        return {"format": 2, "start_pos": [0, 0], "steps": {"s": step}, "parameters": parameters}

    unknown = {"op": "and", "args": [True, {"property": [{"param": "minutes"}, "jobStatus"]}]}
    tree = parse_script(compile_document(waiting({}, "minutes"), factory()).script, factory()).tree
    assert tree is not None
    assert compile_document(tree_to_document(tree, factory(), waiting(unknown, "n")), factory()).tree == tree


quick = settings(max_examples=25, deadline=None, suppress_health_check=list(HealthCheck))


@quick
@given(documents())
def test_what_a_script_says_of_a_document_changes_nothing_in_it(document: dict[str, Any]) -> None:
    compiled = compile_document(document, factory())
    parsed = parse_script(compiled.script, factory())
    assert parsed.tree is not None
    assert tree_to_document(parsed.tree, factory(), document) == migrate(document)


@quick
@given(documents(), documents())
def test_a_script_drawn_over_any_document_means_what_it_says(first: dict[str, Any], second: dict[str, Any]) -> None:
    tree = parse_script(compile_document(first, factory()).script, factory()).tree
    assert tree is not None
    drawn = tree_to_document(tree, factory(), second)
    assert compile_document(drawn, factory()).tree == with_named_zones(tree, second)
    kept = compile_document(second, factory())
    old: Any = migrate(second)
    steps: Any = drawn["steps"]
    drafts = old["steps"].keys() - kept.numbers.keys()
    assert {name: steps[name]["params"] for name in drafts} == {name: old["steps"][name]["params"] for name in drafts}


@quick
@given(documents(6), st.one_of(broken_documents, json_values))
def test_nothing_in_the_document_before_makes_drawing_raise(document: dict[str, Any], before: Any) -> None:
    tree = parse_script(compile_document(document, factory()).script, factory()).tree
    assert tree is not None
    drawn = tree_to_document(tree, factory(), before if isinstance(before, dict) else {"steps": before})
    assert json.dumps(drawn)


@quick
@given(documents(8), st.data())
def test_nothing_in_a_step_before_makes_drawing_raise(document: dict[str, Any], data: st.DataObject) -> None:
    text = compile_document(document, factory()).script
    for old in document["steps"].values():
        for name in [*old["params"], "place", "pos", "kind"]:
            if data.draw(st.integers(0, 3)) == 0:
                (old["params"] if name in old["params"] else old)[name] = data.draw(json_values)
    tree = parse_script(text, factory()).tree
    assert tree is not None
    assert compile_document(tree_to_document(tree, factory(), document), factory()).tree == tree


def test_a_script_that_sets_what_a_loop_counts_with_speaks_of_the_same_variable() -> None:
    """The document calls it “Paint count”; a second variable of nearly that name would become another one."""
    before = migrate(
        {
            "format": 2,
            "steps": {
                "f": {"kind": "for_each", "place": ["program", "body", "V"],
                      "params": {"variable": "can", "index": "Paint count", "items": [1, 2]}},
            },
        }
    )  # fmt: skip
    text = compile_document(before, factory()).script
    loop = "for paint_count, can in enumerate([1, 2], 1):"
    assert loop in text
    tree = parse_script(text.replace(loop, f"self.paint_count = 0\n        {loop}"), factory()).tree
    assert tree is not None
    drawn = tree_to_document(tree, factory(), before)
    assert compile_document(drawn, factory()).tree == tree
    steps: Any = drawn["steps"]
    assert [s["params"]["variable"] for s in steps.values() if s["kind"] == "set"] == ["Paint count"]


def test_a_value_that_named_nothing_gets_no_sense_from_a_new_variable() -> None:
    before = migrate(
        {
            "format": 2,
            "steps": {"w": {"kind": "wait", "place": ["program", "body", "V"], "pos": [1, -1],
                            "params": {"duration": {"param": "count"}}}},
        }
    )  # fmt: skip
    script = compile_document(before, factory()).script
    assert "self.wait(None)" in script
    changed = script.replace("        self.wait(None)", "        self.count = 3\n        self.wait(None)")
    tree = parse_script(changed, factory()).tree
    assert tree is not None
    drawn: Any = tree_to_document(tree, factory(), before)
    assert compile_document(drawn, factory()).tree == tree
    assert drawn["steps"]["w"] == {**before["steps"]["w"], "params": {}, "place": drawn["steps"]["w"]["place"]}
