"""Two documents compared construct by construct: added, removed, changed, moved, and what was only tidied."""

from __future__ import annotations

from typing import Any

from hypothesis import given
from hypothesis import strategies as st

from editor.language.comparison.difference import ConstructChange, Difference, compare
from tests.kit.drawn.edits import edited, empty
from tests.kit.programs import document, step

SEEDS = st.integers(0, 2**32)


def wait(order: str, parent: str = "program", branch: str = "body", **more: Any) -> dict[str, Any]:
    return step("wait", (parent, branch), order, **{"duration": 1, **more})


def kinds(difference: Difference) -> dict[str, str]:
    return {each.id: each.kind for each in difference.constructs}


def only(difference: Difference) -> ConstructChange:
    (change,) = difference.constructs
    return change


def test_a_step_is_added_and_removed_with_its_fields() -> None:
    old, new = document({"a": wait("A")}), document({"b": wait("B")})
    found = compare(old, new)
    assert [(each.id, each.kind) for each in found.constructs] == [("a", "removed"), ("b", "added")]
    assert [change.path for change in found.constructs[1].changes] == [("steps", "b", "params", "duration")]
    assert found.same == 0


def test_a_field_is_changed_from_old_to_new() -> None:
    found = compare(document({"a": wait("A"), "b": wait("B")}), document({"a": wait("A", duration=5), "b": wait("B")}))
    change = only(found)
    assert (change.kind, [(each.old, each.new) for each in change.changes]) == ("changed", [(1, 5)])
    assert found.same == 1


def test_who_went_past_others_has_moved_and_they_have_not() -> None:
    old = document({"a": wait("A"), "b": wait("B"), "c": wait("C"), "d": wait("D")})
    new = document({"a": wait("E"), "b": wait("B"), "c": wait("C"), "d": wait("D")})
    assert kinds(compare(old, new)) == {"a": "moved"}


def test_of_two_that_have_changed_places_the_one_whose_place_was_written_has_moved() -> None:
    old = document({"a": wait("A"), "b": wait("B"), "c": wait("C")})
    for mover, order in (("a", "BV"), ("b", "0V")):
        new = {**old, "steps": {**old["steps"], mover: wait(order)}}
        found = only(compare(old, new))
        assert (found.id, found.kind, [change.path[2] for change in found.changes]) == (mover, "moved", ["place"])
    respread = document({"b": wait("K"), "a": wait("L"), "c": wait("M")})
    assert len(compare(old, respread).constructs) == 1


def test_other_orders_in_the_same_sequence_are_tidying() -> None:
    old = document({"a": wait("A"), "b": wait("B")})
    found = compare(old, document({"a": wait("K"), "b": wait("T")}))
    assert (kinds(found), [each.id for each in found.tidied], found.same) == ({}, ["a", "b"], 2)


def test_a_step_that_went_into_a_new_one_has_moved() -> None:
    old = document({"a": wait("A")})
    new = document({"t": step("try", order="A", kinds=[]), "a": wait("A", "t")})
    assert kinds(compare(old, new)) == {"t": "added", "a": "moved"}
    changed = document({"t": step("try", order="A", kinds=[]), "a": wait("A", "t", duration=9)})
    inner = next(each for each in compare(old, changed).constructs if each.id == "a")
    assert (inner.kind, inner.is_moved) == ("changed", True)


def test_who_stands_elsewhere_because_something_came_before_has_not_moved() -> None:
    old = document({"a": wait("B"), "b": wait("C")})
    assert kinds(compare(old, document({"x": wait("A"), "a": wait("B"), "b": wait("C")}))) == {"x": "added"}


def test_a_step_that_is_joined_has_moved_and_one_that_is_let_go_too() -> None:
    draft = {**wait("A"), "place": None}
    assert kinds(compare(document({"a": draft}), document({"a": wait("A")}))) == {"a": "moved"}
    assert kinds(compare(document({"a": wait("A")}), document({"a": draft}))) == {"a": "moved"}


def test_chips_bends_the_start_and_comments_are_tidying() -> None:
    old = document({"m": step("move", to={"place": "p"}), "c": step("comment", text="old")})
    new = document(
        {
            "m": {**step("move", to={"place": "p"}, route=[[1, 2]]), "pos": [9, 9]},
            "c": step("comment", text="new"),
            "d": step("comment", text="another"),
        },
        start_pos=[1, 1],
    )
    found = compare(old, new)
    assert (found.constructs, {(each.root, each.id) for each in found.tidied}) == (
        (),
        {("steps", "m"), ("steps", "c"), ("steps", "d"), ("program", "start_pos")},
    )


def test_a_function_a_role_and_a_zone_are_constructs_too() -> None:
    old = document({}, functions={"f": {"name": "mix", "parameters": []}}, roles={"r": {"name": "R", "can": []}})
    new = document({}, functions={"f": {"name": "blend", "parameters": []}}, zones={"z": {"name": "Z", "points": []}})
    found = {(each.root, each.id): each.kind for each in compare(old, new).constructs}
    assert found == {("functions", "f"): "changed", ("roles", "r"): "removed", ("zones", "z"): "added"}


def test_changes_are_told_in_reading_order_and_what_is_gone_where_it_stood() -> None:
    old = document({"a": wait("A"), "gone": wait("B"), "w": step("while", order="C"), "in": wait("A", "w")})
    call = step("call", order="B", function="f")
    new = document(
        {
            "a": wait("A", duration=2),
            "c": call,
            "body": wait("A", "f"),
            "w": step("while", order="C"),
            "new": wait("D"),
        },
        functions={"f": {"name": "f", "parameters": []}},
    )
    assert [each.id for each in compare(old, new).constructs] == ["a", "gone", "c", "body", "in", "new", "f"]


@given(SEEDS, SEEDS, st.integers(0, 30))
def test_whatever_stands_in_them_each_change_is_told_of_once(first: int, second: int, count: int) -> None:
    old = edited(empty(), first, 25)
    new = edited(old, second, count)
    found = compare(old, new)
    names = [(each.root, each.id) for each in (*found.constructs, *found.tidied)]
    assert len(names) == len(set(names))
    assert {change.path[:2] for change in found.changes if len(change.path) > 1} <= set(names)
    back = compare(new, old)
    turned = {"added": "removed", "removed": "added", "changed": "changed"}
    told = {(each.root, each.id): turned[each.kind] for each in found.constructs if each.kind in turned}
    assert {(e.root, e.id): e.kind for e in back.constructs if e.kind in ("added", "removed")} == {
        name: kind for name, kind in told.items() if kind in ("added", "removed")
    }
