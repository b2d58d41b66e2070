"""What is known where paths meet: what one of them alone sets is known by what that one sets."""

from __future__ import annotations

import pytest

from tests.unit.language.checks.test_told_before import HOT, told

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
