"""Which devices, places and points of the floor a document names."""

from __future__ import annotations

from editor.programs.floor_use import goal_points, step_points
from editor.programs.summary import Named, names_in


def test_devices_and_places_are_found_in_steps_conditions_roles_and_arguments() -> None:
    document = {
        "steps": {
            "a": {"kind": "pick", "place": ["", "body", "a0"], "params": {"at": {"device": "shelf"}}},
            "b": {"kind": "operate", "params": {"device": {"device": "mixer"}, "args": {"of": {"device": "oven"}}}},
            "c": {"kind": "if", "params": {"condition": {"op": "<", "args": [{"property": ["scale", "weight"]}, 3]}}},
            "d": {"kind": "set", "params": {"value": {"property": [{"param": "which"}, "weight"]}}},
            "e": {"kind": "comment", "params": {"text": "device"}},
            "f": {"kind": "move", "place": None, "params": {"to": {"place": "dock1"}}},
            "g": {"kind": "call", "params": {"args": {"where": {"place": "bench"}}}},
        },
        "roles": {"r": {"name": "carrier", "device": "robot1"}, "s": {"name": "any", "can": ["pick"]}},
        "parameters": {"which": {"name": "which", "type": "device", "default": {"device": "bin"}}},
        "functions": {},
    }
    devices = frozenset({"shelf", "mixer", "oven", "scale", "robot1", "bin"})
    assert names_in(document) == Named(devices, frozenset({"dock1", "bench"}))


def test_what_is_no_list_where_one_belongs_harms_nothing() -> None:
    assert names_in({"steps": {"a": {"params": {"property": "text", "device": ["x"]}}}}) == Named(
        frozenset(), frozenset()
    )


ON_THE_FLOOR = {
    "steps": {
        "a": {"kind": "move", "place": ["program", "body", "0V"], "pos": [1, 2], "params": {"to": {"point": [3, 4]}}},
        "b": {"kind": "wait", "place": ["program", "body", "1V"], "pos": "nowhere", "params": {}},
        "c": {"kind": "comment", "place": None, "pos": [9, 9], "params": {"text": "on the margin"}},
        "d": {
            "kind": "pick_and_drop",
            "place": ["program", "body", "2V"],
            "pos": [5.5, 6],
            "params": {"source": {"device": "m"}, "target": {"point": [7, 8]}, "via": [[0, 0], {"point": [1]}]},
        },
    }
}


def test_steps_stand_where_they_are_drawn_and_comments_do_not_count() -> None:
    assert list(step_points(ON_THE_FLOOR)) == [(1.0, 2.0), (5.5, 6.0)]


def test_goals_are_the_points_that_steps_name() -> None:
    assert list(goal_points(ON_THE_FLOOR)) == [(3.0, 4.0), (7.0, 8.0)]
