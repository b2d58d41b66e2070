from __future__ import annotations

import pytest

from editor.language import compile_document, parse_script, tree_to_document
from tests.kit.demo_site import factory, script, with_device


def refusal(*lines: str) -> tuple[int | None, str]:
    parsed = parse_script(script(*lines), factory())
    assert parsed.tree is None
    first = parsed.diagnostics[0]
    return first.line, first.message


def test_a_script_written_by_hand_becomes_a_drawing_and_the_same_script() -> None:
    text = script(
        "self.robot.move(self.item_inventory.location)",
        'self.robot.pick({"value": 1, "object": "box"})',
        "self.robot.move(self.painting_machine.location)",
        'self.robot.drop({"value": 1, "object": "box"})',
        "self.curing_oven.cure_paint(10)",
    )
    parsed = parse_script(text, factory())
    assert parsed.tree is not None
    document = tree_to_document(parsed.tree, factory())
    steps = document["steps"]
    assert isinstance(steps, dict)
    assert [step["kind"] for step in steps.values()] == ["pick_and_drop", "operate"]
    assert compile_document(document, factory()).script == text.replace("\n\n\n", "\n\n")


def test_steps_that_did_not_change_keep_their_ids_and_places() -> None:
    text = script("self.wait(60)", "self.curing_oven.cure_paint(10)")
    tree = parse_script(text, factory()).tree
    assert tree is not None
    first = tree_to_document(tree, factory())
    moved = {"wait": [3.0, -8.0], "operate": [9.0, -12.5]}
    steps = first["steps"]
    assert isinstance(steps, dict)
    before = {**first, "steps": {f"old-{s['kind']}": {**s, "pos": moved[s["kind"]]} for s in steps.values()}}
    longer = parse_script(text.replace("self.wait(60)", "self.wait(60)\n        self.wait(5)"), factory()).tree
    assert longer is not None
    after = tree_to_document(longer, factory(), before)["steps"]
    assert isinstance(after, dict)
    assert after["old-wait"]["pos"] == [3.0, -8.0]
    assert after["old-operate"]["pos"] == [9.0, -12.5]
    assert len(after) == 3


@pytest.mark.parametrize(
    "line",
    [
        "import os",
        "print(1)",
        "self.wait(open('x'))",
        "self.curing_oven.__class__()",
        "x = 1",
        "del self.robot",
        "for i in range(3): pass",
        "for self.i in [1]: pass",
        "for i in self.curing_oven: pass",
        "for count in [1]: pass",
        "lambda: 0",
        "self.wait([x for x in (1,)])",
        "self.wait(f'{1!r}')",
        "self.wait((lambda: 1)())",
        "self.wait(60) if True else None",
        "exec('1')",
        "self.curing_oven.cure_paint(*[1])",
        "self.curing_oven.cure_paint(10, 11)",
        "self.curing_oven.explode()",
        "self.mix_paint()",
        "self.wait(1, 2)",
        "while 1 < 2 < 3: pass",
        "x += 1",
        "self.robot = 1",
        "self.new_task = 1",
        "self.wait.x = 1",
        "self.a = self.b = 1",
        "self.ask()",
        'self.ask("a", type="colour")',
        'self.ask("a", type="boolean", minimum=1)',
        'self.ask("a", kind="boolean")',
        'self.notify("a", level="loud")',
        "self.end(1)",
        "self.set(1, 2)",
        "with self.robot: pass",
        "self.wait(b'1')",
        "self.wait(10**9)",
        "self.robot.move(self.nowhere.location)",
        "self.parallel(self.new_task)",
        "global robot",
    ],
)
def test_python_outside_the_language_is_refused_with_its_line(line: str) -> None:
    where, message = refusal("self.wait(60)", line)
    assert where == 4
    assert message.startswith("Line 4, column ")


def test_a_pick_at_an_unknown_place_says_what_to_put_before_it() -> None:
    where, message = refusal('self.robot.pick({"value": 1, "object": "box"})')
    assert (where, message) == (
        3,
        "Line 3, column 9: A pick or drop at an unknown place is not part of the language. "
        "Put self.robot.move(…) before it.",
    )


def test_all_refusals_are_told_at_once() -> None:
    parsed = parse_script(script("import os", "self.wait(1)", "x = 2"), factory())
    assert [diagnostic.line for diagnostic in parsed.diagnostics] == [3, 5]


@pytest.mark.parametrize(
    "text", ["", "class Task(object):", "def run(self, ctx): pass", "class Other: pass", "\x00", "(" * 5000]
)
def test_what_is_no_task_is_refused(text: str) -> None:
    parsed = parse_script(text, factory())
    assert parsed.tree is None
    assert len(parsed.diagnostics) == 1


def test_the_same_step_twice_reads_as_two_steps() -> None:
    tree = parse_script(script("self.wait(5)", "self.wait(5)"), factory()).tree
    assert tree is not None
    assert len(compile_document(tree_to_document(tree, factory()), factory()).numbers) == 2


def test_the_listing_of_the_paper_is_read_where_its_robot_stands_at_the_source() -> None:
    listing = (
        "class Task(object):\n"
        "    def new_task(self):\n"
        '        self.robot.pick({"value": 1, "object": "box"})\n'
        "        self.robot.move(self.painting_machine.location)\n"
        '        self.robot.drop({"value": 1, "object": "box"})\n'
        "\n"
        "def run(self, ctx):\n"
        '    self.robot = ctx.get("robot01")\n'
        '    self.painting_machine = ctx.get("paintMachine01")\n'
        "    self.new_task()\n"
    )
    assert "Put self.robot.move(…) before it." in parse_script(listing, factory()).diagnostics[0].message
    site = with_device("robot01", standing_at="itemInventory01")
    parsed = parse_script(listing, site)
    assert parsed.tree is not None
    compiled = compile_document(tree_to_document(parsed.tree, site), site)
    assert compiled.diagnostics == ()
    assert 'self.robot = ctx.get("robot01", at="itemInventory01")' in compiled.script
