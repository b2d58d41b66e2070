"""What a variable may hold is told before a run: devices that cannot do it, and what is no place at all."""

from __future__ import annotations

import pytest

from editor.language.compiler import EditedProgram, compile_document
from tests.kit.demo_site import factory
from tests.unit.language.units.test_units_to_the_run import document_of

GIVEN = {
    "shelf": "itemInventory01", "cans": "paintInventory01", "mixer": "paintMixer01", "mixer_2": "paintMixer02",
    "booth": "paintMachine01", "oven": "curingOven01", "out": "dropOff01", "other": "robot02",
}  # fmt: skip
DROP = '{"value": 1, "object": "box"}'
HOT = "self.oven.temperature > 60"


def program(body: str, functions: str = "", parameters: str = "", robot: str = 'ctx.any("pick", "drop")') -> str:
    """Return a script with this body; what it does not name is not given to it."""

    def indented(text: str, depth: int) -> str:
        return "\n".join(f"{' ' * depth}{line}" for line in text.strip().split("\n")) if text.strip() else ""

    text = f"{body}\n{functions}\n{parameters}"
    given = [f'self.{name} = ctx.get("{device}")' for name, device in GIVEN.items() if f"self.{name}" in text]
    given += [f"self.robot = {robot}"] if "self.robot" in text else []
    given += ['self.dock = ctx.place("dock1")'] if "self.dock" in text else []
    given += [line for line in parameters.split("\n") if line]
    run = "\n".join(f"        {line}" for line in (*given, "self.new_task()"))
    return (
        f"class Task(object):\n    def new_task(self):\n{indented(body, 8)}\n\n"
        f"{indented(functions, 4)}\n\n    def run(self, ctx):\n{run}\n"
    )


def told(*parts: str, **more: str) -> list[str]:
    """Return what is told of a program, each code with what it says of which device."""
    found = compile_document(document_of(program(*parts, **more)), factory()).diagnostics
    return [f"{each.code} {each.args['device']}" if "device" in each.args else each.code for each in found]


COOK = "def cook(self, machine: Device):\n    machine.operate('curePaint', {'time': 10})"
TAKE = (
    'def take(self, at: Device):\n    self.robot.move(at.location)\n    self.robot.pick({"value": 1, "object": "box"})'
)


MISFIT, UNKNOWN = "may_not_fit Paint Mixer A", "unknown_method Paint Mixer A"
PRESSED = "self.wait(until=self.m.read('pressure') > quantity(3, 'kg'))"
GO = "def go(self, at: Place):\n    self.robot.move(at.location)"
BOTH, OTHER = "for m in [self.oven, self.mixer]:\n    ", "TurtleBot 2"
COOK_BOTH = "self.cook(machine=self.oven)\nself.cook(machine=self.mixer)"
MIX = "for m in [self.mixer, self.mixer_2]:\n    m.operate('mixPaint', {})".format
CHOSEN = "if HOT:\n    self.m = self.mixer\nelse:\n    self.m = self.oven\n".replace("HOT", HOT)
CARRY = """for thing in ['box', '{}']:
    self.robot.move(self.shelf.location)
    self.robot.pick({{"value": 1, "object": thing}})
    self.robot.move(self.booth.location)
    self.robot.drop({{"value": 1, "object": thing}})"""


@pytest.mark.parametrize(
    ("parts", "codes"),
    [
        ((f"{BOTH}m.operate('curePaint', {{'time': 9}})",), ["unknown_method Paint Mixer A"]),
        ((MIX("{'time': 100}"),), ["out_of_range"]),
        ((MIX("{'time': quantity(3, 'kg')}"),), ["wrong_unit"]),
        ((MIX("{'speed': 3}"),), ["missing_argument", "unknown_argument"]),
        ((MIX("{'time': 3}"),), []),
        ((COOK_BOTH, COOK), ["unknown_method Paint Mixer A"]),
        (("self.cook(machine=self.oven)", COOK), []),
        ((f"{CHOSEN}self.m.operate('curePaint', {{'time': 10}})",), ["may_not_fit Paint Mixer A"]),
        ((f"{CHOSEN}self.m.operate('curePaint', {{'time': quantity(3, 'kg')}})",), ["wrong_unit", MISFIT]),
        ((f"{BOTH}m.operate('curePaint', {{'time': quantity(3, 'kg')}})",), [UNKNOWN, "wrong_unit"]),
        ((CHOSEN.replace("mixer", "booth") + PRESSED,), ["wrong_unit", "may_not_fit Curing Oven"]),
        ((f"{CHOSEN}self.m.operate('rest', {{}})",), ["unknown_method Curing Oven"]),
        ((f"{BOTH}self.wait(until=m.read('quality') == 'good')",), ["unknown_property Paint Mixer A"]),
        ((f"{BOTH}self.wait(until=m.read('temperature') > 30)",), []),
        ((f"self.take(at=self.shelf)\nself.robot.move(self.booth.location)\nself.robot.drop({DROP})", TAKE), []),
        (("self.take(at=self.cans)", TAKE), ["not_given Paint Inventory", "ends_carrying"]),
        (("self.take(at=self.other)", TAKE), ["ends_carrying", f"robot_as_place {OTHER}"]),
        ((CARRY.format("box"),), []),
        ((CARRY.format("vase"),), ["not_given Item Inventory", "not_taken Painting Machine"]),
    ],
)  # fmt: skip
def test_a_device_that_cannot_is_told_where_a_variable_may_hold_it(parts: tuple[str, ...], codes: list[str]) -> None:
    assert sorted(told(*parts)) == sorted(codes)


@pytest.mark.parametrize(
    ("parts", "parameters", "codes"),
    [
        (("self.robot.move(self.other.location)",), "", ["robot_as_goal TurtleBot 2"]),
        (("self.go(at=self.other)", GO), "", ["robot_as_goal TurtleBot 2"]),
        (("self.go(at=self.dock)\nself.go(at=self.oven)", GO), "", []),
        (("self.spot = 'nowhere'\nself.robot.move(self.spot.location)",), "", ["unknown_place"]),
        (("self.spot = 'dock1'\nself.robot.move(self.spot.location)",), "", []),
        (("self.spot = 4\nself.robot.move(self.spot.location)",), "", ["wrong_type"]),
        (("self.go(at='dock1')", GO.replace("Place", "Text")), "", []),
        (("self.go(at='dock9')", GO.replace("Place", "Text")), "", ["unknown_place"]),
        (("self.go(at=4)", GO.replace("Place", "Number")), "", ["wrong_type"]),
        (("self.robot.move(self.spot.location)",), 'self.spot = ctx.parameter("spot", "x", Text)', ["wrong_type"]),
        (("self.robot.move(self.spot.location)",), 'self.spot = ctx.parameter("spot", "dock1", Place)', []),
        (("self.m.operate('paint', {'time': 3})",), 'self.m = ctx.parameter("m", "x", Text)', ["wrong_type"]),
        (("self.m.operate('paint', {'time': 3})",), 'self.m = ctx.parameter("m", "paintMachine01", Device)', []),
    ],
)
def test_what_is_no_place_is_told_before_a_robot_is_sent_there(
    parts: tuple[str, ...], parameters: str, codes: list[str]
) -> None:
    assert told(*parts, parameters=parameters) == codes


def test_what_a_parameter_is_declared_to_be_is_told_of_after_an_edit_too() -> None:
    edited = EditedProgram()
    for kind in ("Device", "Text", "Device"):
        text = program("self.m.operate('x', {})", parameters=f'self.m = ctx.parameter("m", "paintMachine01", {kind})')
        document = document_of(text)
        assert edited.compile(document, factory()).diagnostics == compile_document(document, factory()).diagnostics
