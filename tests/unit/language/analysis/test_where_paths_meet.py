"""What is known where paths meet: what one of them alone sets is known by what that one sets."""

from __future__ import annotations

import pytest

from editor.language import compile_document
from tests.unit.language.checks.test_told_before import HOT, document_of, factory, program, told

SHARE = "self.notify(f'{6 / self.n}')"


@pytest.mark.parametrize(
    ("zero", "codes"),
    [("0", ["may_be_unset", "divided_by_zero"]), ("2", ["may_be_unset"])],
)
@pytest.mark.parametrize("branches", ["if {0}:\n    {1}", "if {0}:\n    self.wait(1)\nelse:\n    {1}"])
def test_a_variable_that_one_path_sets_is_known_by_that(branches: str, zero: str, codes: list[str]) -> None:
    assert told(f"{branches.format(HOT, f'self.n = {zero}')}\n{SHARE}") == codes


def test_a_variable_that_both_paths_set_may_be_either() -> None:
    both = "if {0}:\n    self.n = {1}\nelse:\n    self.n = {2}\n"
    assert told(both.format(HOT, 1, 2) + SHARE) == []
    assert told(both.format(HOT, 0, 2) + SHARE) == ["may_divide_by_zero"]
    assert told(both.format(HOT, 0, 0) + SHARE) == ["divided_by_zero"]


def test_behind_a_loop_what_held_before_it_may_hold_too() -> None:
    loop = "self.n = {0}\nwhile {1}:\n    self.wait(60)\n    self.n = {2}\n"
    assert told(loop.format(1, HOT, 2) + SHARE) == []
    assert told(loop.format(0, HOT, 2) + SHARE) == ["may_divide_by_zero"]
    assert told(loop.format(2, HOT, 0) + SHARE) == ["may_divide_by_zero"]


DOCK = "self.robot.move(self.dock.location)"
FAR = "self.notify(f'{distance(self.robot, self.oven)}')"
PERHAPS = f"if {HOT}:\n    {DOCK}"
TWO = "self.parallel(self.branch_{0}a, self.branch_{0}b{1})"
BRANCHES = "def branch_{0}a(self):\n{1}\ndef branch_{0}b(self):\n{2}"


def both(first: str, second: str, step: int = 1, race: str = "") -> tuple[str, str]:
    """Return a Parallel of two branches, and the functions of a script that are these."""
    inside = ["\n".join(f"    {line}" for line in branch.split("\n")) for branch in (first, second)]
    return TWO.format(step, race), BRANCHES.format(step, *inside)


def test_in_a_catch_a_role_that_had_a_robot_perhaps_still_has_it_perhaps() -> None:
    caught = f"try:\n    self.wait(1)\nexcept Failed as problem:\n    {FAR}"
    assert told(f"{PERHAPS}\n{caught}") == ["perhaps_no_robot_yet"]
    assert told(f"{DOCK}\n{caught}") == []
    assert told(caught + f"\n{DOCK}") == ["no_robot_yet"]


def test_a_role_that_a_branch_took_perhaps_has_its_robot_perhaps_behind_all() -> None:
    for taken, codes in ((PERHAPS, ["perhaps_no_robot_yet"]), (DOCK, [])):
        step, branches = both(taken, "self.wait(1)")
        assert told(f"{step}\n{FAR}", branches) == codes


def test_a_branch_that_is_called_off_may_have_set_a_variable_or_not() -> None:
    for before, codes in (("self.n = 2", ["may_divide_by_zero"]), ("self.n = 0", ["divided_by_zero"])):
        step, branches = both("self.wait(1)", "self.wait(5)\nself.n = 0\nself.wait(5)", 2, ", needed=1")
        assert told(f"{before}\n{step}\n{SHARE}", branches) == codes


def test_each_loop_is_followed_as_far_as_any_however_many_stand_before_it() -> None:
    loops = "for _ in range(100):\n    self.n = self.n + 1\n" * 60
    assert told(f"self.n = 0\n{loops}self.notify(f'{{6 / (self.n - 6000)}}')") == ["divided_by_zero"]
    assert told(f"self.n = 0\n{loops}self.notify(f'{{6 / (self.n - 5999)}}')") == []


def test_where_a_condition_does_not_hold_its_opposite_does() -> None:
    asked = "self.n = self.ask('How many?', type='number', minimum=0, maximum=3)"
    assert told(f"{asked}\n{SHARE}") == ["may_divide_by_zero"]
    assert told(f"{asked}\nif not self.n == 0:\n    {SHARE}") == []
    assert told(f"{asked}\nif not self.n > 0:\n    {SHARE}") == ["divided_by_zero"]


def test_a_value_that_the_program_itself_gives_back_goes_nowhere() -> None:
    assert told(f"self.n = 2\nif {HOT}:\n    return self.n\n{SHARE}") == ["return_outside_function"]


def test_a_function_that_calls_itself_behind_a_loop_is_followed() -> None:
    loop = "for m in [self.mixer, self.mixer_2]:\n        m.operate('mixPaint', {'time': 3})"
    again = "def again(self):\n    {}\n    {}self.again()"
    assert told("self.again()", again.format(loop, f"if {HOT}:\n        ")) == []
    assert told("self.again()", again.format(loop, "")) == ["calls_itself"]


def nested(text: str) -> str:
    return "\n".join(f"    {line}" for line in text.split("\n"))


@pytest.mark.parametrize(
    "deep",
    [
        f"if {HOT}:\n{nested(PERHAPS)}",
        f"if {HOT}:\n    self.wait(1)\nelse:\n{nested(PERHAPS)}",
        f"if {HOT}:\n{nested(PERHAPS)}\nelse:\n{nested(PERHAPS)}",
    ],
)
def test_a_role_that_has_a_robot_perhaps_on_one_path_has_it_perhaps_behind_both(deep: str) -> None:
    assert told(f"{deep}\n{FAR}") == ["perhaps_no_robot_yet"]


def test_that_another_role_takes_a_robot_says_nothing_of_one_that_has_it_perhaps() -> None:
    other = "self.other.move(self.dock.location)"
    assert told(f"{PERHAPS}\n{other}\n{FAR}") == ["perhaps_no_robot_yet"]
    assert told(f"{other}\n{PERHAPS}\n{FAR}") == ["perhaps_no_robot_yet"]


def test_each_loop_is_told_of_by_its_own_first_round() -> None:
    body = "self.notify(f'{{6 / self.{0}}}')\n    self.{0} = self.{0} + 1\n    self.wait(60)\n"
    loop = f"self.{{0}} = 0\nwhile {{1}}:\n    {body}"
    first, second = loop.format("n", HOT), loop.format("m", HOT)
    assert told(first) == ["divided_by_zero"]
    assert told(first + second) == ["divided_by_zero", "divided_by_zero"]


@pytest.mark.parametrize(("others", "codes"), [(7, ["divided_by_zero"]), (8, [])])
def test_a_function_is_followed_for_eight_values_and_no_more(others: int, codes: list[str]) -> None:
    share = "def share(self, x: Number):\n    self.notify(f'{6 / x}')"
    calls = "\n".join(f"self.share({number})" for number in [*range(1, others + 1), 0])
    assert told(calls, share) == codes


def test_of_several_things_that_are_released_the_first_by_name_is_told() -> None:
    take = "self.robot.move(self.{0}.location)\nself.robot.pick({{'value': 1, 'object': '{1}'}})\n"
    shelves = [("shelf", "box"), ("cans", "can")]
    for things in (shelves, shelves[::-1]):
        body = "".join(take.format(*each) for each in things) + "self.robot.release()"
        found = compile_document(document_of(program(body)), factory()).diagnostics
        assert [(each.code, each.args["object"]) for each in found] == [("releases_carrying", "box")]


def test_of_two_roles_one_that_has_a_robot_perhaps_has_it_no_surer_for_the_other() -> None:
    other, far = "self.helper.move(self.dock.location)", "self.notify(f'{distance(self.helper, self.oven)}')"
    helper = "self.helper = ctx.any('pick', 'drop')"
    assert told(f"{PERHAPS}\n{other}\n{FAR}\n{far}", "", helper) == ["perhaps_no_robot_yet"]
    assert told(f"{PERHAPS}\nif {HOT}:\n    {other}\n{FAR}\n{far}", "", helper) == ["perhaps_no_robot_yet"] * 2


def test_what_a_person_writes_may_be_any_text() -> None:
    asked = "self.said = self.ask('What is on it?', type='text')"
    assert told(f"{asked}\nif self.said == 'eggs':\n    self.notify(f'{{6 / 0}}')") == ["divided_by_zero"]


@pytest.mark.parametrize(("first", "second", "fits"), [("n", "n", True), ("n", "m", False), ("m", "n", False)])
def test_as_many_as_were_picked_on_either_path_are_there_to_be_dropped(first: str, second: str, fits: bool) -> None:
    asked = "\n".join(
        f"self.{name} = self.ask('How many?', type='number', minimum=1, maximum=2)" for name in ("n", "m")
    )
    at, pick = "self.robot.{0}(self.{1}.location)", "self.robot.{0}({{'value': self.{1}, 'object': 'box'}})"
    body = (
        f"{asked}\n{at.format('move', 'shelf')}\nif {HOT}:\n    {pick.format('pick', first)}\nelse:\n"
        f"    {pick.format('pick', second)}\n{at.format('move', 'booth')}\n{pick.format('drop', 'n')}"
    )
    assert ("may_drop_nothing" not in told(body)) is fits


@pytest.mark.parametrize(("depth", "codes"), [(11, ["divided_by_zero"]), (12, [])])
def test_functions_are_followed_twelve_calls_deep(depth: int, codes: list[str]) -> None:
    chain = [f"def f{n}(self, x: Number):\n    self.f{n + 1}(x)" for n in range(depth)]
    last = f"def f{depth}(self, x: Number):\n    self.notify(f'{{6 / x}}')"
    assert told("self.f0(0)", "\n\n".join([*chain, last])) == codes
