"""Roles that need a robot at the same time are counted against the robots that there are, along each path."""

from __future__ import annotations

from typing import Any

import pytest

from editor.language import compile_document
from tests.kit.demo_site import factory

GOALS = ("curingOven01", "itemInventory01", "paintMachine01", "dropOff01")
HOT = {"op": ">", "args": [{"property": ["curingOven01", "temperature"]}, 60]}


def codes(program: list[Any], functions: dict[str, list[Any]] | None = None) -> list[str]:
    """Return what is said of a program: a text is a drive of that role, or with `-` its release, a list any step."""
    steps: dict[str, Any] = {}

    def add(block: list[Any], parent: str, branch: str) -> None:
        for number, each in enumerate(block):
            name, place = f"s{len(steps)}", [parent, branch, f"{number}V"]
            if isinstance(each, str) and each.startswith("-"):
                steps[name] = {"kind": "release", "place": place, "params": {"role": each[1:]}}
                continue
            if isinstance(each, str):
                goal = GOALS[len(steps) % 4]
                steps[name] = {"kind": "move", "place": place, "params": {"role": each, "to": {"device": goal}}}
                continue
            kind, params, branches = each
            steps[name] = {"kind": kind, "place": place, "params": params}
            for inner, body in branches.items():
                add(body, name, inner)

    add(program, "program", "body")
    for name, body in (functions or {}).items():
        add(body, name, "body")
    roles = {name: {"name": name, "can": ["move"]} for name in "abcd"} | {
        "bound": {"name": "bound", "device": "robot01"}
    }
    document = {"format": 2, "steps": steps, "roles": roles, "functions": {n: {"name": n} for n in functions or {}}}
    return [each.code for each in compile_document(document, factory()).diagnostics if each.severity == "error"]


@pytest.mark.parametrize(
    ("program", "told"),
    [
        (["a", "b", "c"], []),
        (["a", "b", "c", "d"], ["too_few_robots"]),
        (["a", "b", "bound"], []),
        (["a", "b", "c", "bound"], ["too_few_robots"]),
        (["a", "b", ["if", {"condition": HOT}, {"then": ["c"], "else": ["d"]}]], []),
        (["a", "b", ["if", {"condition": HOT}, {"then": ["c"], "else": ["d"]}], "c"], []),
        (["a", "b", "c", ["if", {"condition": HOT}, {"then": ["d"]}]], ["too_few_robots"]),
        ([["parallel", {"branches": 2}, {"a": ["a", "b"], "b": ["c", "d"]}]], ["too_few_robots"]),
        ([["repeat", {"times": 2}, {"body": ["a", "b"]}], "c", "d"], ["too_few_robots"]),
        ([["while", {"condition": HOT}, {"body": ["a", "b"]}], "c", "d"], []),
        ([["try", {}, {"body": ["a", "b"], "catch": ["c"]}], "d"], []),
        (["a", "b", ["try", {}, {"body": [["wait", {"duration": 5}, {}]], "catch": ["c", "d"]}]], ["too_few_robots"]),
        (["a", "b", "c", "-a", "d"], []),
        (["a", "b", "c", "-a", "d", "a"], ["too_few_robots"]),
        (["a", "b", "c", ["if", {"condition": HOT}, {"then": ["-a"]}], "d"], []),
        (["a", "b", "c", ["repeat", {"times": 2}, {"body": ["-a", "d", "-d", "a"]}]], []),
        (["a", "b", "c", ["parallel", {}, {"a": ["-a"], "b": ["d"]}]], []),
        (["a", "b", "c", ["parallel", {}, {"a": ["-a", "a"], "b": ["-b"]}], "d"], []),
        (["a", "b", ["parallel", {}, {"a": ["c"], "b": ["-a"]}], "d", "a"], ["too_few_robots"]),
        (["a", "b", ["parallel", {"needed": 1}, {"a": ["c"], "b": [["wait", {"duration": 5}, {}]]}], "d"], []),
    ],
)
def test_roles_of_one_path_need_robots_of_their_own(program: list[Any], told: list[str]) -> None:
    assert codes(program) == told


def test_roles_of_functions_count_where_they_are_called() -> None:
    call = ["call", {"function": "f"}, {}]
    assert codes(["a", "b", call], {"f": ["c", "d"]}) == ["too_few_robots"]
    assert codes(["a", call], {"f": ["c", "d"]}) == []
    assert codes(["a", call], {"f": ["c", call]}) == ["calls_itself"]


def test_functions_that_call_each_other_in_a_long_chain_are_followed_so_far() -> None:
    chain: dict[str, list[Any]] = {f"f{i}": [["call", {"function": f"f{i + 1}"}, {}]] for i in range(600)}
    assert codes(["a", ["call", {"function": "f0"}, {}]], {**chain, "f600": ["b"]}) == []
