"""Methods of a robot's own in the language: how they are said, who is meant, and what is told of them."""

from dataclasses import replace
from typing import Any

import pytest

from editor.language import Surroundings, compile_document, parse_script, tree_to_document
from editor.language.plan.instructions import Call, Perform
from editor.language.site.surroundings import DeviceFacts
from editor.language.tree import nodes as n
from tests.kit.demo_site import factory
from vipo_device.protocol.description import MethodSpec, ParameterSpec

TONE = MethodSpec("honk", "t", parameters=(ParameterSpec("tone", "text"),))


def site(**methods: tuple[MethodSpec, ...]) -> Surroundings:
    """Return the factory in which robots describe these methods in place of their own of the same name."""
    return replace(factory(), devices={key: _changed(facts, methods) for key, facts in factory().devices.items()})


def _changed(facts: DeviceFacts, methods: dict[str, tuple[MethodSpec, ...]]) -> DeviceFacts:
    others = methods.get(facts.description.id, ())
    kept = (m for m in facts.description.methods if m.name not in {other.name for other in others})
    return replace(facts, description=replace(facts.description, methods=(*kept, *others)))


def operate(method: str, arguments: dict[str, Any] | None = None, **roles: Any) -> dict[str, Any]:
    """Return a program in which the program's robot does one thing."""
    params = {"device": {"role": "robot"}, "method": method, "args": arguments or {}}
    step = {"kind": "operate", "place": ["program", "body", "1"], "pos": [1, -1], "params": params}
    return {"format": 2, "start_pos": [0, 0], "steps": {"s": step}, "roles": roles}


def told(document: dict[str, Any], where: Surroundings | None = None) -> list[str]:
    return [d.message for d in compile_document(document, where or factory()).diagnostics]


def script(line: str, given: str = 'ctx.any("honk")') -> str:
    run = f"    def run(self, ctx):\n        self.robot = {given}\n        self.new_task()\n"
    return f"class Task(object):\n    def new_task(self):\n        {line}\n\n{run}"


@pytest.mark.parametrize(
    "line",
    ["self.robot.honk(5)", "self.robot.honk(times=5)", 'self.robot.operate("honk", {"times": 5})'],
)
@pytest.mark.parametrize("given", ['ctx.any("honk")', 'ctx.get("robot01")', "ctx.any()"])
def test_a_robot_is_told_in_short_by_name_or_in_full(line: str, given: str) -> None:
    tree = parse_script(script(line, given), factory()).tree
    assert tree is not None
    assert [(type(node), node.method) for node in tree.body if isinstance(node, n.Perform)] == [(n.Perform, "honk")]
    drawn = tree_to_document(tree, factory())
    assert compile_document(drawn, factory()).script == script(
        "self.robot.honk(5)", given.replace("any()", 'any("honk")')
    )


@pytest.mark.parametrize(
    ("line", "instead"),
    [
        ("self.robot.fly()", "What it can do: move, pick, drop, honk, blink."),
        ("self.robot.honk(1, 2)", "It takes: times."),
        ("self.robot.honk(tone=3)", "It takes: times."),
        ("self.robot.operate(honk)", 'Write self.oven.operate("curePaint", {"time": 10}).'),
    ],
)
def test_what_is_said_otherwise_is_answered_with_what_can_be_said(line: str, instead: str) -> None:
    parsed = parse_script(script(line), factory())
    assert parsed.tree is None
    assert parsed.diagnostics[0].message.endswith(instead)


def test_a_role_asks_for_all_that_its_steps_need() -> None:
    document = operate("honk", {"times": 1}, robot={"can": ["pick"]})
    compiled = compile_document(document, factory())
    assert compiled.tree.roles[0].can == ("pick", "honk")
    assert compiled.plan is not None
    assert compiled.plan.roles["robot"].can == ("pick", "honk")


def test_nobody_can_do_it_and_it_says_what_can_be_done() -> None:
    assert told(operate("sing")) == ["No robot on this site can sing. Robots here can: move, pick, drop, honk, blink."]
    bound = operate("sing", robot={"name": "robot", "device": "robot01"})
    assert told(bound) == ["TurtleBot 1 cannot sing. It can: move, pick, drop, honk, blink."]


def test_no_one_robot_can_do_all_that_the_role_needs() -> None:
    lift, sing = MethodSpec("lift", "t"), MethodSpec("sing", "t")
    document = operate("lift")
    document["steps"]["t"] = {**document["steps"]["s"], "place": ["program", "body", "2"]}
    document["steps"]["t"]["params"] = {"device": {"role": "robot"}, "method": "sing", "args": {}}
    assert told(document, site(robot01=(lift,), robot02=(sing,))) == ["No robot on this site can lift and sing."]


def test_robots_that_describe_it_differently_are_named_and_the_script_says_it_in_full() -> None:
    where = site(robot02=(TONE,))
    document = operate("honk", {"times": 5})
    assert told(document, where) == ["TurtleBot 1 and TurtleBot 2 take different values for honk. Choose one robot."]
    compiled = compile_document(document, where)
    assert '        self.robot.operate("honk", {"times": 5})\n' in compiled.script
    assert parse_script(compiled.script, where).tree == compiled.tree
    refused = parse_script(script("self.robot.honk(5)", "ctx.any()"), where).diagnostics[0].message
    assert refused.endswith('Write self.robot.operate("honk", {…}): robots describe it differently.')


def test_limits_of_all_robots_in_question_are_kept() -> None:
    few = MethodSpec("honk", "t", parameters=(ParameterSpec("times", "number", "", 1, 3),))
    assert told(operate("honk", {"times": 5}), site(robot03=(few,))) == ["Times must be 1 to 3."]


def test_a_unit_is_brought_into_that_of_the_description() -> None:
    compiled = compile_document(operate("blink", {"time": {"quantity": [0.5, "MIN"]}}), factory())
    assert compiled.plan is not None
    action = compiled.plan.instructions[0].do
    assert isinstance(action, Perform)
    assert repr(action.arguments["time"]) == "Constant(value=30)"
    assert told(operate("blink", {"time": {"quantity": [3, "CentiM"]}})) != []


def test_a_description_that_has_changed_since_is_told() -> None:
    document = operate("honk", {"times": 5})
    assert told(document) == []
    now = site(robot01=(TONE,), robot02=(TONE,), robot03=(TONE,))
    assert told(document, now) == ["Enter tone for honk.", "honk does not take times. It takes: tone."]


def test_a_robot_that_is_operated_as_a_device_gets_a_role_so_that_the_run_holds_it() -> None:
    document = operate("honk", {"times": 1})
    document["steps"]["s"]["params"]["device"] = {"device": "robot02"}
    compiled = compile_document(document, factory())
    assert compiled.plan is not None
    assert not any(isinstance(each.do, Call) for each in compiled.plan.instructions)
    assert {name: role.device for name, role in compiled.plan.roles.items()} == {"turtle_bot_2": "robot02"}
    assert "self.turtle_bot_2.honk(1)" in compiled.script
    known = {**document, "roles": {"r": {"name": "carrier", "device": "robot02"}}}
    known["steps"]["m"] = {"kind": "move", "place": ["program", "body", "2"], "pos": [1, -1],
                           "params": {"role": "r", "to": {"place": "dock1"}}}  # fmt: skip
    again = compile_document(known, factory())
    assert [role.id for role in again.tree.roles] == ["r"]
    assert "self.carrier.honk(1)" in again.script


def test_a_robot_that_is_gone_stays_one_in_the_script() -> None:
    compiled = compile_document(operate("honk", {"times": 1}, robot={"device": "gone"}), factory())
    assert 'self.robot = ctx.get("gone", kind="robot")' in compiled.script
    assert parse_script(compiled.script, factory()).tree == compiled.tree


HOSTILE = [
    "move.location",
    "__class__",
    "operate",
    "read",
    "location",
    "self",
    "a b",
    "鳴らす",
    "Öffnen",
    "', '",
    "x" * 200,
]


@pytest.mark.parametrize("name", HOSTILE)
def test_whatever_a_method_is_called_it_is_drawn_said_and_read_back(name: str) -> None:
    where = site(robot01=(MethodSpec(name, "t", parameters=(ParameterSpec("class", "number"),)),))
    document = operate(name, {"class": 3})
    compiled = compile_document(document, where)
    assert [d.message for d in compiled.diagnostics] == []
    assert parse_script(compiled.script, where).tree == compiled.tree
    assert compiled.plan is not None
    assert compiled.plan.roles["robot"].can == (name,)


def test_two_methods_that_would_be_called_alike_are_said_in_full() -> None:
    both = (MethodSpec("openGripper", "t"), MethodSpec("open_gripper", "t"))
    where = site(robot01=both)
    compiled = compile_document(operate("openGripper"), where)
    assert 'self.robot.operate("openGripper")' in compiled.script
    assert parse_script(compiled.script, where).tree == compiled.tree
    apart = site(robot01=both[:1], robot02=both[1:])
    assert parse_script(script("self.robot.open_gripper()", "ctx.any()"), apart).tree is None


def test_two_hundred_methods_are_named_in_a_reasonable_sentence() -> None:
    where = site(robot01=tuple(MethodSpec(f"method{number}", "t") for number in range(200)))
    assert len(told(operate("sing"), where)[0]) < 250
    assert told(operate("method199"), where) == []


@pytest.mark.parametrize("device", [{"role": None}, {"role": 3}, {"role": ["robot"]}, {"role": {}}, {"role": ""}])
def test_a_role_that_is_no_name_is_the_programs_robot(device: object) -> None:
    document = operate("honk", {"times": 1})
    document["steps"]["s"]["params"]["device"] = device
    assert "self.robot.honk(1)" in compile_document(document, factory()).script
