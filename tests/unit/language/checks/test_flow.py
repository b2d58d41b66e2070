"""What the checks say of the ways through a program, on trees built by hand; `s1`, `s2` … count the steps."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest

from editor.language.analysis.effects import EffectTable
from editor.language.checks.bodies import find_bodies
from editor.language.checks.checks import CHECKS
from editor.language.checks.context import Context
from editor.language.checks.parallel import check_parallel
from editor.language.checks.paths import check_paths, functions_without_end
from editor.language.checks.use import check_use
from editor.language.expressions.nodes import AnswerSpec, Constant, Expression, Operation, Reading, Variable
from editor.language.tree.nodes import (
    Ask,
    Block,
    Break,
    Call,
    Catch,
    Continue,
    End,
    Event,
    ForEach,
    If,
    Node,
    Notify,
    Parallel,
    Repeat,
    Return,
    Set,
    Try,
    Wait,
    WaitUntil,
    While,
)
from editor.language.tree.program import Function, Parameter, Tree
from tests.kit.demo_site import factory

HOT = Operation(">", (Reading(Constant("curingOven01"), "temperature"), Constant(60)))
TRUE, FALSE, ONE = Constant(True), Constant(False), Constant(1)
X, Y = Variable("x"), Variable("y")
PAUSE = Wait(ONE)


def named(block: Block, step: str) -> Block:
    return tuple(replace(node, step=f"{step}{index}") for index, node in enumerate(block, start=1))


def told(check: Callable[[Context], None], tree: Tree) -> list[tuple[str, str]]:
    context = Context(tree, factory())
    check(context)
    return [(problem.step, problem.code) for problem, _ in context.found]


def follow(context: Context) -> None:
    check_paths(context, find_bodies(context), CHECKS)
    check_use(context)


def flow(*body: Node, functions: tuple[Function, ...] = (), events: tuple[Event, ...] = ()) -> list[tuple[str, str]]:
    found = told(follow, Tree(named(body, "s"), functions, (), (), events))
    return [each for each in found if each[1] not in {"unset_variable", "may_be_unset", "unused_variable"}]


def variables(*body: Node, functions: tuple[Function, ...] = (), parameters: tuple[str, ...] = ()) -> list[str]:
    given = tuple(Parameter(name) for name in parameters)
    found = told(follow, Tree(named(body, "s"), functions, (), given))
    return [code for _, code in found if code in {"unset_variable", "may_be_unset", "unused_variable"}]


def use(*values: Expression) -> tuple[Node, ...]:
    return tuple(Notify(value) for value in values)


@pytest.mark.parametrize(
    "leaving",
    [
        End(),
        While(TRUE, (PAUSE, If(HOT, (End(),)))),
        If(HOT, (End(),), (End(),)),
        If(TRUE, (End(),)),
        Repeat(Constant(2), (End(),)),
        ForEach("x", (ONE,), body=(End(),)),
        Try((End(),), (Catch((), (End(),)),)),
        Try((PAUSE,), (Catch(),), (End(),)),
        Parallel(((End(),), (PAUSE,))),
    ],
)
def test_what_follows_is_never_reached(leaving: Node) -> None:
    assert flow(leaving, PAUSE, PAUSE) == [("s2", "never_reached")]


@pytest.mark.parametrize(
    "going_on",
    [
        If(HOT, (End(),)),
        While(HOT, (End(),)),
        While(TRUE, (If(HOT, (Break(),)),)),
        Repeat(Constant(0), (End(),)),
        Repeat(X, (End(),)),
        Repeat(Constant(3), (PAUSE, Break())),
        Try((End(),), (Catch((), (PAUSE,)),)),
        Try((PAUSE,), (Catch((), (End(),)),)),
        Parallel(((PAUSE,), (PAUSE,))),
    ],
)
def test_what_follows_may_be_reached(going_on: Node) -> None:
    assert flow(going_on, PAUSE) == []


def test_a_loop_that_nothing_leaves_never_ends() -> None:
    assert flow(While(TRUE, (PAUSE,))) == [("s1", "never_ends")]
    assert flow(While(TRUE, (While(HOT, (Break(),)),))) == [("s1", "never_ends")]
    assert flow(While(TRUE, (Try((If(HOT, (Break(),)),), (Catch(),)),))) == []


@pytest.mark.parametrize(
    ("program", "found"),
    [
        ((While(HOT, named((Continue(), PAUSE), "t")),), "never_reached"),
        ((While(TRUE, (PAUSE, Continue())),), "never_ends"),
        ((While(TRUE, (If(HOT, (Continue(),)), PAUSE, Break())), PAUSE), ""),
        ((Repeat(Constant(2), (PAUSE, Continue())), PAUSE), ""),
        ((ForEach("i", (ONE,), body=(If(HOT, (Continue(),), (End(),)),)), PAUSE), ""),
        ((ForEach("i", (ONE,), body=(If(HOT, (End(),)), Continue())), PAUSE), ""),
        ((Repeat(ONE, (Try((Continue(),), (), (PAUSE,)),)), PAUSE), ""),
    ],
)
def test_a_round_that_is_left_goes_on_with_the_next(program: tuple[Node, ...], found: str) -> None:
    assert [code for _, code in flow(*program)] == ([found] if found else [])


def test_what_is_set_before_a_round_is_left_is_known_in_the_next() -> None:
    left = (Set("x", ONE), If(HOT, (Continue(),)), Set("y", ONE))
    assert variables(Repeat(Constant(2), left), *use(X)) == ["unused_variable"]
    assert variables(Repeat(Constant(2), left), *use(X, Y)) == ["may_be_unset"]


def test_a_loop_must_look_at_something_that_changes() -> None:
    above = Operation(">", (X, ONE))
    assert flow(While(above, (PAUSE,))) == [("s1", "may_never_end")]
    assert flow(While(above, (Set("x", ONE),))) == []
    assert flow(While(above, (PAUSE, If(HOT, (Break(),))))) == []
    assert flow(While(Operation(">", (Operation("now", ()), ONE)), (PAUSE,))) == []


def test_a_loop_may_wait_for_what_an_event_or_another_branch_sets() -> None:
    waiting = While(Operation("not", (X,)), (PAUSE,))
    assert flow(waiting, events=(Event(HOT, (Set("x", TRUE),)),)) == []
    assert flow(Parallel(((waiting,), (Set("x", TRUE),)))) == []


def test_a_call_in_a_loop_may_set_what_ends_it() -> None:
    less = Function("less", (), (Set("x", ONE),))
    asked = Ask(ONE, AnswerSpec("number"), "x")
    assert flow(asked, While(Operation(">", (X, ONE)), (Call("less"),)), functions=(less,)) == []
    own = Function("less", (Parameter("x"),), (Set("x", ONE),))
    loop = While(Operation(">", (X, ONE)), (Call("less", (("x", ONE),)),))
    assert flow(asked, loop, functions=(own,)) == [("s2", "may_never_end"), ("", "unused_parameter")]


def test_recursion_needs_a_way_on_which_it_ends() -> None:
    again, maybe = Call("f", step="c"), If(HOT, (Call("f", step="c"),))
    assert flow(Call("f"), functions=(Function("f", (), (PAUSE, again)),)) == [("c", "calls_itself")]
    assert flow(Call("f"), functions=(Function("f", (), (PAUSE, maybe)),)) == []
    assert flow(Call("f"), functions=(Function("f", (), (If(HOT, (Return(),)), again)),)) == []


def test_functions_that_only_call_each_other_never_end() -> None:
    pair = (Function("f", (), (Call("g", step="a"),)), Function("g", (), (Call("f", step="b"),)))
    assert flow(Call("f"), PAUSE, functions=pair) == [
        ("s2", "never_reached"),
        ("a", "calls_itself"),
        ("b", "calls_itself"),
    ]


def test_the_ways_out_of_functions_are_understood_together() -> None:
    stop = Function("stop", (), (End(),))
    outer = Function("outer", (), (If(HOT, (Call("stop"),)), Return()))
    tree = Tree((), (outer, stop))
    assert functions_without_end(tree, EffectTable(tree)) == frozenset()
    assert flow(Call("stop"), PAUSE, functions=(stop,)) == [("s2", "never_reached")]


def test_a_result_is_given_on_every_way_and_taken() -> None:
    half = Function("f", (), (If(HOT, (Return(ONE),), step="i"),), "number")
    whole = Function("f", (), (If(HOT, (Return(ONE),)), Return(ONE)), "number")
    assert flow(Call("f", result="x"), functions=(half,)) == [("i", "no_value_on_some_way")]
    assert flow(Call("f"), functions=(whole,)) == [("s1", "unused_result")]
    assert flow(Call("f", result="x"), functions=(whole,)) == []


def test_functions_are_used_when_the_program_or_an_event_leads_to_them() -> None:
    f, g = Function("f", (), (Call("g", step="f1"),)), Function("g", (), (Wait(ONE, step="g1"),))
    assert flow(PAUSE, functions=(f, g)) == [("f1", "unused_function"), ("g1", "unused_function")]
    assert flow(PAUSE, functions=(f, g), events=(Event(HOT, (Call("f"),)),)) == []


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ((*use(X), Set("x", ONE)), ["unset_variable"]),
        ((Set("x", ONE), *use(X)), []),
        ((If(HOT, (Set("x", ONE),)), *use(X)), ["may_be_unset"]),
        ((If(HOT, (Set("x", ONE),), (Set("x", ONE),)), *use(X)), []),
        ((If(HOT, (Set("x", ONE),), (End(),)), *use(X)), []),
        ((While(HOT, (Set("x", ONE),)), *use(X)), ["may_be_unset"]),
        ((While(TRUE, (Ask(ONE, variable="x"), If(X, (Break(),)))), *use(X)), []),
        ((Repeat(Constant(2), (Set("x", ONE),)), *use(X)), []),
        ((Repeat(Y, (Set("x", ONE),)), *use(X)), ["may_be_unset"]),
        ((ForEach("y", (ONE,), body=(Set("x", Y),)), *use(X)), []),
        ((Try((Set("x", ONE),), (Catch((), (PAUSE,)),)), *use(X)), ["may_be_unset"]),
        ((Try((PAUSE,), (Catch(),), (Set("x", ONE),)), *use(X)), []),
        ((Parallel(((Set("x", ONE),), (PAUSE,))), *use(X)), []),
        ((Parallel(((Set("x", ONE),), use(X))),), ["may_be_unset"]),
        ((Set("x", ONE),), ["unused_variable"]),
        ((Ask(ONE, variable="x"),), ["unused_variable"]),
    ],
)
def test_variables_are_followed_along_all_ways(body: tuple[Node, ...], expected: list[str]) -> None:
    assert variables(*body) == expected


def test_a_function_sets_variables_of_the_program_for_whoever_calls_it() -> None:
    f = Function("f", (), (Set("x", ONE),))
    assert variables(Call("f"), *use(X), If(HOT, (Set("x", ONE),)), functions=(f,)) == []
    g = Function("f", (), use(X))
    assert variables(Call("f"), Set("x", ONE), functions=(g,)) == ["unset_variable"]
    assert variables(Set("x", ONE), Call("f"), functions=(g,)) == []
    assert variables(If(HOT, (Set("x", ONE),)), Call("f"), functions=(g,)) == ["may_be_unset"]


def test_a_parameter_has_a_value_from_the_beginning() -> None:
    assert variables(*use(X), Set("x", ONE), parameters=("x",)) == []
    f = Function("f", (Parameter("x"),), (*use(X), Set("x", ONE)))
    assert variables(Call("f"), functions=(f,)) == []


def test_recursion_makes_no_false_alarm() -> None:
    f = Function("f", (), (*use(X), If(HOT, (Call("f"),))))
    assert variables(Set("x", ONE), Call("f"), functions=(f,)) == []


def waiting(first: Block, second: Block, *before: Node) -> list[str]:
    start = (Set("x", FALSE), Set("y", FALSE), *before)
    tree = Tree(named((*start, Parallel((first, second))), "s"))
    return [code for _, code in told(check_parallel, tree)]


def test_branches_that_each_wait_for_what_the_other_sets_later_never_go_on() -> None:
    first, second = (WaitUntil(X), Set("y", TRUE)), (WaitUntil(Y), Set("x", TRUE))
    assert waiting(first, second) == ["branches_wait"]


def test_branches_do_not_wait_for_ever_where_anything_may_end_it() -> None:
    first, second = (WaitUntil(X), Set("y", TRUE)), (WaitUntil(Y), Set("x", TRUE))
    assert waiting((Set("y", TRUE), *first), second) == []
    assert waiting((WaitUntil(X, ONE), *first[1:]), second) == []
    assert waiting(first, second, Set("x", TRUE)) == []
    assert waiting(first, second, Ask(ONE, variable="x")) == []
    assert waiting((WaitUntil(HOT), *first[1:]), second) == []
