"""The form of faults: what is read, and what is refused with which sentence."""

import json
from dataclasses import replace

import pytest

from simulation import fault_form
from simulation.fault_form import BadFaults, check_faults, faults_to_json, read_faults, read_list
from simulation.world import Fault
from tests.kit.files import ROOT
from tests.unit.simulation.stage_set import BENCH, OVEN, ROBOT
from vipo_device.protocol.description import PropertySpec

ALL = [
    {"fault": "fails", "device": "oven", "error": "Too hot.", "at_step": "a", "nth": 2},
    {"fault": "late", "device": "oven", "after_s": 4.0, "odds": 0.25, "for_s": 10.0},
    {"fault": "wrong_value", "device": "oven", "property": "temperature", "value": -40, "at_s": 3.0},
    {"fault": "obstacle", "x": 1.0, "y": 2.0, "size_m": 0.5, "at_s": 0.0, "for_s": 30.0},
    {"fault": "battery", "device": "robot", "percent": 5.0, "at_s": 1.0},
    *({"fault": word, "device": "oven", "error": "", "at_s": 0.0} for word in ("fails",)),
    *(
        {"fault": word, "device": "oven", "at_s": 0.0}
        for word in ("stops", "silent", "dead", "deaf", "answer_lost", "answers_twice", "drops")
    ),
]


def test_what_is_written_is_read_again():
    faults = read_list(ALL)
    assert faults_to_json(faults) == {"version": 1, "faults": ALL}
    assert read_faults(faults_to_json(faults)) == faults
    assert faults[0] == Fault("oven", "fail_next", step="a", nth=2, error="Too hot.")


@pytest.mark.parametrize(
    ("entry", "why"),
    [
        (7, "write it with “device” and “fault”."),
        ({"fault": "explodes"}, "“fault” is one of fails, stops,"),
        ({"fault": "dead"}, "dead needs “device”."),
        ({"fault": "late", "device": "a"}, "late needs “after_s”."),
        ({"fault": "dead", "device": "a", "after_s": 1}, "“after_s” is not known of dead."),
        ({"fault": "dead", "device": "a", "at_s": -1}, "“at_s” is a number from 0 to 604800, not '-1'."),
        ({"fault": "dead", "device": "a", "at_s": float("nan")}, "“at_s” is a number"),
        ({"fault": "dead", "device": "a", "at_s": True}, "“at_s” is a number"),
        ({"fault": "dead", "device": "a", "odds": 0.5}, "a device that is dead by chance needs “for_s”"),
        ({"fault": "fails", "device": "a", "odds": 0.5, "at_s": 3}, "write “at_s” or “odds”, not both."),
        ({"fault": "fails", "device": "a", "nth": 2}, "“nth” is not known of fails."),
        ({"fault": "fails", "device": "a", "at_step": "s", "nth": 0}, "“nth” is a whole number from 1"),
        ({"fault": "obstacle", "x": 1, "y": 1, "odds": 0.5}, "“odds” is not known of obstacle."),
        ({"fault": "fails", "device": "a" * 201}, "“device” is a text of at most 200 characters."),
    ],
)
def test_a_fault_that_is_not_understood_is_refused_with_its_number(entry, why):
    with pytest.raises(BadFaults) as refused:
        read_list([{"fault": "fails", "device": "a"}, entry])
    assert str(refused.value).startswith("Fault 2: ")
    assert why in str(refused.value)
    assert refused.value.number == 2


@pytest.mark.parametrize(
    ("data", "why"),
    [
        ([], "Write the faults as"),
        ({"version": 9}, "The faults have the version 9"),
        ({"version": True}, "The faults have the version True"),
        ({"version": 1, "more": 1}, "more is not known"),
        ({"version": 1, "faults": [{}] * 101}, "a list of at most 100"),
    ],
)
def test_a_form_that_is_none_is_refused(data, why):
    with pytest.raises(BadFaults, match=why):
        read_faults(data)


@pytest.mark.parametrize(
    ("fault", "why"),
    [
        (Fault("nobody", "dead"), "there is no device 'nobody' here. There are: bench, oven."),
        (Fault("oven", "dead", step="x"), "the program has no step 'x'."),
        (Fault("oven", "drops"), "is no robot"),
        (Fault("oven", "wrong_value", name="colour", value=1), "has no property 'colour'"),
        (Fault("oven", "wrong_value", name="temperature", value="hot"), "temperature is a number; 'hot' is none."),
    ],
)
def test_a_fault_of_what_is_not_there_is_refused(fault, why):
    with pytest.raises(BadFaults, match=why):
        check_faults([fault], [replace(OVEN, id="oven"), replace(BENCH, id="bench")], ["a"])


@pytest.mark.parametrize(
    ("spec", "low"),
    [
        (PropertySpec("battery", "number", "PERCENT"), True),
        (PropertySpec("battery", "number"), True),
        (PropertySpec("battery", "number", "V"), False),
        (PropertySpec("battery", "text"), False),
        (PropertySpec("battery", "boolean"), False),
        (PropertySpec("load", "text"), False),
    ],
)
def test_a_battery_runs_low_only_where_it_is_told_in_per_cent(spec, low):
    told = replace(ROBOT, properties=(spec,))
    if low:
        check_faults([Fault("robot", "battery", value=5.0)], [told], [])
    else:
        with pytest.raises(BadFaults, match="Robot does not say how full its battery is, so it cannot run low"):
            check_faults([Fault("robot", "battery", value=5.0)], [told], [])


def test_the_screens_form_knows_the_same_words_needs_and_ranges():
    told = json.loads((ROOT / "frontend/src/shell/start/faultKinds.json").read_text(encoding="utf-8"))
    assert told["kinds"].keys() == fault_form.KIND_OF.keys()
    for word, kind in told["kinds"].items():
        assert tuple(kind["needs"]) == fault_form._NEEDS.get(word, ()), word
        assert tuple(kind["may"]) == fault_form._MAY.get(word, ()), word
        assert kind["lasts"] is (word in fault_form._LASTS), word
    ranges = {name: tuple(limits) for name, limits in told["ranges"].items() if name != "nth"}
    assert ranges == dict(fault_form._RANGES)
    assert told["most"] == fault_form.MOST_FAULTS


@pytest.mark.parametrize("nth", [0, 10_001])
def test_the_screens_limits_of_how_often_a_step_begins_are_those_that_are_read(nth):
    told = json.loads((ROOT / "frontend/src/shell/start/faultKinds.json").read_text(encoding="utf-8"))
    least, most = told["ranges"]["nth"]
    assert not least <= nth <= most
    for good in (least, most):
        read_list([{"fault": "dead", "device": "oven", "at_step": "a", "nth": good}])
    with pytest.raises(BadFaults, match="nth"):
        read_list([{"fault": "dead", "device": "oven", "at_step": "a", "nth": nth}])
