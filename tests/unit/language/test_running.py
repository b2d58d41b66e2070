"""The cases of the constructs, compiled and carried out by the run machine: what happens, in order."""

from __future__ import annotations

import json

import pytest

from editor.language import compile_document
from editor.language.plan.instructions import Plan
from execution.machine import machine
from execution.machine import messages as m
from tests.kit.demo_site import factory
from tests.kit.files import ROOT

HOT = {("curingOven01", "temperature"): 80}


def plan_of(case: str) -> Plan:
    document = json.loads((ROOT / "tests" / "cases" / "constructs" / f"{case}.json").read_text())["document"]
    plan = compile_document(document, factory()).plan
    assert plan is not None
    return plan


def in_words(action: m.Action) -> str:
    match action:
        case m.StepEntered(step=step):
            return f"+{step}"
        case m.StepLeft(step=step):
            return f"-{step}"
        case m.StepFailed(step=step):
            return f"!{step}"
        case m.Tell(text=text):
            return f"“{text}”"
        case m.Ask(order=order):
            return f"{order.kind}:{order.target.id}"
        case m.SetTimer(seconds=seconds):
            return f"{seconds:g}s"
    return type(action).__name__


def answer_to(actions: tuple[m.Action, ...], fails: str) -> m.Event | None:
    """Return what happens next: tasks are done (or fail), questions are answered, time goes by."""
    for action in reversed(actions):
        match action:
            case m.AskPeople(question=question):
                return m.Answered(question, True)
            case m.Ask(task=task):
                return m.TaskFailed(task, fails, "It did not work.") if fails else m.TaskDone(task)
            case m.SetTimer(timer=timer):
                return m.TimerFired(timer)
    return None


def told(case: str, fails: str = "") -> str:
    """Carry a case out and return what happened; each task fails in that way, if one is given."""
    plan = plan_of(case)
    state, actions = machine.start(plan, {}, HOT)
    log = [in_words(action) for action in actions]
    while state.status == "running" and (event := answer_to(actions, fails)) is not None:
        state, actions = machine.step(plan, state, event)
        log += map(in_words, actions)
    return f"{' '.join(log[:-1])} → {state.status}"


@pytest.mark.parametrize(
    ("case", "story"),
    [
        ("repeat-three-times", "+r +w 5s -w +w 5s -w +w 5s -w -r"),
        ("repeat-empty", "+r -r"),
        ("for-each-device", "+f +m move:paintMixer01 -m +m move:paintMixer02 -m -f"),
        ("for-each-hides-a-parameter", "+f +n “a” -n +n “b” -n -f +o “z” -o"),
        ("for-each-in-parallel", "+f +p +n “a” -n +m “a” -m -p +p +n “b” -n +m “b” -m -p -f"),
        ("break-leaves-only-the-innermost", "+r +q +b -b -q +n “done” -n +q +b -b -q +n “done” -n -r"),
        ("break-in-a-for-each-by-value", "+f +i -i +n “done” -n +i +b -b -i -f"),
        ("break-through-a-finally", "+r +t +b -b +n “done” -n -t -r +w 5s -w"),
        ("continue-in-a-for-each", "+f +i -i +n “done” -n +i +c -c -i +i -i +n “done” -n -f"),
        ("continue-through-a-finally", "+r +t +c -c +n “done” -n -t +t +c -c +n “done” -n -t -r +w 5s -w"),
        (
            "continue-in-a-while",
            "+s -s +w +a -a +i -i +m “n 1” -m +a -a +i +c -c -i +a -a +i -i +m “n 3” -m -w",
        ),
        (
            "continue-goes-on-with-the-innermost",
            "+r +q +c -c +c -c -q +m “again” -m +q +c -c +c -c -q +m “again” -m -r",
        ),
        ("for-each-with-its-number", "+f +n “1: a” -n +w 60s -w +n “2: b” -n +w 120s -w -f"),
        (
            "for-each-numbers-in-each-other",
            "+f +g +n “1: a” -n -g +m “1: a” -m +g +n “1: b” -n -g +m “2: b” -m -f",
        ),
        ("for-each-over-a-list", "+s -s +f +t “Here: red” -t +t “Here: blue” -t -f"),
        ("list-that-grows", "+s -s +f +g -g +g -g -f +t “Here: 2 blue red, blue” -t"),
        ("list-with-a-unit", "+s -s +w 90s -w +r -r +f +v 2s -v +v 60s -v +v 90s -v -f"),
        (
            "list-contains",
            "+s -s +i +t “Here: 2” -t -i +f +v move:paintMixer01 -v +v move:paintMixer02 -v -f",
        ),
        ("for-each-list-before-items", "+s -s +f +t “Here: yes” -t +t “Here: no” -t -f"),
        ("set-and-count", "+s -s +r +t -t +t -t +t -t -r +n “Painted 3” -n"),
        ("set-in-a-function-is-its-own", "+c +s -s +w 2s -w -c"),
        ("set-in-a-function-for-the-program", "+s -s +c +t -t -c +w 2s -w"),
        ("set-a-parameter-of-a-function", "+c +s -s +w 6s -w -c"),
        ("set-with-a-unit", "+s -s +w 120s -w"),
        ("ask-yes-or-no", "+a 600s AskPeople CancelTimer -a +i +n “done” -n -i"),
        ("return-a-value", "+c +r -r -c +w 4s -w"),
        ("return-through-two-finallies", "+c +t +u +s -s +r -r +n “done” -n +o “done” -o -u -t -c +w 4s -w"),
        ("function-that-calls-itself-until", "+c +i +w 5s -w +d +w 5s -w +w 5s -w -i -d -c"),
        ("try-finally", "+t +w 5s -w +n “done” -n -t"),
        ("try-finally-in-a-finally", "+t +w 5s -w +u +n “done” -n +o “done” -o -u -t"),
        ("end-through-a-finally", "+t +e -e +n “done” -n -t"),
        ("end-in-a-branch", "+i +e -e -i"),
        ("limit-in-a-loop", "+r +l 60s +w 5s -w CancelTimer -l +l 60s +w 5s -w CancelTimer -l -r"),
        ("limit-left-by-a-break", "+r +l 60s +b -b CancelTimer -l -r +w 5s -w"),
        ("limit-left-by-a-return", "+c +l 60s +t +r -r +n “Over.” -n CancelTimer -t -l -c +w 4s -w"),
        ("limit-by-a-variable", "+s -s +l 120s +w -w CancelTimer -l"),
    ],
)
def test_a_construct_does_what_it_says(case: str, story: str) -> None:
    assert told(case) == f"{story} → finished"


def test_a_finally_is_carried_out_behind_a_catch_and_where_nothing_catches() -> None:
    blocked, refused = told("try-catch-finally", "blocked"), told("try-catch-finally", "refused")
    assert blocked.startswith("+t +m move:curingOven01 !m +w 5s -w +h move:paintMachine01 !h")
    assert refused.startswith("+t +m move:curingOven01 !m +h move:paintMachine01 !h")
    assert (blocked.split()[-1], refused.split()[-1]) == ("failed", "failed")
