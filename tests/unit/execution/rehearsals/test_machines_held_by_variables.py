"""A machine that must act for a pick or a drop acts also where a variable names it, and only where it must."""

from dataclasses import replace
from textwrap import indent

import pytest

from editor.language import Surroundings, compile_document, parse_script, tree_to_document
from editor.language.site.surroundings import DeviceFacts
from execution.machine import machine
from execution.machine import messages as m
from execution.rehearsals.rehearsal import Conditions, rehearse
from simulation.world import Scene
from tests.kit import demo_floor

SHELF, RACK, PAINTER, OVEN = "itemInventory01", "rack01", "paintMachine01", "dropOff01"
THING = '{"value": 1, "object": "box"}'
FETCH = f"self.robot.move(shelf.location)\nself.robot.pick({THING})"
BRING = f"self.robot.move(target.location)\nself.robot.drop({THING})"
PUT = f"self.robot.move(self.drop_off.location)\nself.robot.drop({THING})"
TRIP = indent(f"{FETCH}\n{PUT}", "    ")
RUN = f"""self.robot = ctx.any("pick", "drop")
self.shelf = ctx.get("{SHELF}")
self.rack = ctx.get("{RACK}")
self.drop_off = ctx.get("{OVEN}")
self.new_task()"""
IN_BOTH = f"for shelf in [self.shelf, self.rack]:\n{TRIP}"


def devices():
    """Return the demo's devices, and a rack that gives boxes by itself where the shelf has to dispense them."""
    found = demo_floor.devices()
    shelf = next(each for each in found if each.id == SHELF)
    other = next(each for each in found if each.id == PAINTER)
    rack = replace(other, id=RACK, name="Rack", gives=shelf.gives, takes=(), methods=(), properties=())
    return tuple(rack if each.id == PAINTER else each for each in found)


def plan_of(body, functions="", given=""):
    site = Surroundings({each.id: DeviceFacts(each) for each in devices()})
    run = f"{given}\n{RUN}".strip()
    parts = f"def new_task(self):\n{indent(body, '    ')}\n\n{functions}\n\ndef run(self, ctx):\n{indent(run, '    ')}"
    parsed = parse_script(f"class Task(object):\n{indent(parts, '    ')}\n", site)
    assert parsed.tree is not None, [each.message for each in parsed.diagnostics]
    compiled = compile_document(tree_to_document(parsed.tree, site), site)
    assert compiled.plan is not None, [each.message for each in compiled.diagnostics]
    return compiled.plan


def carried_out(plan, parameters=None):
    """Return what the floor is asked for, each task done at once."""
    state, actions = machine.start(plan, parameters or {}, {})
    orders = []
    while state.status == "running":
        ask = next(each for each in actions if isinstance(each, m.Ask))
        orders.append(f"{ask.order.method or ask.order.kind} {ask.order.target.id}")
        state, actions = machine.step(plan, state, m.TaskDone(ask.task))
    assert state.status == "finished", state
    return [order for order in orders if not order.startswith("move")]


OF_SHELF = [f"dispense {SHELF}", f"pick {SHELF}", f"accept {OVEN}", f"drop {OVEN}"]
OF_RACK = [f"pick {RACK}", f"accept {OVEN}", f"drop {OVEN}"]


@pytest.mark.parametrize(
    ("body", "functions", "expected"),
    [
        (f"for shelf in [self.shelf]:\n{TRIP}", "", OF_SHELF),
        (f"for shelf in [self.rack]:\n{TRIP}", "", OF_RACK),
        (IN_BOTH, "", [*OF_SHELF, *OF_RACK]),
        ("self.fetch(shelf=self.rack)\nself.fetch(shelf=self.shelf)", f"def fetch(self, shelf: Device):\n{TRIP}",
         [*OF_RACK, *OF_SHELF]),
        (f"{FETCH}\nfor target in [self.drop_off]:\n{indent(BRING, '    ')}".replace("shelf.", "self.shelf."), "",
         OF_SHELF),
    ],
)  # fmt: skip
def test_a_machine_that_a_variable_holds_acts_where_it_must(body, functions, expected):
    assert carried_out(plan_of(body, functions)) == expected


@pytest.mark.parametrize(("shelf", "expected"), [(SHELF, OF_SHELF), (RACK, OF_RACK)])
def test_a_machine_that_is_chosen_when_the_run_starts_acts_where_it_must(shelf, expected):
    body = f"{FETCH}\n{PUT}".replace("shelf.", "self.from_shelf.")
    plan = plan_of(body, given=f'self.from_shelf = ctx.parameter("from_shelf", "{SHELF}", Device)')
    assert carried_out(plan, {"from_shelf": shelf}) == expected


def test_in_a_rehearsal_the_machines_that_a_variable_holds_act_where_they_must():
    scene = Scene(demo_floor.grid(), devices(), seed=1)
    result = rehearse(plan_of(IN_BOTH), scene, places=demo_floor.places(), conditions=Conditions("kinematic"))
    assert (result["ok"], result["errors"]) == (True, [])
    said = [line["text"] for line in result["log"]]
    assert sum("Item Inventory: dispense" in text for text in said) == 1
    assert not any("Rack: dispense" in text for text in said)
    assert sum(": accept" in text for text in said) == 2
