"""What the checks say of a Parallel that ends before all of its branches have."""

import pytest

from editor.language import compile_document, parse_script, tree_to_document
from tests.kit.demo_site import factory

SITE = factory()
HOT = "self.curing_oven.temperature > 60"
WATCHER = f"while True:\n    self.wait(until={HOT})\n    self.wait(5)"
PICK = 'self.robot.move(self.item_inventory.location)\nself.robot.pick({"value": 1, "object": "box"})'
DROP = 'self.robot.move(self.painting_machine.location)\nself.robot.drop({"value": 1, "object": "box"})'
GIVEN = (
    'self.curing_oven = ctx.get("curingOven01")',
    'self.item_inventory = ctx.get("itemInventory01")',
    'self.painting_machine = ctx.get("paintMachine01")',
    'self.robot = ctx.any("pick", "drop")',
    "self.new_task()",
)


def indented(text: str) -> list[str]:
    return [f"        {line}" for line in text.splitlines()]


def told(body: str, *branches: str, needed: int = 1, functions: str = "") -> list[str]:
    """Return the codes that are told of a program; `RACE` in its body is a Parallel of these branches."""
    named = [f"self.branch_1{letter}" for letter, _ in zip("abcdef", branches, strict=False)]
    race = f"self.parallel({', '.join(named)}, needed={needed})"
    lines = ["class Task(object):", "    def new_task(self):", *indented(body.replace("RACE", race))]
    for name, branch in zip(named, branches, strict=True):
        lines += [f"    def {name.removeprefix('self.')}(self):", *indented(branch)]
    lines += [f"    {line}" for line in functions.splitlines()]
    script = "\n".join([*lines, "    def run(self, ctx):", *indented("\n".join(GIVEN)), ""])
    parsed = parse_script(script, SITE)
    assert parsed.tree is not None, parsed.diagnostics
    compiled = compile_document(tree_to_document(parsed.tree, SITE), SITE)
    assert (compiled.plan is None) == any(each.severity == "error" for each in compiled.diagnostics)
    return [each.code for each in compiled.diagnostics]


FETCH = "def fetch(self):\n" + "\n".join(f"    {line}" for line in PICK.splitlines())
BEHIND = 'RACE\nself.notify("Over", level="info")'
STUCK = 'self.go = self.ask("Go on?", type="boolean")\n' + BEHIND
TURNS = "while self.go:\n    self.wait(1)"


@pytest.mark.parametrize(
    ("body", "branches", "needed", "codes"),
    [
        (BEHIND, ("self.wait(60)", WATCHER), 1, []),
        (BEHIND, (f"{PICK}\n{DROP}", WATCHER, WATCHER), 1, []),
        (BEHIND, ("self.wait(60)", "self.wait(50)", WATCHER), 2, []),
        (BEHIND, ("self.wait(60)", WATCHER, WATCHER), 2, ["too_few_end", "never_reached"]),
        (BEHIND, (WATCHER, WATCHER), 1, ["too_few_end", "never_reached"]),
        (BEHIND, ("self.wait(60)", WATCHER), 2, ["never_ends", "never_reached"]),
        ("RACE", (f"self.wait(until={HOT})\nself.end()", WATCHER), 1, []),
        ("RACE", (f'self.wait(until={HOT})\nraise Failed("Hot.")', "self.wait(60)"), 1, []),
        ("RACE", ('raise Failed("Hot.")', "self.wait(60)"), 1, []),
        (STUCK, ("self.wait(60)", TURNS), 1, []),
        (STUCK, (TURNS, TURNS), 1, ["may_never_end", "may_never_end"]),
    ],
)
def test_a_branch_needs_no_end_where_enough_others_have_one(body, branches, needed, codes):
    assert told(body, *branches, needed=needed) == codes


def test_an_endless_function_is_called_off_in_a_race_and_nowhere_else():
    functions = f"def watch(self):\n    while True:\n        self.wait(until={HOT})\n        self.wait(5)"
    assert told(BEHIND, "self.wait(60)", "self.watch()", functions=functions) == []
    assert told(f"{BEHIND}\nself.watch()", "self.wait(60)", "self.watch()", functions=functions) == ["never_ends"]


WHO = ("self.wait(60)\nself.who = 1", f"self.wait(until={HOT})\nself.who = 2")
SAYS = 'RACE\nself.notify(f"{self.who}", level="info")'
DIVIDES = 'RACE\nself.notify(f"{60 / self.who}", level="info")'


def test_what_each_branch_sets_at_its_end_is_set_by_the_first_alone():
    assert told(SAYS, *WHO) == []
    assert told(DIVIDES, *WHO) == []
    assert told(DIVIDES, WHO[0], f"self.wait(until={HOT})\nself.who = 0") == ["may_divide_by_zero"]
    nested = f"self.who = 1\n{DIVIDES}"
    assert told(nested, "self.who = self.who - 1\nself.wait(5)\nself.who = 2", "self.wait(5)") == ["may_divide_by_zero"]


@pytest.mark.parametrize(
    ("branches", "needed", "codes"),
    [
        ((WHO[0], f"self.who = 2\nself.wait(until={HOT})"), 1, ["branches_set_it"]),
        ((*WHO, "self.wait(5)"), 2, ["branches_set_it"]),
        ((*WHO, "self.wait(5)", "self.wait(5)"), 2, ["branches_set_it", "may_be_unset"]),
        ((*WHO, "self.wait(5)"), 1, ["may_be_unset"]),
        ((WHO[0], f"self.wait(until={HOT})"), 1, ["may_be_unset"]),
        ((WHO[0], WATCHER), 1, []),
    ],
)
def test_what_a_branch_sets_may_be_unset_where_another_may_be_first(branches, needed, codes):
    assert told(SAYS, *branches, needed=needed) == codes


def test_what_is_carried_is_known_only_where_the_branch_surely_ended():
    assert told("RACE", PICK, WATCHER) == ["ends_carrying"]
    assert told("RACE", PICK, "self.wait(60)") == []
    assert told(f"RACE\n{DROP}", PICK, "self.wait(60)") == ["may_drop_nothing"]
    assert told(f"{PICK}\nRACE\n{DROP}", DROP, WATCHER) == ["drops_nothing"]
    assert told(f"{PICK}\nRACE\n{DROP}", DROP, "self.wait(60)") == ["may_drop_nothing"]
    two = f"{PICK}\n{DROP}".replace('"value": 1', '"value": 2')
    assert told(f"RACE\n{two}", f"{PICK}\n{DROP}", "self.wait(60)") == ["may_carry_too_much"]
    assert told(f"RACE\n{two}", f"{PICK}\n{DROP}", WATCHER) == []
    assert told(f"RACE\n{DROP}", "self.fetch()", "self.wait(60)", functions=FETCH) == []


def test_branches_that_wait_for_each_other_are_called_off_by_a_third():
    body = "self.left = False\nself.right = False\nRACE"
    waiting = ("self.wait(until=self.right)\nself.left = True", "self.wait(until=self.left)\nself.right = True")
    assert told(body, *waiting) == ["branches_wait"]
    assert told(body, *waiting, "self.wait(60)") == []


def test_a_moved_robot_may_stand_anywhere_behind_a_race():
    script = "\n".join(
        [
            "class Task(object):",
            "    def new_task(self):",
            "        self.parallel(self.branch_1a, self.branch_1b, needed=1)",
            *indented(PICK),
            *indented(DROP),
            "    def branch_1a(self):",
            *indented("self.robot.move(self.item_inventory.location)"),
            "    def branch_1b(self):",
            *indented("self.wait(60)"),
            "    def run(self, ctx):",
            *indented("\n".join(GIVEN)),
        ]
    )
    assert parse_script(script, SITE).tree is not None
    without = script.replace(f"needed=1)\n{indented(PICK)[0]}\n", "needed=1)\n")
    assert [each.code for each in parse_script(without, SITE).diagnostics] == ["not_in_language"]
    assert parse_script(without.replace(", needed=1", ""), SITE).tree is not None
