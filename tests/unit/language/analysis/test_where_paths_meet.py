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
