"""A script put together from its lines is what Python reads in the whole of it; where that is not sure, it is left."""

from __future__ import annotations

import ast
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from editor.language import compile_document, parse_script
from editor.language.parsing.lines import parse_lines
from editor.language.parsing.script import parse_whole
from tests.kit.demo_site import factory
from tests.unit.language.strategies import documents

quick = settings(max_examples=25, deadline=None, suppress_health_check=list(HealthCheck))
often = settings(max_examples=300, deadline=None, suppress_health_check=list(HealthCheck))
LINES = (
    "if a:", "if a:", "else:", "try:", "try:", "except E as problem:", "except:", "except* E:", "finally:", "while a:",
    "for x in [1]:", "def f(self):", "class A(object):", "pass", "a", "self.a(1)", "x = 1", "return", "break",
    "a; b", "if a: b", "if a: b #:", "if a: pass #:", "if a: # why:", "elif a:", "else: a", "finally: a", "'a:",
    "x = '''", "'''", "a = (", ")", "b \\", "# note", "#:", "", " ", "@a", "with a:", "lambda:", "x: int", "x = {1:",
    "async def f():", "match a:", "case 1:", "import a", "a\tb", "a\r", "\ufeffa", "\x00", "ä = 'ü'", "(yield)",
)  # fmt: skip


def same_as_whole(text: str) -> bool:
    """Tell whether a text was put together from its lines, which must then be what Python reads."""
    module = parse_lines(text)
    if module is not None:
        assert ast.dump(module) == ast.dump(ast.parse(text)), text
    return module is not None


@quick
@given(documents())
def test_a_printed_script_is_put_together_from_its_lines(document: dict[str, Any]) -> None:
    assert same_as_whole(compile_document(document, factory()).script)


@often
@given(st.lists(st.tuples(st.integers(0, 3), st.sampled_from(LINES)), max_size=9))
def test_lines_of_all_kinds_are_put_together_as_python_does_or_left(lines: list[tuple[int, str]]) -> None:
    same_as_whole("\n".join("    " * depth + line for depth, line in lines))


@quick
@given(documents(8), st.data())
def test_a_damaged_script_means_what_the_whole_of_it_means(document: dict[str, Any], data: st.DataObject) -> None:
    lines = compile_document(document, factory()).script.split("\n")
    at = data.draw(st.integers(0, len(lines) - 1))
    indent = " " * data.draw(st.sampled_from([0, 2, 4, 8, 12, 16]))
    changed = [indent + data.draw(st.sampled_from(LINES)), *lines[at : at + data.draw(st.integers(0, 1))]]
    text = "\n".join([*lines[:at], *changed, *lines[at + 1 :]])
    parsed, whole = parse_script(text, factory()), parse_whole(text, factory())
    assert parsed == whole
    assert repr(parsed) == repr(whole)


@pytest.mark.parametrize(
    "text",
    [
        "if a:\n    b\nelse:\n    c",
        "while a:\n    b\nelse:\n    c",
        "try:\n    a\nexcept A:\n    b\nexcept B as c:\n    d\nelse:\n    e\nfinally:\n    f",
        "try:\n    a\nfinally:\n    b\n\n# a note\n  # another\nc",
        "def f(self, a: Number = 1) -> Text:\n    return 'if a:'\n\ndef f(self):\n    pass",
    ],
)
def test_what_the_language_has_is_put_together(text: str) -> None:
    assert same_as_whole(text)


@pytest.mark.parametrize(
    "text",
    [
        "if a:",
        "if a:\nb",
        "if a:\n        b",
        "if a:\n  b",
        "    a",
        "try:\n    a",
        "try:\n    a\nb",
        "try:\n    a\nelse:\n    b",
        "try:\n    a\nfinally:\n    b\nexcept A:\n    c",
        "try:\n    a\nexcept A:\n    b\nelse:\n    c\nelse:\n    d",
        "if a:\n    b\nelse:\n    c\nelse:\n    d",
        "a\nelse:\n    b",
        "if a: pass #:\n    b",
        "a = (\n1)",
    ],
)
def test_what_cannot_be_told_line_by_line_is_left(text: str) -> None:
    assert parse_lines(text) is None


def test_lines_deeper_than_any_step_are_left() -> None:
    assert parse_lines("".join("    " * depth + "if a:\n" for depth in range(62)) + "    " * 62 + "b") is None


def test_a_line_means_something_else_where_other_names_are_known() -> None:
    methods = "    def new_task(self):\n        self.a(1)\n        self.b()\n"
    functions = "    def a(self, x):\n        self.wait(x)\n    def b(self):\n        self.wait(x)\n"
    text = f"class Task(object):\n{methods}{functions}    def run(self, ctx):\n        self.new_task()\n"
    assert parse_lines(text) is not None
    assert [(diagnostic.code, diagnostic.line) for diagnostic in parse_script(text, factory()).diagnostics] == [
        ("not_in_language", 8)
    ]
