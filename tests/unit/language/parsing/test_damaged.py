"""A script into which anything was written is read, or refused with the line of it; nothing makes the parser raise."""

from __future__ import annotations

from typing import Any

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from editor.language import compile_document, parse_script
from tests.kit.demo_site import factory
from tests.unit.language.strategies import documents

often = settings(max_examples=3 * settings.default.max_examples, deadline=None, suppress_health_check=list(HealthCheck))
LINES = (
    "if a:", "if a:", "else:", "try:", "try:", "except E as problem:", "except:", "except* E:", "finally:", "while a:",
    "for x in [1]:", "def f(self):", "class A(object):", "pass", "a", "self.a(1)", "x = 1", "return", "break",
    "a; b", "if a: b", "if a: b #:", "if a: pass #:", "if a: # why:", "elif a:", "else: a", "finally: a", "'a:",
    "x = '''", "'''", "a = (", ")", "b \\", "# note", "#:", "", " ", "@a", "with a:", "lambda:", "x: int", "x = {1:",
    "async def f():",
    "def new_task(self):", "def run(self, ctx):", "self.new_task()", "return 1", "continue",
    "def f(self, *a, **b):", "def f(self, /, a, *, b=1):", "def f(a=1):", "self.a(*b, **c)", "async for x in y:",
    "for x, *y in [1]:", "for self.x in y:", "for i in range(1, 5):", "for i in 3:", "while True: a",
    "async with a as b:", "await a", "x: int = 1", "self.a = self.b = 1", "a, *b = c", "self.a[0] = 1", "self.a.b = 1",
    "self.a.b", "self.a.b.c()", "self.a()()", "self.curing_oven", "self.curing_oven.x()", "self.robot", "robot.x()",
    "ctx.get(1)", "self.x = ctx.any()", "self.robot = 5", "del a", "global a", "raise", "raise a from b", "assert a, b",
    "(x := 1)", "[x for x in y]", "{**a}", "{*a}", "f'{a!r:>{b}}'", "self.wait(0x" + "f" * 5000 + ")",
    "for _ in range(1, 0x" + "f" * 5000 + "):", "self.x = -0x" + "f" * 5000, "type X = int", "a if b else c",
    "a < b < c", "a is None", "a @ b", "1j", "b'x'", "...", "self", "self.名前.x()", "self.\uff58 = \uff11", "„a“",
    "self.a is b",
    "except (A, B):", "except A.b:", "except (A, *b):", "else:  # for", "case [a, *b] if c:", "case {**a}:", "@a.b(c)",
    "def __init__(self): a", "class B(A, metaclass=C):", "if __name__ == '__main__':", "Task().run()", "lambda self: 1",
    "match a:", "case 1:", "import a", "a\tb", "a\r", "\ufeffa", "\x00", "ä = 'ü'", "(yield)",
)  # fmt: skip


@often
@given(documents(8), st.data())
def test_a_damaged_script_is_read_or_refused_with_a_line_of_it(document: dict[str, Any], data: st.DataObject) -> None:
    lines = compile_document(document, factory()).script.split("\n")
    for _ in range(data.draw(st.integers(1, 3))):
        at = data.draw(st.integers(0, len(lines) - 1))
        indent = " " * data.draw(st.sampled_from([0, 2, 4, 8, 12, 16]))
        kept = lines[at : at + data.draw(st.integers(0, 1))]
        lines[at : at + 1] = [indent + data.draw(st.sampled_from(LINES)), *kept]
    parsed = parse_script("\n".join(lines), factory())
    assert (parsed.tree is None) == any(each.severity == "error" for each in parsed.diagnostics)
    assert len(parsed.diagnostics) <= 21
    assert all(each.messages for each in parsed.diagnostics)
    assert all(1 <= (each.line or 0) <= len(lines) + 1 and each.message for each in parsed.diagnostics)
