"""What an event sets while the program works the same variable out is told to be lost; single steps lose nothing."""

from __future__ import annotations

import pytest

from tests.unit.language.checks.test_told_before import HOT, told

EVENT = "def when_e1(self):\n    self.count = self.count + 1"
SLOW = "def more(self, n: Number) -> Number:\n    self.wait(2)\n    return n + 1\n"
WHEN = f"ctx.when({HOT}, self.when_e1)"
SAY = "self.notify(f'{self.count}')"


@pytest.mark.parametrize(
    ("body", "functions", "codes"),
    [
        ("self.count = self.count + 1\nself.wait(5)", "", []),
        ("self.x = self.count\nself.count = self.x + 1", "", []),
        ("self.x = self.count\nself.wait(5)\nself.count = self.x + 1", "", ["loses_update"]),
        ("self.x = self.count\nself.y = self.x\nself.wait(5)\nself.count = self.y + 1", "", ["loses_update"]),
        ("self.x = self.count\nself.wait(5)\nself.x = 1\nself.count = self.x + 1", "", []),
        ("self.count = self.more(n=self.count)", SLOW, ["loses_update"]),
        ("self.count = self.more(n=self.count)", SLOW.replace("    self.wait(2)\n", ""), []),
        ("self.wait(5)\nself.count = 0", "", []),
    ],
)
def test_an_update_that_an_event_may_undo_is_told(body: str, functions: str, codes: list[str]) -> None:
    text = f"self.count = 0\n{body}\n{SAY}"
    assert told(text, f"{functions}\n{EVENT}", parameters=WHEN) == codes
    assert told(text, functions) == []
