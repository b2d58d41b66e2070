"""Mistakes that people make when they write a script: where each is, and what is told to write instead."""

from __future__ import annotations

import json
import re
from typing import Any

import pytest

from editor.language import parse_script
from editor.language.messages import syntax_errors
from editor.language.messages.phrases import refused_in_german
from tests.kit.demo_site import factory, script
from tests.kit.files import ROOT

CASES = json.loads((ROOT / "tests" / "cases" / "mistakes.json").read_text(encoding="utf-8"))
BEGIN = 9
"""Where the lines of new_task begin."""
MISTAKES = [
    ("import os", 0, "Leave it out: a script uses only what self and ctx give."),
    ("from os import path", 0, "Leave it out: a script uses only what self and ctx give."),
    ("print(5)", 0, 'Tell people by self.notify("The box is dry.").'),
    ("x = input()", 0, "Write self.x: only functions have variables of their own."),
    ("x = 1", 0, "Write self.x: only functions have variables of their own."),
    ("self.f = lambda x: x", 9, "Write a function beside new_task, in class Task: def mix_paint(self, minutes):."),
    ("self.wait([x for x in [1]])", 10, "Write the values one by one, or for oven in [self.oven_a, self.oven_b]:."),
    ("self.curing_oven = 5", 0, "self.curing_oven is a machine; it can cure_paint. What can be read of it: "
     "job_status, temperature, quality. Choose another name for the variable."),
    ("self.curing_oven.explode()", 0, "What it can do: cure_paint."),
    ("self.robot.fly()", 0, "What it can do: move, pick, drop, honk, blink."),
    ("self.curing_oven.cure_paint(", 27, "The bracket ( is never closed. Close it behind its content."),
    ("self.wait(60", 9, "The bracket ( is never closed. Close it behind its content."),
    ("self.wait(60))", 13, "The bracket ) was never opened. Take it away, or open it before."),
    ("self.wait([60))", 13, "The bracket ) closes another one than the last. Close that first."),
    ("\tself.wait(60)", 0, "Indent with spaces, 4 for each level, not with tabs."),
    ("  self.wait(5)", 1, "Indent with 4 spaces for each level, like the lines beside it."),
    ("if True:\n        self.wait(5)", 0, "Indent by 4 spaces what belongs to the line before it, or write pass."),
    ("self.notify(\u201cdry\u201d)", 12, 'Write straight quotation marks: "box".'),
    ("self.notify('dry)", 12, "Close the text with a quotation mark on its line."),
    ("self.wait(60)\xa0", 13, "There is a character here that cannot be seen. Delete it; type a space."),
    ("self.wait(5€)", 11, "The character € belongs only into texts. Delete it."),
    ("if self.curing_oven.temperature = 60: pass", 3, "Compare with ==; a single = sets a variable."),
    ("if self.curing_oven.temperature > 60", 36, "Write a colon at the end of this line."),
    ("else: pass", 0, "There is no if, for, while or try right before this, at the same level."),
    ("elif True: pass", 0, "There is no if, for, while or try right before this, at the same level."),
    ("if True && False: pass", 9, "Write “and” or “or”."),
    ("if True || False: pass", 9, "Write “and” or “or”."),
    ("if !True: pass", 3, "Write “not”."),
    ("self.count++", 12, "Write self.count = self.count + 1."),
    ("self.wait(True ? 1 : 0)", 15, "Write if and else on lines of their own."),
    ("self.wait(5 if True else 6)", 10, "Write if and else on lines of their own."),
    ("for i in range(3): pass", 4, "Write for _ in range(3):."),
    ("def inner(self): pass", 0, "Write functions beside new_task, in class Task: def mix_paint(self, minutes):."),
    ("class B: pass", 0, "A script has one class, Task. Write a function instead: def mix_paint(self):."),
    ("with self.robot: pass", 0, "Leave “with” out and write its lines as they are."),
    ("await self.wait(5)", 0, "Leave “await” out: a script waits by itself until a step is done."),
    ("assert True", 0, "Write if, and inside it self.notify(…) or self.end()."),
    ("raise ValueError()", 0, 'Write raise Failed("The box is wet.").'),
    ("del self.robot", 0, "Leave it out: nothing needs to be deleted."),
    ("global x", 0, "Leave it out: self.count is seen everywhere."),
    ("match 5:\n            case 5: pass", 0, "Write if and else instead."),
    ("wait(60)", 0, "Write self. before it: self.wait(60)."),
    ("time.sleep(5)", 0, "Wait by self.wait(60)."),
    ("self.end", 0, "Write self.end()."),
    ("5 > 3", 0, "Put it where it is used, or keep it: self.count = 5."),
    ("self.wait(len([1], [2]))", 10, "len takes one value."),
    ("self.wait(self.items[0])", 10, "Items are counted from 1. Write nth(self.items, 1)."),
    ("self.robot.pick('box')", 0, 'Write self.robot.pick({"value": 1, "object": "box"}).'),
    ("self.robot.move(self.curing_oven)", 16, "Write self.curing_oven.location."),
    ("self.wait(2 ** 3)", 10, "Use +, -, * or /."),
    ("if 1 < 2 < 3: pass", 3, "Compare two values at a time, and join comparisons with “and”."),
    ("if self.curing_oven.temprature > 5: pass", 3, "Did you mean temperature? What can be read here: "
     "job_status, temperature, quality."),
    ("self.oven.cure_paint(5)", 0, "Did you mean self.curing_oven?"),
    ("self.mix()", 0, "There is no such function. Functions of this task: none yet."),
    ("self.notify(problem.text)", 12, "Write it in an except that names it: except TaskError as problem:."),
    ("try: pass\n        except TaskError: self.notify(problem.kind)",
     30, "Write it in an except that names it: except "
     "TaskError as problem:."),
    ("try: pass\n        except Failed as problem: self.notify(problem.step)", 38,
     "What can be read here: text, kind."),
    ("try: pass\n        except Failed as why: self.notify(why)", 34, "Write why.text, or why.kind."),
    ("try: pass\n        except Failed as why: self.notify(problem.text)", 34,
     "Write it in an except that names it: "
     "except TaskError as problem:."),
    ("raise Failed", 0, 'Write raise Failed("The box is wet.").'),
    ("raise", 0, 'Write raise Failed("The box is wet.").'),
    ("raise Failed('wet') from None", 0, 'Write raise Failed("The box is wet.").'),
    ("raise Blocked('wet')", 0, 'Write raise Failed("The box is wet.").'),
    ("try: pass\n        except: pass", 0, "Catch TaskError, or some of: Refused, Failed, TimedOut, Offline, Blocked, "
     "Cancelled."),
]  # fmt: skip


@pytest.mark.parametrize(("line", "column", "instead"), MISTAKES, ids=[line for line, _, _ in MISTAKES])
def test_a_mistake_is_told_with_its_place_and_what_to_write_instead(line: str, column: int, instead: str) -> None:
    parsed = parse_script(script("self.wait(60)", line), factory())
    assert parsed.tree is None
    first = parsed.diagnostics[0]
    number = 4 + ("\n        " in line and "case" not in line)
    assert (first.line, first.column) == (number, BEGIN + column)
    assert first.message.startswith(f"Line {number}, column {BEGIN + column}: ")
    assert first.message.endswith(instead)
    assert first.args.get("instead", first.args.get("detail")) == instead


@pytest.mark.parametrize("case", CASES, ids=[str(number) for number in range(len(CASES))])
def test_a_written_mistake_is_answered_as_a_teacher_would(case: dict[str, Any]) -> None:
    text = case.get("script") or script(*case["lines"])
    first = parse_script(text, factory()).diagnostics[0]
    assert (first.line, first.column) == (case["line"], case["column"])
    assert first.message_in("en").partition(": ")[2] == case["message"]
    assert first.message_in("de").partition(": ")[2] == case["message_de"]


def test_no_answer_gives_in_run_what_is_given_already() -> None:
    for case in CASES:
        given = re.search(r"Give it in run: self\.(\w+) = ", case["message"])
        text = case.get("script") or script(*case["lines"])
        assert given is None or f"self.{given[1]} =" not in text


def test_every_answer_is_said_in_german_too() -> None:
    for case in CASES:
        text = case.get("script") or script(*case["lines"])
        for told in parse_script(text, factory()).diagnostics:
            for said in (told.args.get("instead", told.args.get("detail")), told.args.get("found", "“x”")):
                assert isinstance(said, str)
                assert refused_in_german(said) != said


def test_twenty_mistakes_are_told_and_the_others_counted() -> None:
    parsed = parse_script(script(*["self.robot.fly()"] * 5000), factory())
    assert [told.code for told in parsed.diagnostics] == ["not_in_language"] * 20 + ["more_mistakes"]
    assert parsed.diagnostics[-1].message == ("There is more to mend from line 23 on: 4980. Begin with the first ones.")
    assert parsed.diagnostics[-1].line == 23


def test_columns_count_characters_not_bytes() -> None:
    parsed = parse_script(script('self.notify("Öl für Änne", level=self.nothing)'), factory())
    [refusal] = parsed.diagnostics
    assert (refusal.column, refusal.args["end_column"]) == (42, 54)
    parsed = parse_script(script('if "Öl" == self.nothing: pass'), factory())
    assert parsed.diagnostics[0].column == 9 + 11


def sentences() -> list[str]:
    tables = (syntax_errors.STATEMENTS, syntax_errors.EXPRESSIONS, syntax_errors.CALLS, syntax_errors.NAMES,
              syntax_errors.FIRST_WORDS)  # fmt: skip
    pairs = (*syntax_errors.SYNTAX, *syntax_errors.BEHIND, *syntax_errors.ON_THE_LINE, *syntax_errors.SYMBOLS)
    fixed = [
        syntax_errors.ATTRIBUTE_ALONE,
        syntax_errors.VALUE_ALONE,
        syntax_errors.NOTHING_BEFORE,
        syntax_errors.UNREADABLE,
        syntax_errors.UNKNOWN.format("no"),
    ]
    said = [*(text for table in tables for text in table.values()), *(text for _, text in pairs), *fixed]
    return sorted({text.replace("{0}", "(") for text in said})


@pytest.mark.parametrize("english", sentences())
def test_what_helps_is_said_in_german_too(english: str) -> None:
    german = refused_in_german(english)
    assert german != english
    assert re.sub(r"[a-zA-Z]", "", german)[-1] == english[-1]


def test_self_takes_no_value_of_its_own() -> None:
    text = script("self.wait(1)").replace(
        "def new_task(self)", "def other(self=1):\n        pass\n\n    def new_task(self)"
    )
    (told,) = parse_script(text, factory()).diagnostics
    assert told.args["instead"] == "Write def other(self, minutes):."


@pytest.mark.parametrize("excepts", [8, 9])
def test_a_try_has_up_to_eight_excepts(excepts: int) -> None:
    clauses = "\n        except Failed: pass" * excepts
    told = parse_script(script("self.wait(60)", f"try: pass{clauses}"), factory()).diagnostics
    wrong = [each for each in told if "up to 8" in each.message]
    assert [(each.line, each.column) for each in wrong] == ([] if excepts == 8 else [(13, BEGIN)])


def test_an_else_of_a_try_is_told() -> None:
    lines = "try: pass\n        except Failed: pass\n        else: pass"
    (told,) = parse_script(script("self.wait(60)", lines), factory()).diagnostics
    assert told.message.endswith("Write these lines at the end of what try holds.")
