"""What restoring a construct needs besides: what it stood in, what it calls, what stands in what goes."""

from __future__ import annotations

from typing import Any

from hypothesis import given
from hypothesis import strategies as st

from editor.language.comparison.changes import apply_changes, find_changes, is_same
from editor.language.comparison.difference import Name, name_of
from editor.language.comparison.needs import restore_all, restore_some
from editor.language.document.outline import make_outline
from tests.kit.drawn.edits import edited, empty
from tests.kit.programs import document, step

SEEDS = st.integers(0, 2**32)


def wait(parent: str = "program", branch: str = "body", order: str = "A", **more: Any) -> dict[str, Any]:
    return step("wait", (parent, branch), order, **{"duration": 1, **more})


def needs(now: dict[str, Any], then: dict[str, Any], *wanted: Name) -> set[Name]:
    return set(restore_some(now, then, wanted).needs)


def test_a_step_needs_the_step_and_the_function_in_which_it_stood() -> None:
    function = {"f": {"name": "f", "parameters": []}}
    then = document({"w": step("while", ("f", "body")), "a": wait("w")}, functions=function)
    assert needs(document({}), then, ("steps", "a")) == {("steps", "w"), ("functions", "f")}


def test_a_step_needs_the_function_role_zone_and_parameter_that_it_names() -> None:
    around: dict[str, Any] = {
        "functions": {"f": {"name": "f", "parameters": []}},
        "roles": {"r": {"name": "R", "can": []}},
        "zones": {"z": {"name": "Z"}},
        "parameters": {"n": {"name": "n", "type": "number"}},
    }
    call = step("call", function="f", args={"x": {"param": "n"}, "where": {"zone": "z"}, "who": {"at": {"role": "r"}}})
    then = document({"c": call}, **around)
    named = {("functions", "f"), ("roles", "r"), ("zones", "z"), ("parameters", "n")}
    assert needs(document({}), then, ("steps", "c")) == named
    assert needs(document({}, **around), then, ("steps", "c")) == set()


def test_what_comes_back_brings_what_stood_in_it_unless_that_is_still_there() -> None:
    then = document({"w": step("while"), "a": wait("w"), "b": wait("w", order="B")})
    now = document({"b": wait()})
    assert needs(now, then, ("steps", "w")) == {("steps", "a")}


def test_what_was_drawn_into_a_step_that_goes_is_restored_as_well() -> None:
    then = document({"a": wait()})
    now = document({"t": step("try"), "a": wait("t"), "new": wait("t", order="B")})
    restoring = restore_some(now, then, [("steps", "t")])
    assert set(restoring.needs) == {("steps", "a"), ("steps", "new")}
    assert is_same(apply_changes(now, restoring.changes), then)


def test_a_single_field_is_restored_alone() -> None:
    then, now = document({"a": wait(duration=1, timeout=2)}), document({"a": wait(duration=5, timeout=6)})
    restoring = restore_some(now, then, [], [("steps", "a", "params", "duration")])
    made = apply_changes(now, restoring.changes)
    assert (made["steps"]["a"]["params"], restoring.needs) == ({"duration": 1, "timeout": 6}, ())


def test_two_steps_that_have_changed_places_go_back_together() -> None:
    then = document({"a": step("while"), "b": step("while", ("a", "body"))})
    now = document({"b": step("while"), "a": step("while", ("b", "body"))})
    restoring = restore_some(now, then, [("steps", "b")])
    assert set(restoring.needs) == {("steps", "a")}
    assert is_same(apply_changes(now, restoring.changes), then)


@given(SEEDS, SEEDS, st.integers(0, 30), SEEDS)
def test_what_is_restored_is_what_it_was_and_all_else_that_was_not_needed_stays(
    first: int, second: int, count: int, which: int
) -> None:
    then = edited(empty(), first, 25)
    now = edited(then, second, count)
    differing = sorted({name_of(change.path) for change in find_changes(now, then)} - {("program", "start_pos")})
    if not differing:
        return
    wanted = differing[which % len(differing)]
    restoring = restore_some(now, then, [wanted])
    made = apply_changes(now, restoring.changes)
    taken = {wanted, *restoring.needs}
    left = {name_of(change.path) for change in find_changes(made, then)}
    assert left == set(differing) - taken | ({("program", "start_pos")} & left)
    assert {name_of(change.path) for change in find_changes(made, now)} <= taken
    before = {*make_outline(now).drafts, *make_outline(then).drafts}
    standing = [name for root, name in taken if root == "steps" and name in make_outline(made).drafts]
    assert not [name for name in standing if name not in before]


@given(SEEDS, SEEDS, st.integers(0, 30))
def test_all_is_restored_at_once(first: int, second: int, count: int) -> None:
    then = edited(empty(), first, 25)
    now = edited(then, second, count)
    assert is_same(apply_changes(now, restore_all(now, then).changes), then)
