"""Logic that does nothing is told: empty branches, loops that wait in a circle, parameters that nobody reads."""

from __future__ import annotations

import pytest

from tests.unit.language.checks.test_told_before import HOT, told

GLANCE = "def glance(self):\n    self.notify('hot')"
PAUSE = "def pause(self):\n    self.wait(1)"


@pytest.mark.parametrize(
    ("parts", "codes"),
    [
        ((f"if {HOT}:\n    pass",), ["empty_branch"]),
        ((f"if {HOT}:\n    pass\nelse:\n    self.wait(1)",), []),
        (("for _ in range(3):\n    pass",), ["empty_branch"]),
        (("for m in [self.oven]:\n    pass",), ["empty_branch"]),
        (("for m in [self.oven]:\n    self.wait(1)",), []),
        ((f"while {HOT}:\n    pass",), ["busy_circle"]),
        ((f"while {HOT}:\n    self.notify('hot')",), ["busy_circle"]),
        ((f"while {HOT}:\n    self.glance()", GLANCE), ["busy_circle"]),
        ((f"while {HOT}:\n    self.pause()", PAUSE), []),
        ((f"while {HOT}:\n    self.wait(1)",), []),
        ((f"while {HOT}:\n    self.notify('hot')\n    break",), []),
        ((f"while True:\n    if {HOT}:\n        break",), ["busy_circle"]),
        ((f"while True:\n    if {HOT}:\n        break\n    self.wait(1)",), []),
        ((f"self.n = 0\nwhile {HOT} and self.n < 5:\n    self.n = self.n + 1",), []),
    ],
)
def test_what_does_nothing_is_told(parts: tuple[str, ...], codes: list[str]) -> None:
    assert told(*parts) == codes


@pytest.mark.parametrize(
    ("parts", "parameters", "codes"),
    [
        (("self.tell(n=1)", "def tell(self, n: Number):\n    self.notify('x')"), "", ["unused_parameter"]),
        (("self.tell(n=1)", "def tell(self, n: Number):\n    self.notify(f'{n}')"), "", []),
        (("self.wait(1)",), 'self.n = ctx.parameter("n", 1, Number)', ["unused_parameter"]),
        (("self.notify(f'{self.n}')",), 'self.n = ctx.parameter("n", 1, Number)', []),
        (("self.f()", "def f(self):\n    self.notify(f'{self.n}')"), 'self.n = ctx.parameter("n", 1, Number)', []),
    ],
)  # fmt: skip
def test_a_parameter_that_no_value_reads_is_told(parts: tuple[str, ...], parameters: str, codes: list[str]) -> None:
    assert told(*parts, parameters=parameters) == codes
