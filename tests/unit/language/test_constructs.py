"""The records of constructs fit the nodes that they speak of."""

from dataclasses import MISSING, fields
from typing import get_args

import pytest

from editor.language.constructs.record import Field, FieldType, Form
from editor.language.constructs.script_form import CALLS, ScriptCall, script_call
from editor.language.constructs.table import CONSTRUCTS, FORMS, STEPS
from editor.language.drawing.layout import HEIGHT_M, LETTER_M, Room, room_of
from editor.language.reading.fields import FIELD_READERS
from editor.language.tree.nodes import COMPOSITES, DRIVES, NODES, Event, Node
from editor.language.tree.variables import SETTERS, VALUES, set_by, values_of


@pytest.mark.parametrize("name", [name for name, node in NODES.items() if node is not Event])
def test_a_node_has_the_fields_of_its_record_then_its_branches_then_its_id(name):
    construct, form = FORMS[name]
    attributes = [field.attribute for field in form.fields] + [attribute for _, attribute in construct.branches]
    own = [field.name for field in fields(NODES[name])]
    if name == "Try":  # its catches hold what they take, too
        attributes = ["body", "handlers", "final"]
    assert own[: len(attributes) + 1] == [*attributes, "step"]
    left_out = [field for field in fields(NODES[name]) if field.name not in own[: len(attributes)]]
    assert [field.name for field in left_out if field.default is MISSING] == []


def test_every_node_has_a_record_and_every_record_a_node():
    assert FORMS.keys() == NODES.keys() == {node.__name__ for node in (*get_args(Node), Event)}


def test_what_a_robot_does_and_what_holds_others_is_as_the_records_say():
    assert {node.__name__ for node in (*DRIVES, NODES["Release"])} == {
        name for name, (one, _) in FORMS.items() if one.drives
    }
    holding = {name for name, (one, _) in FORMS.items() if one.branches or one.names_branches}
    assert {node.__name__ for node in COMPOSITES} == holding - {"Event"}
    assert [node.__name__ for node in SETTERS] == ["Call", "Set", "Ask"]


def test_the_nodes_that_have_no_reader_of_their_own_have_fields_that_can_be_read():
    own = {"operate", "parallel", "try", "call", "for_each", "pick_and_drop", "on_event", "comment"}
    types = {field.type for one in STEPS if one.kind not in own for field in one.fields}
    assert types <= FIELD_READERS.keys() <= set(get_args(FieldType))


def test_a_value_is_found_by_the_field_where_it_stands():
    assert VALUES[NODES["WaitUntil"]] == (("condition", "until"), ("timeout_s", "timeout"))
    assert VALUES[NODES["Pick"]] == (("at", ""), ("object", "object"), ("quantity", "quantity"))
    wait = NODES["Wait"]("ten", "s1")
    assert (list(values_of(wait)), set_by(wait)) == ([("duration", "ten")], "")
    assert set_by(NODES["Call"]("mix", (), "total")) == "total"


def test_a_script_is_taken_apart_into_its_call():
    role, to, route, fast = Field("role", "role"), Field("to", "place"), Field("route", "route"), Field("fast")
    form = Form("Move", (role, to, route, fast), "role.move(to, via=route, **fast)")
    assert script_call(form) == ScriptCall("move", role, None, (to,), (), (("via", route),), fast)
    assert CALLS["Ask"].variable == CONSTRUCTS["ask"].fields[2]
    assert [key for key, _ in CALLS["Pick"].entries] == ["value", "object"]


@pytest.mark.parametrize("script", ["move", "move(to)", "a = b", "if role: pass", "self.x.move(to); self.end()"])
def test_a_script_that_is_no_call_is_a_mistake_of_the_record(script):
    with pytest.raises(ValueError, match=r".+"):
        script_call(Form("Move", (Field("to", "place"),), script))


def test_a_step_has_room_for_what_its_chip_says():
    assert room_of("wait", {"until": "x" * 10, "duration": 7}) == Room(round(1.7 + LETTER_M * 15, 2), HEIGHT_M)
    assert room_of("ask", {"question": "x" * 99, "variable": "y"}).width_m == round(1.7 + LETTER_M * 37, 2)
    assert room_of("while", {"condition": "abc"}).height_m == room_of("if", {}).height_m == 1.4
    assert room_of("teleport", {"to": "abc"}) == Room(round(1.7 + LETTER_M * 11, 2), HEIGHT_M)
