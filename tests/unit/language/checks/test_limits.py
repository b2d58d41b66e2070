"""What the checks say of time limits: what surely takes too long, and what a limit makes end."""

import pytest

from editor.language import Surroundings, compile_document
from editor.language.compiler import EditedProgram
from tests.kit.demo_site import factory
from tests.kit.programs import document, step

LIMIT, BODY = ("l", "body"), ("program", "body")
HOT = {"op": ">", "args": [{"property": ["curingOven01", "temperature"]}, 60]}
QUICK = {"notice", "empty_branch", "unused_variable"}


def wait(seconds, parent=LIMIT, order="1V"):
    return step("wait", parent, order, duration=seconds)


def limit(seconds=60, parent=BODY, order="1V"):
    return step("limit", parent, order, duration=seconds)


def told(steps, **more):
    found = compile_document(document(steps, **more), factory()).diagnostics
    return [(each.step, each.code) for each in found if each.code not in QUICK]


def within(inner, **more):
    """Return what is told of steps in a limit of a minute."""
    return told({"l": limit(), **inner}, **more)


@pytest.mark.parametrize(
    ("inner", "late"),
    [
        ({"a": wait(59)}, []),
        ({"a": wait(60)}, ["a"]),
        ({"a": wait({"quantity": [1, "MIN"]})}, ["a"]),
        ({"a": wait(30), "b": wait(20, order="2V"), "c": wait(10, order="3V"), "d": wait(9, order="4V")}, ["c"]),
        ({"r": step("repeat", LIMIT, times=3), "a": wait(20, ("r", "body"))}, ["r"]),
        ({"r": step("repeat", LIMIT, times=2), "a": wait(20, ("r", "body"))}, []),
        ({"r": step("for_each", LIMIT, variable="x", items=[1, 2, 3]), "a": wait(20, ("r", "body"))}, ["r"]),
        ({"w": step("while", LIMIT, condition=HOT), "a": wait(59, ("w", "body"))}, []),
        ({"w": step("while", LIMIT, condition=HOT), "a": wait(60, ("w", "body"))}, ["a"]),
        ({"w": step("while", LIMIT, condition=HOT), "a": wait(50, ("w", "body")), "b": wait(50, order="2V")}, []),
        ({"t": step("try", LIMIT), "a": wait(50, ("t", "body")), "b": wait(50, order="2V")}, []),
        ({"t": step("try", LIMIT, catch=False), "a": wait(50, ("t", "body")), "b": wait(50, order="2V")}, ["b"]),
        ({"i": step("if", LIMIT, condition=HOT), "a": wait(60, ("i", "then"))}, ["a"]),
        ({"i": step("if", LIMIT, condition=HOT), "a": wait(50, ("i", "then")), "b": wait(50, order="2V")}, []),
        ({"t": step("try", LIMIT), "a": wait(50, ("t", "body")), "b": wait(50, ("t", "catch"))}, []),
        ({"p": step("parallel", LIMIT, branches=["a", "b"]), "a": wait(90, ("p", "a")), "b": wait(5, ("p", "b"))},
         ["a"]),
    ],
)  # fmt: skip
def test_what_waits_as_long_as_the_limit_or_longer_is_told(inner, late):
    assert [found for found in within(inner) if found[1] == "past_limit"] == [(name, "past_limit") for name in late]


def test_a_loop_that_may_be_left_early_is_not_told():
    inner = {
        "r": step("repeat", LIMIT, times=100),
        "i": step("if", ("r", "body"), condition=HOT),
        "b": step("break", ("i", "then")),
        "a": wait(20, ("r", "body"), "2V"),
    }
    assert within(inner) == []


def test_the_outer_of_two_limits_counts_where_it_is_over_first():
    steps = {"l": limit(60), "k": limit(100, LIMIT), "a": wait(70, ("k", "body"))}
    assert told(steps) == [("a", "past_limit")]
    steps = {"l": limit(600), "k": limit(100, LIMIT), "a": wait(70, ("k", "body"))}
    assert told(steps) == []


def test_an_inner_limit_begins_when_it_is_come_to():
    steps = {"l": limit(100), "a": wait(50), "k": limit(60, LIMIT, "2V"), "b": wait(55, ("k", "body"))}
    assert told(steps) == [("b", "past_limit")]
    steps = {"a": wait(50, BODY, "0V"), "l": limit(60, BODY), "b": wait(55)}
    assert told(steps) == []


COLD = {"op": "<", "args": [{"property": ["curingOven01", "temperature"]}, -300]}


def test_a_wait_for_what_never_comes_true_lasts_until_the_limit_is_over():
    never = {"u": step("wait", LIMIT, until=COLD)}
    assert within(never) == [("u", "past_limit")]
    assert told({"u": step("wait", BODY, until=COLD)}) == [("u", "waits_for_ever")]
    assert ("u", "waits_for_ever") in told({"l": limit(), "a": wait(5), "u": step("wait", BODY, "2V", until=COLD)})


def test_a_limit_by_a_variable_is_not_reckoned_with():
    steps = {"s": step("set", BODY, "0V", variable="v", value={"quantity": [1, "SEC"]}),
             "l": limit({"param": "v"}), "a": wait(60)}  # fmt: skip
    assert told(steps) == []


def test_a_limit_that_may_be_negative_is_told_by_its_variable():
    steps = {
        "s": step("set", BODY, "0V", variable="v", value={"quantity": [-5, "SEC"]}),
        "l": limit({"param": "v"}),
        "a": wait(5),
    }
    assert told(steps) == [("l", "limit_not_positive")]


LOOP = {"w": step("while", LIMIT, condition=True), "a": wait(5, ("w", "body"))}


def test_a_loop_in_a_limit_ends_by_it_and_without_it_never():
    assert within(LOOP) == []
    assert told({**LOOP, "w": step("while", condition=True)}) == [("w", "never_ends")]


def test_a_loop_around_such_a_limit_is_left_by_its_failure():
    steps = {"o": step("while", condition=True), "l": limit(60, ("o", "body")), **LOOP}
    assert told(steps) == []


def test_a_loop_around_a_limit_that_may_end_in_time_is_endless():
    steps = {"o": step("while", condition=True), "l": limit(60, ("o", "body")), "a": wait(5)}
    assert told(steps) == [("o", "never_ends")]


def test_a_loop_whose_condition_nothing_changes_is_fine_in_a_limit():
    steps = {
        "s": step("ask", BODY, "0V", question="?", answer={"type": "boolean"}, variable="v"),
        "l": limit(),
        "w": step("while", LIMIT, condition={"param": "v"}),
        "a": wait(5, ("w", "body")),
    }
    assert told(steps) == []
    assert told({**steps, "w": step("while", BODY, "3V", condition={"param": "v"})}) == [("w", "may_never_end")]


TURNS = {"f": {"name": "turn", "parameters": []}}


def test_a_function_that_never_ends_is_fine_where_a_limit_is_around_its_call_alone():
    body = {"w": step("while", ("f", "body"), condition=True), "a": wait(5, ("w", "body"))}
    called = step("call", LIMIT, function="f")
    assert told({"l": limit(), "c": called, **body}, functions=TURNS) == []
    choice = {"i": step("if", condition=HOT), "l": limit(60, ("i", "then")), "c": called}
    both = {**choice, "d": step("call", ("i", "else"), function="f"), **body}
    assert ("w", "never_ends") in told(both, functions=TURNS)


def test_a_function_that_calls_itself_is_endless_in_a_limit_too():
    steps = {"l": limit(), "c": step("call", LIMIT, function="f"), "d": step("call", ("f", "body"), function="f")}
    assert ("d", "calls_itself") in told(steps, functions=TURNS)


def test_a_loop_that_is_taken_out_of_its_limit_is_told_at_the_next_look():
    site = factory()
    edited = EditedProgram()
    inside = document({"l": limit(), **LOOP, "n": wait(5, LIMIT, "2V")})
    outside = {**inside, "steps": {**inside["steps"], "w": {**LOOP["w"], "place": ["program", "body", "2V"]}}}
    for program in (inside, outside, inside):
        looked = edited.compile(program, site)
        assert looked.diagnostics == compile_document(program, site).diagnostics
    assert "never_ends" in {each.code for each in compile_document(outside, site).diagnostics}


@pytest.mark.parametrize(
    "duration", [None, [], {}, "x", True, [1, 2], {"quantity": [1, "KiloGM"]}, 1e308, -1e308, 10**400]
)
def test_odd_durations_are_no_reason_to_fail(duration):
    program = document(
        {"l": limit(duration), "r": step("repeat", LIMIT, times=10**400), "a": wait(1e300, ("r", "body"))}
    )
    compiled = compile_document(program, Surroundings())
    assert compiled.script
