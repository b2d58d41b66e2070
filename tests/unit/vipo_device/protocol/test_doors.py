"""Which devices are doors: told by what they can do."""

from __future__ import annotations

import pytest

from vipo_device.protocol.description import (
    Description,
    MethodSpec,
    ParameterSpec,
    Pose,
    PropertySpec,
    Scalar,
    Size,
    ValueType,
)
from vipo_device.protocol.doors import DoorMethods, door_methods, said_of_door


def device(*methods: str | MethodSpec, reading: PropertySpec | None = None) -> Description:
    described = tuple(m if isinstance(m, MethodSpec) else MethodSpec(m, "t") for m in methods)
    told = () if reading is None else (reading,)
    return Description("d", "D", "machine", "thing", Pose(0, 0), Size(1, 1, 1), properties=told, methods=described)


@pytest.mark.parametrize(
    ("methods", "expected"),
    [
        (("open", "close"), DoorMethods("open", "close")),
        (("lock", "closeGate", "openGate"), DoorMethods("openGate", "closeGate")),
        (("door_open", "door_shut"), DoorMethods("door_open", "door_shut")),
        (("raise", "lower"), DoorMethods("raise", "lower")),
        (("öffnen", "schließen"), DoorMethods("öffnen", "schließen")),
        (("open",), DoorMethods("open")),
        (("openClose", "open"), DoorMethods("open")),
        (("close",), None),
        (("reopen", "toggle", "openClose"), None),
        ((), None),
    ],
)
def test_a_door_is_what_opens_when_it_is_told_to(methods: tuple[str, ...], expected: DoorMethods | None) -> None:
    assert door_methods(device(*methods)) == expected


def test_a_method_that_needs_values_opens_no_door() -> None:
    asks = MethodSpec("open", "t", parameters=(ParameterSpec("width", "number"),))
    may = MethodSpec("openDoor", "t", parameters=(ParameterSpec("width", "number", required=False),))
    assert door_methods(device(asks)) is None
    assert door_methods(device(asks, may)) == DoorMethods("openDoor")


@pytest.mark.parametrize(
    ("name", "type_", "options", "says"),
    [
        ("open", "boolean", (), {True: True, False: False, None: None}),
        ("doorOpen", "boolean", (), {True: True}),
        ("state", "text", (), {"open": True, "OPEN": True, "closing": False, "": None, None: None}),
        ("gatePosition", "text", ("down", "moving", "up"), {"up": True, "moving": False, "down": False}),
        ("mood", "text", ("geschlossen", "offen"), {"offen": True, "geschlossen": False}),
    ],
)
def test_a_reading_tells_how_the_door_stands(
    name: str, type_: ValueType, options: tuple[str, ...], says: dict[Scalar, bool | None]
) -> None:
    spec = PropertySpec(name, type_, options=options)
    methods = door_methods(device("open", "close", reading=spec))
    assert methods is not None
    assert methods.reading == name
    assert {value: methods.is_open(value) for value in says} == says
    if options or type_ == "boolean":
        assert methods.is_open(said_of_door(spec, is_open=True)) is True
        assert methods.is_open(said_of_door(spec, is_open=False)) is False


@pytest.mark.parametrize(
    "spec",
    [
        PropertySpec("alarm", "boolean"),
        PropertySpec("note", "text"),
        PropertySpec("state", "text", options=("busy", "idle")),
        PropertySpec("openings", "number"),
    ],
)
def test_other_readings_say_nothing_of_the_door(spec: PropertySpec) -> None:
    assert door_methods(device("open", reading=spec)) == DoorMethods("open")


def test_a_door_without_the_word_says_it_is_not_open() -> None:
    assert said_of_door(PropertySpec("state", "text", options=("moving", "open", "closed")), is_open=False) == "closed"
    assert said_of_door(PropertySpec("state", "text"), is_open=True) == "open"
