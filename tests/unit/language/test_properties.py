from __future__ import annotations

import json
from typing import Any

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from editor.language import (
    compile_document,
    compiled_to_json,
    parse_script,
    plan_from_json,
    plan_to_json,
    tree_to_document,
)
from tests.kit.demo_site import factory, with_device
from tests.unit.language.strategies import broken_documents, documents, json_values

quick = settings(max_examples=25, deadline=None, suppress_health_check=list(HealthCheck))


@quick
@given(documents())
def test_a_printed_script_reads_back_as_the_same_tree(document: dict[str, Any]) -> None:
    compiled = compile_document(document, factory())
    parsed = parse_script(compiled.script, factory())
    assert parsed.diagnostics == (), compiled.script
    assert parsed.tree == compiled.tree, compiled.script


@quick
@given(documents(6))
def test_it_reads_back_also_where_the_robot_is_known_to_stand(document: dict[str, Any]) -> None:
    site = with_device("robot01", standing_at="itemInventory01")
    compiled = compile_document(document, site)
    parsed = parse_script(compiled.script, site)
    assert parsed.diagnostics == (), compiled.script
    assert parsed.tree == compiled.tree, compiled.script


@quick
@given(documents())
def test_a_tree_drawn_again_means_the_same(document: dict[str, Any]) -> None:
    compiled = compile_document(document, factory())
    drawn = tree_to_document(compiled.tree, factory(), document)
    again = compile_document(drawn, factory())
    assert again.tree == compiled.tree, compiled.script
    assert again.script == compiled.script


@quick
@given(documents())
def test_a_script_drawn_means_the_same(document: dict[str, Any]) -> None:
    tree = parse_script(compile_document(document, factory()).script, factory()).tree
    assert tree is not None
    assert compile_document(tree_to_document(tree, factory()), factory()).tree == tree


@quick
@given(documents())
def test_a_plan_exists_exactly_when_there_is_no_error(document: dict[str, Any]) -> None:
    compiled = compile_document(document, factory())
    errors = [d for d in compiled.diagnostics if d.severity == "error"]
    assert (compiled.plan is None) == bool(errors)
    if compiled.plan is not None:
        assert plan_from_json(json.loads(json.dumps(plan_to_json(compiled.plan)))) == compiled.plan


@quick
@given(documents())
def test_every_placed_step_has_a_number_of_its_own_and_every_line_a_known_step(document: dict[str, Any]) -> None:
    compiled = compile_document(document, factory())
    assert len(set(compiled.numbers.values())) == len(compiled.numbers)
    assert sorted(compiled.order) == sorted(document["steps"])
    assert set(compiled.lines) - {""} <= set(compiled.numbers)
    assert len(compiled.lines) == len(compiled.script.splitlines())


@quick
@given(documents(), st.randoms())
def test_the_order_of_keys_and_the_run_do_not_matter(document: dict[str, Any], random: Any) -> None:
    shuffled = list(document["steps"].items())
    random.shuffle(shuffled)
    other = {**document, "steps": dict(shuffled)}
    first, second = (compiled_to_json(compile_document(d, factory())) for d in (document, other))
    assert json.dumps(first) == json.dumps(second)


@quick
@given(st.one_of(broken_documents, json_values))
def test_nothing_in_a_document_makes_the_compiler_raise(document: Any) -> None:
    compiled = compile_document(document, factory())
    assert compiled.script.startswith("class Task(object):\n")
    json.dumps(compiled_to_json(compiled))


@quick
@given(documents(8), st.data())
def test_nothing_in_a_step_makes_the_compiler_raise(document: dict[str, Any], data: st.DataObject) -> None:
    for step in document["steps"].values():
        for name in list(step["params"]):
            if data.draw(st.booleans()):
                step["params"][name] = data.draw(json_values)
    compiled = compile_document(document, factory())
    assert parse_script(compiled.script, factory()).tree == compiled.tree, compiled.script


@quick
@given(st.text(max_size=200))
def test_no_text_makes_the_parser_raise(text: str) -> None:
    assert parse_script(text, factory()).tree is None


@quick
@given(documents(8), st.data())
def test_no_damaged_script_makes_the_parser_raise(document: dict[str, Any], data: st.DataObject) -> None:
    script = compile_document(document, factory()).script
    at = data.draw(st.integers(0, len(script)))
    damaged = (
        script[:at] + data.draw(st.sampled_from(["", "(", "x", ":", "\n", '"', "1", " ", "\t"])) + script[at + 1 :]
    )
    parsed = parse_script(damaged, factory())
    assert (parsed.tree is None) == bool(parsed.diagnostics)
