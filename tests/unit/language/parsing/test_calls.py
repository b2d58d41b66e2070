"""Which calls of a script are steps, and what is left of a script when it was read."""

from __future__ import annotations

import ast
import gc

from editor.language import parse_script
from editor.language.allocation import paused_collector
from editor.language.parsing.robots import calls_made
from tests.kit.demo_site import factory

SCRIPT = """
class Task(object):
    def new_task(self):
        self.one()
        self.x = self.two(self.inner())
        while self.three():
            self.four()
            if True:
                self.five()
            else:
                self.six()
        with self.limit(5):
            self.seven()
        try:
            self.eight()
        except (Failed, TimedOut):
            for item in self.items():
                self.nine()
        finally:
            return self.ten()

    def other(self):
        self.eleven()
"""
STEPS = ["eight", "eleven", "five", "four", "nine", "one", "seven", "six", "ten", "two"]


READ = """
class Task(object):
    def new_task(self):
        self.robot.move(self.store.location)
        self.robot.pick({"value": 1, "object": "box"})

    def run(self, ctx):
        self.robot = ctx.any("pick")
        self.store = ctx.get("itemInventory01")
        self.new_task()
"""


def test_every_call_that_is_a_step_is_found() -> None:
    task = ast.parse(SCRIPT).body[0]
    assert isinstance(task, ast.ClassDef)
    methods = [method for method in task.body if isinstance(method, ast.FunctionDef)]
    assert sorted(ast.unparse(call.func).removeprefix("self.") for call in calls_made(methods)) == STEPS


def test_nothing_of_a_script_that_was_read_waits_for_the_collector() -> None:
    gc.collect()
    gc.disable()
    try:
        before = count_objects()
        assert parse_script(READ, factory()).tree is not None
        assert count_objects() == before
    finally:
        gc.enable()


def count_objects() -> int:
    return sum(isinstance(each, ast.AST) for each in gc.get_objects())


def test_the_collector_is_on_again_when_a_script_was_read() -> None:
    assert parse_script("class Task(object):", factory()).tree is None
    assert gc.isenabled()


def test_a_collector_that_was_off_stays_off() -> None:
    gc.disable()
    try:
        with paused_collector():
            assert not gc.isenabled()
        assert not gc.isenabled()
    finally:
        gc.enable()
