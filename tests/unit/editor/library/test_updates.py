"""A library function at another version: what it brings in stands for itself, and what it needs no more goes."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import count
from types import MappingProxyType
from typing import Any

from editor.language import compile_document
from editor.library.function_extraction import cut_out_function
from editor.library.updates import with_version
from tests.kit.demo_site import factory
from tests.kit.programs import document, step
from tests.kit.work import count_work

F = ("f", "body")
NOW = ("l", 2)


def held(**more: Any) -> dict[str, Any]:
    """Return a definition of a function as a program holds it, of the library's function l."""
    return {"name": "fetch", "parameters": [], "source": {"library": "l", "version": 1}, **more}


def cut(steps: dict[str, Any], **more: Any) -> dict[str, Any]:
    """Return a version of the library's function."""
    return {"id": "f", "function": {"name": "fetch", "parameters": []}, "functions": {}, "steps": steps, **more}


def update(
    drawn: dict[str, Any], version: dict[str, Any], former: Mapping[int, Mapping[str, Any]] = MappingProxyType({})
) -> dict[str, Any]:
    numbers = count()
    return with_version(drawn, version, NOW, lambda: f"n{next(numbers)}", former)


def errors(drawn: dict[str, Any]) -> list[str]:
    return [each.code for each in compile_document(drawn, factory()).diagnostics if each.severity == "error"]


def carrier(role: str, above: int) -> dict[str, Any]:
    where = {"op": ">", "args": [{"property": [{"role": role}, "battery"]}, above]}
    return {"name": "Carrier", "can": ["move"], "where": where}


def test_a_role_that_names_itself_in_its_condition_does_so_under_its_new_id_too() -> None:
    go = {"go": step("move", F, role="r", to={"device": "dropOff01"})}
    call = step("call", function="f", args={})
    drawn = document({**go, "call": call}, functions={"f": held()}, roles={"r": carrier("r", 50)})
    assert errors(drawn) == []
    after = update(drawn, cut(go, roles={"r": carrier("r", 30)}))
    (role,) = {each["params"]["role"] for each in after["steps"].values() if each["kind"] == "move"}
    assert role != "r"
    assert after["roles"] == {"r": carrier("r", 50), role: carrier(role, 30)}
    assert errors(after) == []


def test_functions_that_came_with_the_former_version_go_with_it_but_for_those_that_something_else_calls() -> None:
    def calls(parent: str, called: str) -> dict[str, Any]:
        return step("call", (parent, "body"), function=called, args={})

    def waits(parent: str) -> dict[str, Any]:
        return step("wait", (parent, "body"), order="2V", duration=1)

    def names(after: dict[str, Any]) -> list[str]:
        return sorted(each["name"] for each in after["functions"].values())

    named = {name: {"name": name, "parameters": []} for name in ("rinse", "drain", "mine")}
    steps = {
        "main": calls("program", "f"),
        "body": calls("f", "old"),
        "more": {**calls("f", "own"), "place": ["f", "body", "3V"]},
        "wet": waits("old"),
        "down": calls("old", "deep"),
        "dry": waits("deep"),
        "kept": waits("own"),
    }
    functions = {"f": held(), "old": named["rinse"], "deep": named["drain"], "own": named["mine"]}
    inner = {"go": calls("f", "g"), "wet": waits("g"), "down": calls("g", "h"), "dry": waits("h")}
    version = cut(inner, functions={"g": named["rinse"], "h": named["drain"]})

    after = update(document(steps, functions=functions), version)
    assert names(after) == ["drain", "fetch", "mine", "rinse"]
    assert not {"wet", "down", "dry", "body", "more"} & after["steps"].keys()
    assert after["steps"]["kept"] == steps["kept"]
    assert errors(after) == []

    draft = {**calls("program", "deep"), "place": None}
    kept = update(document({**steps, "draft": draft}, functions=functions), version)
    assert names(kept) == ["drain", "drain", "fetch", "mine", "rinse"]
    assert ("old" in kept["functions"], kept["steps"]["dry"]) == (False, steps["dry"])

    again = {**calls("deep", "old"), "place": ["deep", "body", "3V"]}
    assert names(update(document({**steps, "again": again}, functions=functions), version)) == names(after)


def test_a_function_that_is_held_as_a_part_of_itself_is_updated_once() -> None:
    steps = {"main": step("call", function="f", args={}), "body": step("call", F, function="f2", args={})}
    functions = {"f": held(), "f2": held()}
    version = cut({"go": step("call", F, function="g", args={})}, functions={"g": {"name": "fetch", "parameters": []}})
    after = update(document(steps, functions=functions), version)
    assert [each.get("source") for each in after["functions"].values()] == [{"library": "l", "version": 2}, None]


def test_functions_that_the_new_version_renamed_or_dropped_go_and_ones_own_of_a_new_name_stays() -> None:
    def calls(parent: str, called: str, order: str = "V") -> dict[str, Any]:
        return {**step("call", function=called, args={}), "place": [parent, "body", order]}

    named = {name: {"name": name, "parameters": []} for name in ("rinse", "drain", "flush")}
    steps = {"main": calls("program", "f"), "a": calls("f", "r"), "b": calls("f", "d", "W"), "c": calls("f", "o", "X")}
    waits = {f"in_{name}": step("wait", (name, "body"), duration=1) for name in "rdo"}
    functions = {"f": held(), "r": named["rinse"], "d": named["drain"], "o": named["flush"]}
    first = cut({}, functions={"r": named["rinse"], "d": named["drain"]})
    version = cut({"go": calls("f", "g")}, functions={"g": named["flush"]})
    after = update(document({**steps, **waits}, functions=functions), version, {1: first, 2: version})
    assert sorted(each["name"] for each in after["functions"].values()) == ["fetch", "flush", "flush"]
    assert (after["functions"]["o"], after["steps"].keys() & waits.keys()) == (named["flush"], {"in_o"})


def test_a_long_program_is_gone_through_a_few_times_whatever_stands_in_it() -> None:
    def work(length: int) -> int:
        steps = {f"s{number}": step("wait", ("w", "body"), duration=1) for number in range(length)}
        nested = {f"n{number}": step("loop", (f"n{number - 1}" if number else "w", "body")) for number in range(20)}
        drawn = document({**steps, **nested}, functions={"w": {"name": "wait", "parameters": []}})
        with count_work() as counted:
            assert len(cut_out_function(drawn, "w")["steps"]) == length + 20
        return counted.lines

    short, long = work(100), work(1000)
    assert long < 12 * short
