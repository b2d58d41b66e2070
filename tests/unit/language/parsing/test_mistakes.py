"""Mistakes that people make when they write a script: where each is, and what is told to write instead."""

from __future__ import annotations

import re

import pytest

from editor.language import parse_script
from editor.language.messages import syntax_errors
from editor.language.messages.phrases import refused_in_german
from tests.kit.demo_site import factory, script

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
    ("self.curing_oven = 5", 0, "This name stands for something else. Choose another."),
    ("self.curing_oven.explode()", 0, "What it can do: cure_paint."),
    ("self.robot.fly()", 0, "What it can do: move, pick, drop."),
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
    ("for i in range(3): pass", 0, "Write for _ in range(3): or for oven in [self.oven_a, self.oven_b]:."),
    ("def inner(self): pass", 0, "Write functions beside new_task, in class Task: def mix_paint(self, minutes):."),
    ("class B: pass", 0, "A script has one class, Task. Write a function instead: def mix_paint(self):."),
    ("with self.robot: pass", 0, "Leave “with” out and write its lines as they are."),
    ("await self.wait(5)", 0, "Leave “await” out: a script waits by itself until a step is done."),
    ("assert True", 0, "Write if, and inside it self.notify(…) or self.end()."),
    ("raise ValueError()", 0, "Write if, and inside it self.notify(…) or self.end()."),
    ("del self.robot", 0, "Leave it out: nothing needs to be deleted."),
    ("global x", 0, "Leave it out: self.count is seen everywhere."),
    ("continue", 0, "Put what follows into an if instead of leaving it out by continue."),
    ("match 5:\n            case 5: pass", 0, "Write if and else instead."),
    ("wait(60)", 0, "Write self. before it: self.wait(60)."),
    ("time.sleep(5)", 0, "Wait by self.wait(60)."),
    ("self.end", 0, "Say what it does, for example self.oven.cure_paint(10) or self.end()."),
    ("5 > 3", 0, "Put it where it is used, or keep it: self.count = 5."),
    ("self.wait(len([1]))", 10, "Use count(condition, …), or write the number."),
    ("self.wait(self.items[0])", 10, "Name a value itself; the language has no places in lists."),
    ("self.robot.pick('box')", 0, 'Write self.robot.pick({"value": 1, "object": "box"}).'),
    ("self.robot.move(self.curing_oven)", 16, "Write where it goes as self.oven.location, or as a point (x, y)."),
    ("self.wait(2 ** 3)", 10, "Use +, -, * or /."),
    ("if 1 < 2 < 3: pass", 3, "Compare two values at a time, and join comparisons with “and”."),
    ("if self.curing_oven.temprature > 5: pass", 3, "What can be read here: job_status, temperature, quality."),
    ("self.oven.cure_paint(5)", 0, 'Give it in run: self.oven = ctx.get("curingOven01").'),
    ("self.mix()", 0, "There is no such function. Functions of this task: none yet."),
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


def test_columns_count_characters_not_bytes() -> None:
    parsed = parse_script(script('self.notify("Öl für Änne", level=self.nothing)'), factory())
    [refusal] = parsed.diagnostics
    assert (refusal.column, refusal.args["end_column"]) == (9, 55)
    parsed = parse_script(script('if "Öl" == self.nothing: pass'), factory())
    assert parsed.diagnostics[0].column == 9 + 11


def sentences() -> list[str]:
    tables = (syntax_errors.STATEMENTS, syntax_errors.EXPRESSIONS, syntax_errors.CALLS)
    pairs = (*syntax_errors.SYNTAX, *syntax_errors.SYMBOLS)
    fixed = [
        syntax_errors.ATTRIBUTE_ALONE,
        syntax_errors.VALUE_ALONE,
        syntax_errors.NOTHING_BEFORE,
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
