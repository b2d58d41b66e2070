"""Which devices a document names."""

from __future__ import annotations

from editor.programs.summary import devices_in


def test_devices_are_found_in_steps_conditions_roles_and_arguments() -> None:
    document = {
        "steps": {
            "a": {"kind": "pick", "params": {"at": {"device": "shelf"}}},
            "b": {"kind": "operate", "params": {"device": {"device": "mixer"}, "args": {"of": {"device": "oven"}}}},
            "c": {"kind": "if", "params": {"condition": {"op": "<", "args": [{"property": ["scale", "weight"]}, 3]}}},
            "d": {"kind": "set", "params": {"value": {"property": [{"param": "which"}, "weight"]}}},
            "e": {"kind": "comment", "params": {"text": "device"}},
        },
        "roles": {"r": {"name": "carrier", "device": "robot1"}, "s": {"name": "any", "can": ["pick"]}},
        "parameters": {"which": {"name": "which", "type": "device", "default": {"device": "bin"}}},
        "functions": {},
    }
    assert devices_in(document) == {"shelf", "mixer", "oven", "scale", "robot1", "bin"}


def test_what_is_no_list_where_one_belongs_harms_nothing() -> None:
    assert devices_in({"steps": {"a": {"params": {"property": "text", "device": ["x"]}}}}) == frozenset()
