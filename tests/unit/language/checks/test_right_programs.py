"""Programs as people of the field write them: nothing is wrong with them, and nothing is told of them."""

from __future__ import annotations

import pytest

from tests.unit.language.checks.test_told_before import DROP, HOT, told

PICK = f"self.robot.pick({DROP})"
LEAVE = f"self.robot.drop({DROP})"
SHELF, BOOTH = "self.robot.move(self.shelf.location)", "self.robot.move(self.booth.location)"
CARRY = f"{SHELF}\n{PICK}\n{BOOTH}\n{LEAVE}"
IN_LOOP = CARRY.replace("\n", "\n    ")
DOCK = "self.robot.move(self.dock.location)"
FAR = "distance(self.robot, self.oven)"
MIX = "def mix(self, mixer: Device, minutes: Number(\"min\")):\n    mixer.operate('mixPaint', {'time': minutes})"
BRING = f"def bring(self, goal: Place):\n    {SHELF}\n    {PICK}\n    self.robot.move(goal.location)\n    {LEAVE}"
TWO = "self.parallel(self.branch_1a, self.branch_1b)"
NEAREST = "self.m = nearest(self.robot, self.mixer, self.mixer_2)"
MIXERS = "def branch_1a(self):\n    self.mixer.mix_paint(3)\ndef branch_1b(self):\n    self.mixer_2.mix_paint(3)"
TRIES = f"self.n = 0\nwhile {HOT} and self.n < 9:\n    self.wait(60)\n    self.n = self.n + 1"
WHEN = f"ctx.when({HOT}, self.when_e1)"
BOUND, TIMES = 'ctx.get("robot01")', 'self.n = ctx.parameter("n", 2, Number)'
WHERE = "self.where = self.ask('Where?', type='choice', options=['dock1', 'dock2'])"
ASKED = "self.n = self.ask('How many?', type='number', minimum=1, maximum=2)"
COUNT = "def when_e1(self):\n    self.alarms = self.alarms + 1"


@pytest.mark.parametrize(
    ("parts", "more"),
    [
        ((CARRY,), {}),
        ((f"for _ in range(4):\n    {IN_LOOP}",), {}),
        ((f"while {HOT}:\n    {IN_LOOP}",), {}),
        ((f"{CARRY}\n{DOCK}",), {}),
        ((f"if {HOT}:\n    {DOCK}\nelse:\n    {IN_LOOP}",), {}),
        ((f"self.wait(until=self.oven.temperature < 40)\n{CARRY}",), {}),
        ((f"self.wait(until={HOT}, timeout=60)\n{CARRY}",), {}),
        ((f"try:\n    {IN_LOOP}\nexcept Failed as problem:\n    self.notify('It did not work.')",), {}),
        (("for m in [self.mixer, self.mixer_2]:\n    m.operate('mixPaint', {'time': 3})",), {}),
        (("for m in [self.mixer, self.mixer_2]:\n    self.mix(mixer=m, minutes=quantity(3, 'min'))", MIX), {}),
        (("self.mix(mixer=self.mixer, minutes=quantity(2, 'min'))", MIX), {}),
        (("self.bring(goal=self.booth)", BRING), {}),
        (("for m in [self.oven, self.mixer]:\n    if m.read('temperature') > 60:\n        self.notify('hot')",), {}),
        (("for p in [self.dock, self.oven]:\n    self.robot.move(p.location)\n    self.robot.honk(1)",), {}),
        ((f"{DOCK}\nif {FAR} > 3:\n    self.robot.honk(2)",), {}),
        ((f"if {FAR} > 3:\n    {DOCK}",), {"robot": BOUND}),
        ((f"{NEAREST}\nself.mix(mixer=self.m, minutes=quantity(2, 'min'))\n{DOCK}", MIX), {"robot": BOUND}),
        ((f"{DOCK}\n{NEAREST}\nself.robot.move(self.m.location)",), {}),
        ((f"while {FAR} > 3:\n    self.wait(1)\n{DOCK}",), {"robot": BOUND}),
        (("self.wait(self.pause)",), {"parameters": 'self.pause = ctx.parameter("pause", 5, Number("s"))'}),
        (("self.robot.move(self.goal.location)",), {"parameters": 'self.goal = ctx.parameter("goal", "dock1", Place)'}),
        (("self.m.operate('paint', {'time': 3})",), {"parameters": 'self.m = ctx.parameter("m", None, Device)'}),
        (("for _ in range(self.n):\n    self.robot.honk(1)",), {"parameters": TIMES}),
        ((f"{ASKED}\nfor _ in range(self.n):\n    {IN_LOOP}",), {}),
        ((f"{WHERE}\nself.robot.move(self.where.location)",), {}),
        ((TWO, f"def branch_1a(self):\n    self.wait(3)\ndef branch_1b(self):\n    {DOCK}"), {}),
        ((TWO, MIXERS), {}),
        ((f"self.alarms = 0\n{CARRY}\nself.notify(f'{{self.alarms}} alarms')", COUNT), {"parameters": WHEN}),
        ((CARRY, "def when_e1(self):\n    self.notify('hot')"), {"parameters": WHEN}),
        ((CARRY, "def when_e1(self):\n    self.notify('hot')"), {"parameters": f"ctx.start_when({HOT}, self.when_e1)"}),
        ((f"self.n = 0\nwhile self.n < 3:\n    {IN_LOOP}\n    self.n = self.n + 1",), {}),
        ((f"while True:\n    if {HOT}:\n        break\n    {IN_LOOP}",), {}),
        ((TRIES,), {}),
        (("self.ok = self.ask('Shall it begin?')\nif self.ok:\n    self.oven.cure_paint(20)",), {}),
        (("for seconds in [1, 2, 4]:\n    self.wait(seconds * quantity(1, 's'))\n    self.robot.blink(2)",), {}),
        ((f"for thing in ['box', 'box']:\n    {IN_LOOP}",), {}),
    ],
)  # fmt: skip
def test_nothing_is_told_of_a_right_program(parts: tuple[str, ...], more: dict[str, str]) -> None:
    assert told(*parts, **more) == []
