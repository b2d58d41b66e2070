"""What lies outside of what is allowed whatever a run does is told before it, also behind variables and arguments."""

from __future__ import annotations

import pytest

from editor.language.compiler import EditedProgram
from tests.unit.language.units.test_units_to_the_run import document_of, script, site

WAIT = 'def rest(self, t: Number("s")):\n    self.wait(t)'
SHARE = "def share(self, n: Number) -> Number:\n    return 10 / n"


@pytest.mark.parametrize(
    ("body", "functions", "codes"),
    [
        ('self.t = quantity(99, "min")\nCURE(self.t)', "", ["out_of_range"]),
        ('self.t = quantity(90, "s")\nCURE(self.t)', "", []),
        (
            'self.a = quantity(9, "min")\nself.b = self.a * 20\nCURE(self.b)',
            "",
            ["out_of_range"],
        ),
        ('self.t = quantity(1, "s") - quantity(5, "s")\nself.wait(self.t)', "", ["out_of_range"]),
        (
            'for t in [quantity(70, "min"), quantity(80, "min")]:\n    CURE(t)',
            "",
            ["out_of_range"],
        ),
        ('for t in [quantity(7, "min"), quantity(80, "min")]:\n    CURE(t)', "", ["out_of_range"]),
        ('for t in [quantity(7, "min"), quantity(9, "min")]:\n    CURE(t)', "", []),
        ('for n, t in enumerate([1, 2], 1):\n    CURE(n * quantity(40, "min"))', "", ["out_of_range"]),
        ('for n, t in enumerate([1, 2], 1):\n    CURE(n * quantity(30, "min"))', "", []),
        ("for n, t in enumerate([1, 2], 1):\n    self.notify(f'{1 / (n - 2)}')", "", ["divided_by_zero"]),
        ("for n, t in enumerate([1, 2], 1):\n    self.notify(f'{1 / n}')", "", []),
        ("self.rest(t=0 - 5)", WAIT, ["out_of_range"]),
        ("self.rest(t=5)", WAIT, []),
        ("self.rest(t=0 - 5)\nself.rest(t=5)", WAIT, ["out_of_range"]),
        ("self.x = self.share(n=0)\nself.notify(f'{self.x}')", SHARE, ["divided_by_zero"]),
        ("self.x = self.share(n=2)\nself.notify(f'{self.x}')", SHARE, []),
        ("self.n = 0\nself.notify(f'{1 / self.n}')", "", ["divided_by_zero"]),
        ("self.n = 0\nfor _ in range(3):\n    self.n = self.n + 1\nself.notify(f'{1 / self.n}')", "", []),
        ("self.n = 0\nwhile self.n < 9:\n    self.n = self.n + 1\n    self.notify(f'{1 / self.n}')", "", []),
        ("self.notify(f'{1 / (2 - 2)}')", "", ["divided_by_zero"]),
    ],
)
def test_what_is_wrong_in_every_run_is_told(body: str, functions: str, codes: list[str]) -> None:
    document = document_of(script(body.replace("CURE(", "self.curing_oven.cure_paint("), functions))
    program = EditedProgram()
    for _ in range(2):
        told = [each.code for each in program.compile(document, site()).diagnostics]
        assert told == codes


def test_an_edit_of_a_variable_is_seen_where_it_is_read() -> None:
    document = document_of(script('self.t = quantity(2, "min")\nself.curing_oven.cure_paint(self.t)'))
    program = EditedProgram()
    assert program.compile(document, site()).diagnostics == ()
    name = next(name for name, step in document["steps"].items() if step["kind"] == "set")
    step = document["steps"][name]
    longer = {**step, "params": {**step["params"], "value": {"quantity": [99, "MIN"]}}}
    changed = {**document, "steps": {**document["steps"], name: longer}}
    assert [each.code for each in program.compile(changed, site()).diagnostics] == ["out_of_range"]
    assert program.compile(document, site()).diagnostics == ()
