"""Where a robot stands, along each path: a move is put in before what happens elsewhere, and nowhere else."""

from __future__ import annotations

from typing import Any

import pytest

from editor.language import compile_document, parse_script
from editor.language.compiler import EditedProgram
from tests.kit.demo_site import factory, with_device

SHELF, BOOTH, OVEN = "itemInventory01", "paintMachine01", "curingOven01"
HOT = {"op": ">", "args": [{"property": [OVEN, "temperature"]}, 60]}
LISTED = {"variable": "place", "items": [{"device": SHELF}, {"device": BOOTH}]}
Block = list[Any]


def document(program: Block, functions: dict[str, Block] | None = None, **roles: Any) -> dict[str, Any]:
    """Return a program: `go`, `pick` and `drop` with where, or a step with its parameters and branches."""
    steps: dict[str, Any] = {}

    def add(block: Block, parent: str, branch: str) -> None:
        for number, each in enumerate(block):
            name, place = f"s{len(steps)}", [parent, branch, f"{number:02}V"]
            kind, params, branches = (*each, {}, {})[:3]
            if isinstance(params, str):
                at = {"param": params[1:]} if params.startswith("$") else {"device": params}
                goods = {"at": at, "object": "box", "quantity": 1}
                kind, params = ("move", {"to": at}) if kind == "go" else (kind, goods)
                params |= {"role": branches if isinstance(branches, str) else "robot"}
                branches = {}
            steps[name] = {"kind": kind, "place": place, "params": params}
            for inner, body in branches.items():
                add(body, name, inner)

    add(program, "program", "body")
    for name, body in (functions or {}).items():
        add(body, name, "body")
    named = {name: {"name": name} for name in functions or {}}
    roles = roles or {name: {"name": name, "can": ["pick", "drop"]} for name in ("robot", "other", "b")}
    return {"format": 2, "steps": steps, "functions": named, "roles": roles, "parameters": {}, "zones": {}}


def moves(program: Block, functions: dict[str, Block] | None = None, **roles: Any) -> list[str]:
    """Return the steps before which a move was put in."""
    found = compile_document(document(program, functions, **roles), factory())
    return sorted(found.added_moves, key=lambda step: int(step[1:]))


AT_SHELF, TAKE, LEAVE = ("go", SHELF), ("pick", SHELF), ("drop", SHELF)
AWAY, WAIT = ("go", BOOTH), ("wait", {"duration": 1})
LEAVE_AWAY = ("drop", BOOTH)


@pytest.mark.parametrize(
    ("program", "put_in"),
    [
        ([TAKE], ["s0"]),
        ([AT_SHELF, TAKE], []),
        ([AT_SHELF, AWAY, TAKE], ["s2"]),
        ([TAKE, LEAVE, LEAVE_AWAY], ["s0", "s2"]),
        ([AT_SHELF, WAIT, ("operate", {"device": {"device": OVEN}, "method": "curePaint"}), TAKE], []),
        ([AT_SHELF, ("release", {"role": "robot"}), TAKE], ["s2"]),
        ([AT_SHELF, ("go", BOOTH, "other"), TAKE], []),
        ([AT_SHELF, ("if", {"condition": HOT}, {"then": [WAIT]}), TAKE], []),
        ([AT_SHELF, ("if", {"condition": HOT}, {"then": [AWAY]}), TAKE], ["s3"]),
        ([("if", {"condition": HOT}, {"then": [AT_SHELF], "else": [AT_SHELF]}), TAKE], []),
        ([("if", {"condition": HOT}, {"then": [AT_SHELF], "else": [("end",)]}), TAKE], []),
        ([("if", {"condition": True}, {"then": [AT_SHELF]}), TAKE], ["s2"]),
        ([AT_SHELF, ("repeat", {"times": 2}, {"body": [TAKE]})], ["s2"]),
        ([AT_SHELF, ("repeat", {"times": 2}, {"body": [WAIT]}), TAKE], []),
        ([AT_SHELF, ("repeat", {"times": 2}, {"body": [WAIT, AT_SHELF]}), TAKE], []),
        ([AT_SHELF, ("repeat", {"times": 2}, {"body": [AWAY]}), TAKE], ["s3"]),
        ([AT_SHELF, ("while", {"condition": HOT}, {"body": [AWAY, ("break",)]}), TAKE], ["s4"]),
        ([AT_SHELF, ("while", {"condition": HOT}, {"body": [AWAY, ("continue",), AT_SHELF]}), TAKE], ["s5"]),
        ([AT_SHELF, ("while", {"condition": HOT}, {"body": [AT_SHELF, ("break",)]}), TAKE], []),
        ([AWAY, ("for_each", LISTED, {"body": [AT_SHELF]}), TAKE], ["s3"]),
        ([AT_SHELF, ("limit", {"duration": 9}, {"body": [AWAY]}), LEAVE_AWAY], []),
        ([AT_SHELF, ("end",), TAKE, LEAVE], ["s2"]),
        ([("while", {"condition": True}, {"body": [AT_SHELF]}), TAKE, LEAVE], ["s2"]),
    ],
)
def test_a_move_is_put_in_where_the_robot_may_stand_elsewhere(program: Block, put_in: list[str]) -> None:
    assert moves(program) == put_in


CAUGHT = {"kinds": []}


@pytest.mark.parametrize(
    ("program", "put_in"),
    [
        ([AT_SHELF, ("try", CAUGHT, {"body": [WAIT], "catch": [TAKE]})], []),
        ([AT_SHELF, ("try", CAUGHT, {"body": [AWAY], "catch": [LEAVE_AWAY]})], ["s3"]),
        ([("try", CAUGHT, {"body": [AT_SHELF], "catch": [("end",)]}), TAKE], []),
        ([("try", CAUGHT, {"body": [AT_SHELF], "catch": [WAIT]}), TAKE], ["s3"]),
        ([("try", CAUGHT, {"body": [AWAY], "catch": [AWAY], "finally": [AT_SHELF]}), TAKE], []),
        ([("try", CAUGHT, {"body": [AT_SHELF], "catch": [AT_SHELF], "finally": [WAIT, TAKE]}), TAKE], ["s4"]),
        ([("try", CAUGHT, {"body": [AT_SHELF], "catch": [AT_SHELF], "finally": [WAIT]}), TAKE], []),
        ([AT_SHELF, ("try", CAUGHT, {"body": [WAIT], "catch": [WAIT], "finally": [TAKE]}), TAKE], []),
        ([("try", CAUGHT, {"body": [AT_SHELF], "catch": [AT_SHELF], "finally": [("go", BOOTH, "b")]}), TAKE], []),
        (
            [
                AT_SHELF,
                ("while", {"condition": HOT}, {"body": [("try", {}, {"body": [("break",)], "finally": [AWAY]})]}),
                TAKE,
            ],
            ["s5"],
        ),
    ],
)
def test_a_catch_begins_anywhere_in_the_body_and_the_final_part_changes_every_exit(
    program: Block, put_in: list[str]
) -> None:
    assert moves(program) == put_in


def both(first: Block, second: Block, **race: int) -> tuple[str, dict[str, Any], dict[str, Block]]:
    return "parallel", {"branches": ["a", "b"], **race}, {"a": first, "b": second}


@pytest.mark.parametrize(
    ("program", "put_in"),
    [
        ([AT_SHELF, both([WAIT], [TAKE])], []),
        ([both([AT_SHELF], [WAIT]), TAKE], []),
        ([both([AT_SHELF], [("go", BOOTH, "b")]), TAKE, ("drop", BOOTH, "b")], []),
        ([both([AT_SHELF], [AT_SHELF]), TAKE], ["s3"]),
        ([both([AT_SHELF], [WAIT], needed=1), TAKE], ["s3"]),
        ([AT_SHELF, both([WAIT], [WAIT], needed=1), TAKE], []),
        ([both([AT_SHELF], [("end",)], needed=1), TAKE], []),
    ],
)
def test_after_branches_a_robot_stands_where_the_one_that_surely_moved_it_left_it(
    program: Block, put_in: list[str]
) -> None:
    assert moves(program) == put_in


def test_a_place_that_a_variable_gives_is_left_when_the_variable_is_set() -> None:
    goes, takes = ("go", "$place"), ("pick", "$place")
    again = ("set", {"variable": "place", "value": {"device": BOOTH}})
    asked = ("ask", {"question": "Where?", "answer": {"type": "text"}, "variable": "place"})
    other = ("set", {"variable": "n", "value": 1})
    assert moves([again, goes, takes]) == []
    assert moves([again, goes, other, takes]) == []
    assert moves([again, goes, again, takes]) == ["s3"]
    assert moves([again, goes, asked, takes]) == ["s3"]
    assert moves([again, goes, ("call", {"function": "f"}), takes], {"f": [again]}) == ["s3"]
    assert moves([again, goes, ("call", {"function": "f", "result": "place"}), takes], {"f": [WAIT]}) == ["s3"]
    assert moves([again, goes, both([again], [takes])]) == ["s4"]
    assert moves([again, both([again, goes], [WAIT]), takes]) == []
    assert moves([again, both([goes], [again]), takes]) == ["s4"]
    assert moves([("for_each", LISTED, {"body": [goes, takes]})]) == []
    assert moves([again, goes, ("for_each", LISTED, {"body": [takes]})]) == ["s3"]


def test_a_call_leaves_a_robot_where_the_function_does() -> None:
    call = ("call", {"function": "f"})
    assert moves([call, TAKE], {"f": [AWAY, AT_SHELF]}) == []
    assert moves([AT_SHELF, call, TAKE], {"f": [WAIT]}) == []
    assert moves([AT_SHELF, call, TAKE], {"f": [("if", {"condition": HOT}, {"then": [AWAY]})]}) == ["s2"]
    assert moves([call, TAKE], {"f": [AT_SHELF, ("if", {"condition": HOT}, {"then": [("return",)]}), AWAY]}) == ["s1"]
    assert moves([AT_SHELF, call, LEAVE_AWAY, TAKE], {"f": [TAKE]}) == ["s2", "s3", "s4"]
    assert moves([AT_SHELF, call, TAKE], {"f": [AT_SHELF, ("if", {"condition": HOT}, {"then": [call]})]}) == ["s2"]


def test_a_role_says_where_its_robot_must_stand_only_where_the_program_relies_on_that() -> None:
    site = with_device("robot01", standing_at=SHELF)
    bound = {"robot": {"name": "robot", "device": "robot01"}}

    def begins(*program: Any) -> str | None:
        return compile_document(document([*program], **bound), site).tree.roles[0].at

    assert begins(TAKE) == SHELF
    assert begins(AT_SHELF) is None
    assert begins(LEAVE_AWAY, TAKE) is None
    assert begins(("repeat", {"times": 2}, {"body": [TAKE]})) is None
    assert begins(("if", {"condition": HOT}, {"then": [TAKE]})) == SHELF
    assert begins(AT_SHELF, TAKE) is None
    assert begins(AWAY, AT_SHELF, TAKE) is None
    assert begins(("if", {"condition": HOT}, {"then": [AT_SHELF]}), TAKE) == SHELF
    assert begins(("if", {"condition": HOT}, {"else": [AT_SHELF]}), TAKE) == SHELF
    assert begins(("if", {"condition": HOT}, {"then": [AT_SHELF], "else": [AT_SHELF]}), TAKE) is None


@pytest.mark.parametrize("program", [[AWAY, TAKE], [("end",), TAKE], [AT_SHELF, TAKE], [TAKE, LEAVE_AWAY, TAKE]])
def test_a_script_relies_on_the_beginning_where_the_drawing_does(program: Block) -> None:
    site = with_device("robot01", standing_at=SHELF)
    found = compile_document(document(program, robot={"name": "robot", "device": "robot01"}), site)
    assert parse_script(found.script, site).tree == found.tree


def test_after_an_edit_as_many_moves_are_put_in_as_into_the_whole() -> None:
    program = EditedProgram()
    inner = ("if", {"condition": HOT}, {"then": [TAKE, LEAVE]})
    bound = {"robot": {"name": "robot", "device": "robot01"}}
    site = with_device("robot01", standing_at=SHELF)
    before = document([AT_SHELF, inner, WAIT, inner], **bound)
    for first in (AT_SHELF, AWAY, AT_SHELF, WAIT, AWAY):
        edited = {**before, "steps": {**before["steps"], "s0": document([first], **bound)["steps"]["s0"]}}
        whole, found = compile_document(edited, site), program.compile(edited, site)
        assert (found.added_moves, found.tree) == (whole.added_moves, whole.tree)
        assert found.tree.roles == whole.tree.roles
