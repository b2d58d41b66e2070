"""Which devices and places a document names."""

from __future__ import annotations

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
