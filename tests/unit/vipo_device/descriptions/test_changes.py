from __future__ import annotations

from dataclasses import replace

from registry.demo.devices import describe_devices
from vipo_device.descriptions.changes import Change, list_changes
from vipo_device.protocol.description import ParameterSpec, Pose, PropertySpec, description_to_json

MIXER = next(d for d in describe_devices() if d.id == "paintMixer02")
BEFORE = description_to_json(MIXER)


def test_the_same_and_a_change_of_done_are_no_change() -> None:
    assert list_changes(BEFORE, BEFORE) == ()
    assert list_changes(BEFORE, description_to_json(replace(MIXER, done=False))) == ()


def test_fields_are_compared_by_their_paths() -> None:
    mix, dispense = MIXER.methods
    longer = replace(mix, parameters=(ParameterSpec("time", "number", "MIN", 1.0, 60.0),))
    after = replace(
        MIXER,
        pose=Pose(1.0, -5.85),
        methods=(longer, dispense),
        properties=(MIXER.properties[0], PropertySpec("level", "number")),
        takes=("box", "can"),
    )
    changes = list_changes(BEFORE, description_to_json(after))
    assert changes[0] == Change("pose/x", "14.78", "1.0")
    assert changes[1] == Change("takes", '["can"]', '["box", "can"]')
    assert [(c.path, c.before[:22], c.after[:18]) for c in changes[2:4]] == [
        ("properties/temperature", '{"name": "temperature"', ""),
        ("properties/level", "", '{"name": "level", '),
    ]
    assert changes[4:] == (Change("methods/mixPaint/parameters/time/maximum", "30.0", "60.0"),)


def test_another_order_is_told_and_all_that_went_is_told() -> None:
    turned = description_to_json(replace(MIXER, properties=MIXER.properties[::-1]))
    assert list_changes(BEFORE, turned) == (
        Change("properties (order)", "jobStatus, temperature", "temperature, jobStatus"),
    )
    bare = description_to_json(replace(MIXER, methods=()))
    assert [change.path for change in list_changes(BEFORE, bare)] == ["methods/mixPaint", "methods/dispense"]


def test_no_more_than_forty_changes_are_kept() -> None:
    many = tuple(PropertySpec(f"p{i}", "number") for i in range(64))
    assert len(list_changes(BEFORE, description_to_json(replace(MIXER, properties=many)))) == 40
