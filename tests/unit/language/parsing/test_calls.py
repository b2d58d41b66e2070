"""Which calls a script has: also those that stand where the language has none."""

from __future__ import annotations

import ast
import gc

import pytest

from editor.language import parse_script
from editor.language.allocation import paused_collector
from editor.language.parsing.robots import calls_in
from tests.kit.demo_site import factory
from tests.kit.files import ROOT

MODULES = sorted((ROOT / "editor" / "language").rglob("*.py"))
ODD = """
match f(1):
    case g(a=h.i) if j():
        k[l():m()] = [n() for o in p() if q()]
r = lambda s=t(): f'{u()!r:{v()}}'
"""


@pytest.mark.parametrize(
    "text", [ODD, *(path.read_text() for path in MODULES)], ids=["odd", *(f"{p.parent.name}/{p.stem}" for p in MODULES)]
)
def test_every_call_is_found(text: str) -> None:
    module = ast.parse(text)
    every = {id(node) for node in ast.walk(module) if isinstance(node, ast.Call)}
    assert {id(call) for call in calls_in(module)} == every


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
