"""Programs made by chance: sound enough to print, and as broken as can be."""

from __future__ import annotations

from typing import Any

from hypothesis import strategies as st

from editor.language.constructs.table import COMMENT, CONSTRUCTS

DEVICES = ("itemInventory01", "paintInventory01", "paintMixer02", "paintMachine01", "curingOven01", "dropOff01")
ROLES = ("robot", "box_carrier", "paint_carrier", "bound")

names = st.sampled_from(["minutes", "shade", "n"])
variables = st.sampled_from(["minutes", "total", "Paint count", "wait", "robot", "", None])
answers = st.sampled_from(
    [
        {"type": "boolean"},
        {"type": "number", "unit": "MIN", "minimum": 1, "maximum": 2.5},
        {"type": "choice", "options": ["red", "blue", "red", ""]},
        {"type": "text", "minimum": 4},
        {"type": "colour"},
        None,
    ]
)
places = st.one_of(
    st.sampled_from([{"device": device} for device in DEVICES]),
    st.sampled_from([{"place": "dock1"}, {"point": [1.5, -2]}, {"param": "minutes"}, None, {"device": "gone"}]),
)
robots = st.sampled_from(
    [*({"role": role} for role in ROLES), {"role": "gone"}, {"role": 3}, {"device": "robot01"}, {"device": "robot02"}]
)
numbers = st.one_of(st.integers(-5, 200), st.floats(-1e6, 1e6, allow_nan=False))
readings = st.sampled_from(
    [
        {"property": ["curingOven01", "temperature"]},
        {"property": ["curingOven01", "quality"]},
        {"property": ["curingOven01", "no such"]},
        {"property": ["gone", "jobStatus"]},
        {"property": [{"param": "minutes"}, "jobStatus"]},
        *({"property": [{"role": role}, "battery"]} for role in (*ROLES, "gone", 3, None)),
        {"property": [{"role": "box_carrier"}, "no such"]},
        {"property": [{"role": "robot", "param": "minutes"}, "load"]},
    ]
)
things = st.sampled_from(
    [
        {"at": {"device": "curingOven01"}},
        {"at": {"place": "dock1"}},
        {"at": {"point": [3.5, -8]}},
        {"at": {"role": "box_carrier"}},
        {"at": {"role": "bound"}},
        {"at": {"param": "minutes"}},
        {"device": "dropOff01"},
        {"zone": "z1"},
        {"zone": "gone"},
        {"quantity": [10, "MIN"]},
        {"quantity": [-2.5, "°C"]},
        {"quantity": [3, "widgets"]},
        {"op": "now", "args": []},
    ]
)
choices = st.sampled_from(
    [
        None,
        {"op": ">", "args": [{"property": [{"role": "box_carrier"}, "battery"]}, 30]},
        {"op": "<", "args": [{"property": [{"role": "box_carrier"}, "no such"]}, {"quantity": [2, "widgets"]}]},
        {"op": "and", "args": [{"property": [{"role": "box_carrier"}, "load"]}, None]},
        {"op": ">", "args": [{"property": [{"role": "robot"}, "battery"]}, 30]},
        {"op": ">", "args": [{"param": "minutes"}, 30]},
        {"at": {"role": "box_carrier"}},
        {"zone": "z1"},
        "battery > 30",
        [1, 2],
    ]
)
leaves = st.one_of(
    numbers,
    things,
    st.booleans(),
    st.text(max_size=6),
    readings,
    st.just(None),
    st.sampled_from(
        [
            {"param": "minutes"},
            {"param": "total"},
            {"param": "Paint count"},
            {"param": "robot"},
            {"param": "problem.text"},
            {"param": "problem.kind"},
        ]
    ),
    st.just([1, "a"]),
)


def _operations(inner: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
    two = st.sampled_from(["<", "<=", ">", ">=", "==", "!=", "in", "not in", "+", "-", "*", "/", "min", "max"])
    return st.one_of(
        st.builds(lambda op, a, b: {"op": op, "args": [a, b]}, two, inner, inner),
        st.builds(lambda op, a: {"op": op, "args": [a]}, st.sampled_from(["-", "not", "abs", "round"]), inner),
        st.builds(
            lambda op, a: {"op": op, "args": a},
            st.sampled_from(["and", "or", "text", "count", "nearest", "min", "max"]),
            st.lists(inner, min_size=2, max_size=3),
        ),
        st.builds(lambda a, b: {"op": "distance", "args": [a, b]}, inner, inner),
        st.builds(lambda items: {"op": "list", "args": items}, st.lists(inner, max_size=3)),
        st.builds(lambda a: {"op": "len", "args": [a]}, inner),
        st.builds(lambda a, b: {"op": "nth", "args": [a, b]}, inner, inner),
    )


values = st.recursive(leaves, _operations, max_leaves=8)
loads = {"role": st.sampled_from(ROLES), "object": st.sampled_from(["box", "can", None]), "quantity": values}
PARAMS: dict[str, st.SearchStrategy[dict[str, Any]]] = {
    "move": st.fixed_dictionaries(
        {"role": st.sampled_from(ROLES), "to": places, "route": st.sampled_from([[], [[1, 2], [3.5, 4]]])}
    ),
    "pick": st.fixed_dictionaries({**loads, "at": places}),
    "drop": st.fixed_dictionaries({**loads, "at": places}),
    "pick_and_drop": st.fixed_dictionaries({**loads, "source": places, "target": places}),
    "cover": st.fixed_dictionaries(
        {"role": st.sampled_from(ROLES), "zone": st.sampled_from(["z1", "gone", None, 3]), "lane": values}
    ),
    "release": st.fixed_dictionaries({"role": st.sampled_from([*ROLES, "gone", None, 3])}),
    "operate": st.fixed_dictionaries(
        {
            "device": st.one_of(places, robots),
            "method": st.sampled_from(
                ["curePaint", "mixPaint", "paint", "no such", "dispense", None, "honk", "blink", "move", "__class__"]
            ),
            "args": st.dictionaries(st.sampled_from(["time", "times", "object", "value", "x y"]), values, max_size=2),
        }
    ),
    "wait": st.one_of(
        st.fixed_dictionaries({"duration": values}),
        st.fixed_dictionaries({"until": values, "timeout": values}),
    ),
    "if": st.fixed_dictionaries({"condition": values}),
    "while": st.fixed_dictionaries({"condition": values}),
    "parallel": st.builds(
        lambda branches, needed: {**branches, **needed},
        st.sampled_from([{"branches": ["a", "b"]}, {"branches": ["a", "b", "c"]}, {}]),
        st.sampled_from([{}, *({"needed": n} for n in (1, 2, 2.0, 3, 0, 99, -1, 1.5, "x", True, None, [1], 1e300))]),
    ),
    "try": st.builds(
        lambda first, more: {**first, **more},
        st.sampled_from(
            [{"kinds": []}, {"kinds": ["failed", "offline"]}, {"kinds": ["timed_out"]}, {}, {"catch": False}]
        ),
        st.dictionaries(
            st.sampled_from(["kinds2", "kinds3", "kinds8", "kinds9"]),
            st.sampled_from([[], ["failed"], ["offline", "blocked"], ["x", 3], None, "failed", {"a": 1}]),
            max_size=3,
        ),
    ),
    "limit": st.fixed_dictionaries({"duration": values}),
    "call": st.fixed_dictionaries(
        {
            "function": st.sampled_from(["f", "g", "gone", None]),
            "args": st.dictionaries(names, values, max_size=2),
            "result": variables,
        }
    ),
    "repeat": st.fixed_dictionaries({"times": values}),
    "for_each": st.fixed_dictionaries(
        {
            "variable": variables,
            "items": st.lists(values, max_size=3),
            "index": variables,
            "list": st.one_of(st.none(), leaves),
        }
    ),
    "set": st.fixed_dictionaries({"variable": variables, "value": values}),
    "ask": st.fixed_dictionaries(
        {"question": values, "answer": answers, "variable": variables, "timeout": st.one_of(st.none(), values)}
    ),
    "notify": st.fixed_dictionaries({"message": values, "level": st.sampled_from(["info", "warning", "loud"])}),
    "end": st.just({}),
    "fail": st.fixed_dictionaries({"message": values}),
    "return": st.fixed_dictionaries({"value": values}),
    "break": st.just({}),
    "continue": st.just({}),
    "on_event": st.fixed_dictionaries({"condition": values, "starts": st.sampled_from(["branch", "run", None])}),
}
for construct in CONSTRUCTS.values():  # a kind that nobody wrote anything for has anything in its fields
    if construct.kind == COMMENT:
        continue
    PARAMS.setdefault(construct.kind, st.fixed_dictionaries({field.name: values for field in construct.fields}))
corners = st.lists(st.one_of(st.tuples(numbers, numbers).map(list), st.just("x")), max_size=6)
zones = st.dictionaries(
    st.sampled_from(["z1", "z2", "wet floor", 'Größe "9"', "robot"]),
    st.fixed_dictionaries(
        {"rule": st.sampled_from(["slow", "keep_out", "one_at_a_time", "door", "dance", None]), "points": corners},
        optional={
            "name": st.sampled_from(["robot", "Wet floor", "", "z1", "minutes", 4]),
            "speed_m_s": st.sampled_from([0.3, 1, 0, -2, None, "fast"]),
            "door": st.sampled_from(["gate01", "curingOven01", 'a "b"', "", None, 3]),
        },
    ),
    max_size=3,
)
BRANCHES = ["body", "then", "else", "catch", "catch2", "catch3", "catch8", "finally", "a", "b", "c"]


@st.composite
def documents(draw: st.DrawFn, largest: int = 12) -> dict[str, Any]:
    """Draw a document whose steps are of known kinds, in places that may or may not be good."""
    count = draw(st.integers(0, largest))
    ids = [f"s{index}" for index in range(count)]
    steps: dict[str, Any] = {}
    for index, name in enumerate(ids):
        kind = draw(st.sampled_from(sorted(PARAMS)))
        parent = draw(st.sampled_from(["program", "program", "f", "g", *ids[: max(index, 1)], *ids]))
        branch = "body" if parent in {"program", "f", "g"} else draw(st.sampled_from(BRANCHES))
        if kind == "on_event" and draw(st.booleans()):
            parent, branch = "program", "events"
        order = draw(st.sampled_from(["1", "5", "V", "a"]))
        steps[name] = {"kind": kind, "place": [parent, branch, order], "pos": [index, 0], "params": draw(PARAMS[kind])}
    parameters = draw(st.lists(names, unique=True, max_size=2))
    function = {"name": "mixPaint", "parameters": [{"name": n, "type": "number"} for n in parameters]}
    function["result"] = draw(st.sampled_from([None, {"type": "number", "unit": "MIN"}, {"type": "text"}]))
    default = draw(st.sampled_from(["minutes", "n"]))
    second = {"name": "Class", "parameters": [{"name": "n", "default": 3}, {"name": "shade"}]}
    return {
        "format": 2,
        "start_pos": [0, 0],
        "steps": steps,
        "functions": {"f": function, "g": second},
        "roles": {
            "box_carrier": {"name": "box carrier", "can": ["pick"], "where": draw(choices)},
            "bound": {"name": "bound", "device": "robot01"},
            "paint_carrier": {"name": "drop off", "can": []},
        },
        "parameters": {"p": {"name": default, "type": "number", "default": 2}},
        "zones": draw(zones),
    }


json_values = st.recursive(
    st.one_of(st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=5)),
    lambda inner: st.one_of(st.lists(inner, max_size=3), st.dictionaries(st.text(max_size=5), inner, max_size=3)),
    max_leaves=8,
)
KEYS = ["steps", "functions", "roles", "parameters", "kind", "place", "params", "s1", "program", "body", "param",
        "property", "op", "args", "device", "role", "function", "branches", "needed", "until", "name"]  # fmt: skip
broken_documents = st.recursive(
    st.one_of(json_values, st.sampled_from([*PARAMS, "program", "body", "s1", "f"])),
    lambda inner: st.one_of(st.lists(inner, max_size=4), st.dictionaries(st.sampled_from(KEYS), inner, max_size=5)),
    max_leaves=25,
)
