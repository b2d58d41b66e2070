"""Names that people give in any language: what the script calls them, and that what is printed reads back."""

from __future__ import annotations

import json
import keyword
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from editor.language import compile_document, parse_script, tree_to_document
from editor.language.expressions.names import RESERVED_ATTRIBUTES, attribute_name, local_name, snake_case
from tests.kit.demo_site import factory
from tests.kit.files import ROOT

NAMES = ["Über Nacht lüften", "名前", "Match", "match", "Ölofen", "ÖLOFEN", "ﬁlter", "mix²", "Straße", "İstanbul",
         "печь", "Печь", "φούρνος", "فرن", "เตา", "1. Ofen", "ⅷ", "é", "e\u0301", "run", "branch_a", "when_e1",
         "class", "__init__", "e\u200dx", "🤖", "", "range", "Wait", "wait", "ª", "\u0301x", "ΣΑΣ"]  # fmt: skip
CASES = json.loads((ROOT / "tests" / "cases" / "names.json").read_text())
"""What the names that the editor makes itself are held to, too."""
names = st.one_of(st.sampled_from(NAMES), st.text(min_size=1, max_size=8))


def program(functions: list[str], roles: list[str], variables: list[str]) -> dict[str, Any]:
    steps: dict[str, Any] = {}

    def add(kind: str, **params: object) -> None:
        order = f"{len(steps):03}V"
        steps[f"s{len(steps)}"] = {"kind": kind, "place": ["program", "body", order], "pos": [0, 0], "params": params}

    for number, name in enumerate(variables):
        add("set", variable=name, value=number)
    for number, _ in enumerate(functions):
        add("call", function=f"f{number}", args={}, result=None)
    for number, _ in enumerate(roles):
        add("move", role=f"r{number}", to={"point": [number, 1]}, route=[])
    return {
        "format": 2,
        "start_pos": [0, 0],
        "steps": steps,
        "roles": {f"r{number}": {"name": name, "can": ["move"]} for number, name in enumerate(roles)},
        "functions": {f"f{number}": {"name": name, "parameters": []} for number, name in enumerate(functions)},
    }


def named(document: Any) -> tuple[list[str], list[str], list[str]]:
    functions = [function["name"] for function in document["functions"].values()]
    roles = [role["name"] for role in document["roles"].values()]
    return functions, roles, [s["params"]["variable"] for s in document["steps"].values() if s["kind"] == "set"]


@given(st.lists(names, max_size=4), st.lists(names, max_size=4), st.lists(names, max_size=4))
@settings(deadline=None)
def test_what_is_printed_reads_back_with_the_names_that_people_gave(
    functions: list[str], roles: list[str], variables: list[str]
) -> None:
    document = program(functions, roles, variables)
    first = compile_document(document, factory())
    parsed = parse_script(first.script, factory())
    assert parsed.tree is not None, (first.script, parsed.diagnostics)
    again = tree_to_document(parsed.tree, factory(), document)
    assert compile_document(again, factory()).script == first.script
    assert named(again) == named(document)
    anew = tree_to_document(parsed.tree, factory())
    assert compile_document(anew, factory()).script == first.script


@given(names)
def test_a_name_of_a_script_is_one_for_python_and_stays_what_it_is(name: str) -> None:
    for called in (snake_case(name), attribute_name(name, ()), local_name(name, ())):
        assert called.isidentifier()
        assert not keyword.iskeyword(called)
    assert snake_case(snake_case(name)) == snake_case(name)
    assert attribute_name(attribute_name(name, ()), ()) == attribute_name(name, ())
    assert local_name(local_name(name, ()), ()) == local_name(name, ())


@pytest.mark.parametrize(("name", "called"), CASES["called"].items())
def test_names_stay_readable_in_any_language(name: str, called: str) -> None:
    assert snake_case(name) == called


def test_the_editor_knows_which_names_are_the_tasks_own() -> None:
    assert set(CASES["reserved"]) == RESERVED_ATTRIBUTES


def test_a_role_keeps_its_name_when_it_is_printed() -> None:
    text = """class Task(object):
    def new_task(self):
        self.Träger.move((1, 2))
        self.träger.move((1, 2))

    def run(self, ctx):
        self.Träger = ctx.any("move")
        self.träger = ctx.any("move")
        self.new_task()
"""
    tree = parse_script(text, factory()).tree
    assert tree is not None
    assert compile_document(tree_to_document(tree, factory()), factory()).script == text
