"""Programs made by chance that mean something: most of them have a plan, with every construct in every other."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

from hypothesis import strategies as st

HOT = {"op": ">", "args": [{"property": ["curingOven01", "temperature"]}, 60]}
CHARGED = {"op": "<", "args": [{"property": [{"role": "robot"}, "battery"]}, {"quantity": [30, "%"]}]}
PLAIN: dict[str, dict[str, Any]] = {
    "wait": {"duration": {"quantity": [1, "MIN"]}},
    "notify": {"message": "done", "level": "warning"},
    "set": {"variable": "total", "value": 1},
    "collect": {"variable": "all", "value": {"op": "+", "args": [{"param": "all"}, {"op": "list", "args": [4]}]}},
    "ask": {"question": "How many?", "answer": {"type": "number"}, "variable": "count"},
    "call": {"function": "f", "result": "total"},
    "release": {},
    "end": {},
    "fail": {"message": "The box is wet."},
    "pick_and_drop": {
        "source": {"device": "itemInventory01"},
        "target": {"device": "paintMachine01"},
        "object": "box",
        "quantity": 1,
    },
}
HOLDING: dict[str, tuple[dict[str, Any], tuple[str, ...]]] = {
    "if": ({"condition": HOT}, ("then", "else")),
    "while": ({"condition": HOT}, ("body",)),
    "repeat": ({"times": 2}, ("body",)),
    "for_each": ({"variable": "item", "items": [1, 2, 3], "index": "number"}, ("body",)),
    "for_each_of": ({"variable": "one", "list": {"param": "all"}}, ("body",)),
    "try": ({"kinds": ["failed"]}, ("body", "catch", "finally")),
    "limit": ({"duration": {"quantity": [10, "MIN"]}}, ("body",)),
    "parallel": ({"branches": ["a", "b"]}, ("a", "b")),
}
ROUTES: list[list[list[float]]] = [[], [[5.25, -8.25], [5.25, -6.25], [9.25, -8.25]]]
TRIES: list[tuple[dict[str, Any], tuple[str, ...]]] = [
    HOLDING["try"],
    ({"catch": False}, ("body", "finally")),
    ({"kinds": ["failed"], "kinds2": []}, ("body", "catch", "catch2", "finally")),
    ({"catch": False, "kinds2": ["failed", "offline"], "kinds8": ["blocked"]}, ("body", "catch2", "catch8", "finally")),
]
LOOPS = frozenset({"while", "repeat", "for_each", "for_each_of"})
DEEPEST = 4
TOLD = [{"message": {"param": name}, "level": "info"} for name in ("problem.text", "problem.kind")]


@dataclass(frozen=True)
class Around:
    """What stands around a block: how deep it is, and whether a loop or a function could be left there."""

    depth: int = 0
    loop: bool = False
    caught: bool = False
    function: bool = False


@dataclass
class Steps:
    """The steps so far."""

    draw: st.DrawFn
    steps: dict[str, Any] = field(default_factory=dict)

    def add(self, kind: str, parent: str, branch: str, order: str, params: dict[str, Any]) -> str:
        name = f"s{len(self.steps)}"
        self.steps[name] = {"kind": kind, "place": [parent, branch, order], "pos": [0, 0], "params": params}
        return name

    def block(self, parent: str, branch: str, around: Around) -> None:
        for index in range(self.draw(st.integers(0, 3))):
            kinds = [*PLAIN, *(HOLDING if around.depth < DEEPEST else ())]
            kinds += ["tell"] if around.caught else []
            kinds += (["break", "continue"] if around.loop else []) + (["return"] * 2 if around.function else [])
            kind = self.draw(st.sampled_from(kinds))
            if kind == "tell":
                self.add("notify", parent, branch, f"{index}V", self.draw(st.sampled_from(TOLD)))
            elif kind in HOLDING:
                self.holding(kind, parent, branch, f"{index}V", around)
            else:
                params = PLAIN.get(kind, {"value": 2} if kind == "return" else {})
                if kind == "pick_and_drop":
                    params = {**params, "route": self.draw(st.sampled_from(ROUTES))}
                self.add("set" if kind == "collect" else kind, parent, branch, f"{index}V", params)

    def holding(self, kind: str, parent: str, branch: str, order: str, around: Around) -> None:
        params, branches = HOLDING[kind]
        if kind == "parallel":
            params = {**params, **self.draw(st.sampled_from([{}, {"needed": 1}, {"needed": 2}]))}
        if kind == "try":
            params, branches = self.draw(st.sampled_from(TRIES))
        driven = any(step["kind"] == "pick_and_drop" for step in self.steps.values())
        if driven and "condition" in params and self.draw(st.booleans()):
            params = {"condition": CHARGED}
        step = self.add(kind.removesuffix("_of"), parent, branch, order, params)
        for name in branches:
            inside = replace(around, depth=around.depth + 1, loop=around.loop or kind in LOOPS,
                             caught=around.caught or name.startswith("catch"))  # fmt: skip
            closed = kind == "parallel" or name == "finally"
            self.block(step, name, Around(inside.depth, caught=inside.caught) if closed else inside)


@st.composite
def sound_documents(draw: st.DrawFn) -> dict[str, Any]:
    """Draw a program with a function and with events."""
    steps = Steps(draw)
    steps.add("wait", "program", "body", "0", PLAIN["wait"])
    steps.add("set", "program", "body", "00", {"variable": "all", "value": {"op": "list", "args": []}})
    steps.block("program", "body", Around())
    steps.block("f", "body", Around(1, function=True))
    steps.add("return", "f", "body", "zz", {"value": 4})
    for index in range(draw(st.integers(0, 2))):
        starts = draw(st.sampled_from(["branch", "run"]))
        event = steps.add("on_event", "program", "events", f"{index}V", {"condition": HOT, "starts": starts})
        steps.block(event, "body", Around(1))
    functions = {"f": {"name": "mix_paint", "result": {"type": "number"}}}
    empty: dict[str, Any] = {"roles": {}, "parameters": {}, "zones": {}}
    return {"format": 2, "start_pos": [0, 0], "steps": steps.steps, "functions": functions, **empty}
