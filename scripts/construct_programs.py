"""One small program for each construct, as its picture in docs/language shows it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

Frame = tuple[float, float, float, float]
"""Left, top, right, bottom of a picture in metres of the map."""
WEST: Frame = (0.2, -0.2, 12.2, -6.9)
ROOM: Frame = (0.2, -2.7, 6.3, -7.1)
HALL: Frame = (0.2, -2.7, 8.8, -7.1)
OVEN: Frame = (6.9, -8.9, 15.0, -13.6)
SHELF, STORE, OVEN_ID = {"device": "itemInventory01"}, {"device": "paintInventory01"}, {"device": "curingOven01"}
HOT = {"op": ">", "args": [{"property": ["curingOven01", "temperature"]}, 40]}


@dataclass(frozen=True)
class Picture:
    """A program and the part of the map that its picture shows."""

    steps: Mapping[str, Any]
    frame: Frame = ROOM
    start: tuple[float, float] = (1.3, -3.2)
    functions: Mapping[str, Any] = field(default_factory=dict)
    zones: Mapping[str, Any] = field(default_factory=dict)
    selected: str = ""
    """The step that is selected."""

    def document(self) -> dict[str, Any]:
        """Return the program as a document."""
        whole = {"format": 2, "start_pos": list(self.start), "steps": dict(self.steps), "roles": {}, "parameters": {}}
        return {**whole, "functions": dict(self.functions), "zones": dict(self.zones)}


def step(kind: str, x: float, y: float, place: str = "program.body.1V", **params: object) -> dict[str, Any]:
    """Return a step at a spot; its place as `parent.branch.order`."""
    return {"kind": kind, "place": place.split(".") if place else None, "pos": [x, y], "params": params}


def carry(kind: str, x: float, y: float, place: str = "program.body.1V", **params: object) -> dict[str, Any]:
    """Return a step of a robot that handles one box."""
    return step(kind, x, y, place, object="box", quantity=1, role="robot", **params)


def wait(x: float, y: float, place: str) -> dict[str, Any]:
    """Return a step that waits a minute."""
    return step("wait", x, y, place, duration={"quantity": [1, "MIN"]})


def tell(x: float, y: float, place: str, text: str) -> dict[str, Any]:
    """Return a step that tells people something."""
    return step("notify", x, y, place, message=text, level="info")


def counting(x: float, y: float, place: str) -> dict[str, Any]:
    """Return a step that counts one further."""
    return step("set", x, y, place, variable="count", value={"op": "+", "args": [{"param": "count"}, 1]})


def _steps_of_robots() -> dict[str, Picture]:
    return {
        "move": Picture({"a": step("move", 5.4, -5.2, role="robot", to={"place": "paintStore"})}, WEST, (2.0, -4.2)),
        "pick": Picture({"a": carry("pick", 2.2, -3.2, at=SHELF)}, (0.2, -0.2, 6.2, -6.0), (1.2, -4.6)),
        "drop": Picture(
            {
                "a": carry("pick", 9.8, -12.5, at=OVEN_ID),
                "b": carry("drop", 2.2, -12.5, "program.body.2V", at={"device": "dropOff01"}),
            },
            (0.2, -9.2, 12.0, -13.6),
            (6.2, -10.2),
        ),
        "pick_and_drop": Picture(
            {"a": carry("pick_and_drop", 5.6, -8.0, source=SHELF, target=OVEN_ID)},
            (0.2, -0.2, 13.2, -13.6),
            (4.6, -1.0),
        ),
        "cover": Picture(
            {"a": step("cover", 4.2, -6.2, role="robot", zone="hall")},
            WEST,
            (1.3, -6.2),
            zones={
                "hall": {
                    "name": "Hall",
                    "rule": "slow",
                    "speed_m_s": 0.3,
                    "points": [[1.2, -3.2], [5.4, -3.2], [5.4, -5.3], [1.2, -5.3]],
                }
            },
            selected="a",
        ),
        "release": Picture(
            {
                "a": step("move", 5.4, -5.2, role="robot", to={"place": "paintStore"}),
                "b": step("release", 7.6, -3.6, "program.body.2V", role="robot"),
            },
            WEST,
            (2.0, -4.2),
        ),
    }


def _works_and_waits() -> dict[str, Picture]:
    return {
        "operate": Picture(
            {"a": step("operate", 10.2, -12.5, device=OVEN_ID, method="curePaint", args={"time": 10})},
            OVEN,
            (12.4, -10.0),
        ),
        "operate_robot": Picture(
            {"a": step("operate", 10.2, -12.5, device={"role": "robot"}, method="honk", args={"times": 5})},
            OVEN,
            (12.4, -10.0),
        ),
        "wait": Picture(
            {
                "a": wait(3.0, -4.4, "program.body.1V"),
                "b": step(
                    "wait",
                    3.0,
                    -5.8,
                    "program.body.2V",
                    until={"op": "<", "args": [*HOT["args"]]},  # type: ignore[dict-item]
                    timeout={"quantity": [10, "MIN"]},
                ),
            },
        ),
    }


def _loops() -> dict[str, Picture]:
    mixers = [{"at": {"device": "paintMixer01"}}, {"at": {"device": "paintMixer02"}}]
    return {
        "while": Picture({"a": step("while", 3.0, -4.3, condition=HOT), "b": wait(3.0, -5.3, "a.body.1V")}),
        "repeat": Picture({"a": step("repeat", 3.0, -4.3, times=3), "b": wait(3.0, -5.3, "a.body.1V")}),
        "for_each": Picture(
            {
                "a": step("for_each", 4.8, -4.2, variable="mixer", items=mixers),
                "b": step("move", 4.4, -5.4, "a.body.1V", role="robot", to={"param": "mixer"}),
            },
            HALL,
        ),
        "break": Picture(
            {
                "a": step("while", 5.6, -1.0, condition=True),
                "b": step("if", 5.0, -3.4, "a.body.1V", condition=HOT),
                "c": step("break", 8.2, -4.8, "b.then.1V"),
                "d": wait(5.0, -5.8, "a.body.2V"),
            },
            (0.2, -0.2, 10.2, -7.1),
            (1.6, -3.8),
        ),
        "continue": Picture(
            {
                "a": step("for_each", 5.6, -1.0, variable="mixer", items=mixers),
                "b": step("if", 5.0, -3.4, "a.body.1V", condition=HOT),
                "c": step("continue", 8.2, -4.8, "b.then.1V"),
                "d": wait(5.0, -5.8, "a.body.2V"),
            },
            (0.2, -0.2, 10.2, -7.1),
            (1.6, -3.8),
        ),
    }


def _choices_and_branches() -> dict[str, Picture]:
    ok = {"op": "==", "args": [{"property": ["curingOven01", "quality"]}, "ok"]}
    return {
        "if": Picture(
            {
                "a": step("if", 4.1, -3.9, condition=ok),
                "b": tell(2.4, -5.9, "a.then.1V", "Good"),
                "c": tell(5.9, -5.9, "a.else.1V", "Look at it"),
            },
            HALL,
        ),
        "parallel": Picture(
            {
                "a": step("parallel", 4.0, -3.9, branches=["a", "b"]),
                "b": wait(2.0, -5.7, "a.a.1V"),
                "c": tell(6.2, -5.7, "a.b.1V", "It begins"),
            },
            HALL,
        ),
        "limit": Picture(
            {
                "a": step("limit", 4.2, -4.3, duration={"quantity": [5, "MIN"]}),
                "b": step("move", 4.2, -5.4, "a.body.1V", role="robot", to=STORE),
            },
            HALL,
        ),
        "parallel_first": Picture(
            {
                "a": step("parallel", 4.0, -3.9, branches=["a", "b"], needed=1),
                "b": wait(2.0, -5.7, "a.a.1V"),
                "c": step("wait", 6.2, -5.7, "a.b.1V", until=HOT),
            },
            HALL,
        ),
        "try": Picture(
            {
                "a": step("try", 3.4, -3.6, kinds=["timed_out"], **{"finally": True}),
                "b": wait(3.4, -4.5, "a.body.1V"),
                "c": tell(7.0, -4.2, "a.catch.1V", "Too late"),
                "d": tell(4.0, -6.4, "a.finally.1V", "Over"),
            },
            HALL,
        ),
    }


def _words_with_people() -> dict[str, Picture]:
    count = step("set", 3.0, -4.2, variable="count", value=0)
    painted = {"op": "text", "args": ["Painted ", {"param": "count"}, " boxes"]}
    zones = {
        "a": {"name": "Ramp", "rule": "keep_out", "points": [[0.5, -3.5], [4.0, -3.5], [4.0, -4.8], [0.5, -4.8]]},
        "b": {"name": "Gate", "rule": "one_at_a_time", "points": [[4.4, -3.5], [7.9, -3.5], [7.9, -4.8], [4.4, -4.8]]},
        "c": {
            "name": "Aisle",
            "rule": "slow",
            "speed_m_s": 0.2,
            "points": [[2.4, -5.3], [5.0, -5.3], [5.0, -6.6], [2.4, -6.6]],
        },
        "d": {
            "name": "Ward door",
            "rule": "door",
            "door": "wardADoor",
            "points": [[5.4, -5.3], [7.9, -5.3], [7.9, -6.6], [5.4, -6.6]],
        },
    }
    return {
        "set": Picture({"a": count, "b": counting(3.0, -5.4, "program.body.2V")}),
        "ask": Picture(
            {"a": step("ask", 3.0, -4.6, question="Is it dry?", answer={"type": "boolean"}, variable="dry")}
        ),
        "notify": Picture(
            {"a": count, "b": step("notify", 3.0, -5.4, "program.body.2V", message=painted, level="info")}
        ),
        "end": Picture({"a": step("if", 2.6, -4.7, condition=HOT), "b": step("end", 4.2, -6.3, "a.then.1V")}),
        "fail": Picture(
            {"a": step("if", 2.6, -4.7, condition=HOT), "b": step("fail", 4.4, -6.3, "a.then.1V", message="Too hot")}
        ),
        "comment": Picture({"a": step("comment", 3.0, -4.6, "", text="Keep two cans")}),
        "zone": Picture({}, frame=(0.2, -2.7, 8.2, -7.1), zones=zones, start=(1.3, -6.2)),
    }


def _functions_and_events() -> dict[str, Picture]:
    minutes = [{"name": "minutes", "type": "number", "unit": "MIN", "default": 3}]
    dry = {"f": {"name": "dry", "parameters": minutes, "result": {"type": "number", "unit": "MIN"}}}
    body = {
        "b": step("wait", 3.4, -5.2, "f.body.1V", duration={"param": "minutes"}),
        "c": step("return", 3.4, -6.2, "f.body.2V", value={"param": "minutes"}),
    }
    plain = step("call", 3.4, -4.2, function="f", args={"minutes": 3})
    call = step("call", 3.4, -4.2, function="f", args={"minutes": 3}, result="total")
    return {
        "call": Picture({"a": plain, "b": body["b"]}, functions={"f": {"name": "dry", "parameters": minutes}}),
        "return": Picture({"a": call, **body}, functions=dry),
        "on_event": Picture(
            {
                "a": wait(2.2, -6.2, "program.body.1V"),
                "b": step("on_event", 5.2, -3.6, "program.events.1V", condition=HOT, starts="branch"),
                "c": tell(5.4, -5.2, "b.body.1V", "The oven is hot"),
            },
            HALL,
            (1.6, -4.8),
        ),
    }


def pictures() -> dict[str, Picture]:
    """Return what is pictured, by the name of its kind."""
    return (
        _steps_of_robots()
        | _works_and_waits()
        | _choices_and_branches()
        | _loops()
        | _words_with_people()
        | _functions_and_events()
    )
