"""What functions and programs want of devices, followed through calls, and who of a site can do it."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

from hypothesis import given
from hypothesis import strategies as st

from editor.language.signatures.binding import bind_document
from editor.language.signatures.fit import are_met, demands_of, find_lacks, find_matches
from editor.language.signatures.needs import find_needs, find_places
from editor.language.signatures.signature import signature_of
from editor.language.site.signature import Need, Port
from editor.language.site.surroundings import DeviceFacts
from tests.kit.demo_site import factory
from tests.kit.files import ROOT
from tests.kit.programs import document, step

DEVICES = factory().devices
BODY = ("f", "body")


def definition(steps: dict[str, Any], *parameters: dict[str, Any], **more: Any) -> dict[str, Any]:
    function = {"name": "mix", "parameters": [*parameters]}
    return {"id": "f", "function": function, "functions": {}, "roles": {}, "steps": steps, **more}


def needs_of(body: dict[str, Any]) -> tuple[Need, ...]:
    return signature_of(body, DEVICES).needs


def test_steps_say_what_robots_and_machines_must_be_able_to_do() -> None:
    steps = {
        "carry": step(
            "pick_and_drop",
            BODY,
            role="porter",
            object="can",
            source={"device": "paintInventory01"},
            target={"device": "paintMixer02"},
        ),
        "mix": step("operate", BODY, device={"device": "paintMixer02"}, method="mixPaint", args={}),
        "wait": step("wait", BODY, until={"op": "<", "args": [{"property": ["paintMixer02", "temperature"]}, 40]}),
        "blink": step("operate", BODY, device={"role": "porter"}, method="blink", args={}),
        "low": step("wait", BODY, until={"op": ">", "args": [{"property": [{"role": "porter"}, "battery"]}, 20]}),
    }
    assert needs_of(definition(steps, roles={"porter": {"name": "Porter", "can": ["honk"]}})) == (
        Need("machine", "Paint Inventory", "paintInventory01", gives=("can",)),
        Need("machine", "Paint Mixer B", "paintMixer02", ("mixPaint",), (), ("can",), ("temperature",)),
        Need("robot", "Porter", methods=("blink", "drop", "honk", "pick"), readings=("battery",)),
    )


def test_a_device_that_is_given_must_do_what_is_asked_of_it_also_in_functions_that_are_called() -> None:
    steps = {
        "go": step("move", BODY, to={"param": "mixer"}),
        "call": step("call", BODY, function="g", args={"at": {"param": "mixer"}, "oven": {"device": "curingOven01"}}),
        "mix": step("operate", ("g", "body"), device={"param": "at"}, method="mixPaint", args={}),
        "cure": step("operate", ("g", "body"), device={"param": "oven"}, method="curePaint", args={}),
    }
    inner = {"name": "inner", "parameters": [{"name": "at", "type": "device"}, {"name": "oven", "type": "device"}]}
    body = definition(steps, {"name": "mixer", "type": "device"}, functions={"g": inner})
    assert set(needs_of(body)) == {
        Need("robot", "robot", methods=("move",)),
        Need("parameter", "mixer", methods=("mixPaint",)),
        Need("machine", "Curing Oven", "curingOven01", methods=("curePaint",)),
    }


def test_a_signature_has_units_as_codes_and_defaults_as_json() -> None:
    body = definition({}, {"name": "m", "type": "number", "unit": "min", "default": {"quantity": [3, "min"]}})
    body["function"]["result"] = {"type": "number", "unit": "°C"}
    found = signature_of(body, {})
    assert found.parameters == (Port("m", "number", "MIN", '{"quantity": [3, "min"]}'),)
    assert found.result == Port("", "number", "DEG_C")


def test_odd_definitions_have_a_signature() -> None:
    odd = [None, 7, "x", [], {}, [None], {"a": 1}]
    for value in odd:
        body: dict[str, Any] = {"id": "f", "function": value, "functions": value, "steps": value, "roles": value}
        assert signature_of(body, {}).needs == ()
        body = definition({"s": {"kind": "operate", "place": value, "params": value}, "t": value})
        body["function"] = {"parameters": value, "result": value}
        signature_of(body, {})
        signature_of(definition({"s": {"kind": value, "params": {"device": value, "args": value}}}), {})


def test_a_site_that_can_all_lacks_nothing_and_another_what_nobody_there_can() -> None:
    drawn = json.loads((ROOT / "examples" / "paint-order.json").read_text())["document"]
    needs = find_needs(drawn, DEVICES)
    assert find_lacks(needs, DEVICES) == ()
    robots_that_drop = {
        name: replace(facts, description=replace(facts.description, methods=facts.description.methods[:1]))
        if facts.description.kind == "robot"
        else facts
        for name, facts in DEVICES.items()
        if name not in ("curingOven01",)
    }
    lacks = find_lacks(needs, robots_that_drop)
    assert {(each.of, each.name, each.methods) for each in lacks} == {
        ("robot", "Box carrier", ("drop", "pick")),
        ("robot", "Paint carrier", ("drop", "pick")),
        ("machine", "Curing Oven", ("curePaint",)),
    }
    assert {each.name for each in find_lacks(needs, {})} == {need.name for need in needs}


WORDS = st.sampled_from(["pick", "drop", "curePaint", "mixPaint", "can", "temperature", "lift", 'say "ß"', ""])
LISTS = st.lists(WORDS, max_size=3).map(tuple)
NEEDS = st.builds(Need, st.sampled_from(["robot", "machine", "parameter"]), WORDS, WORDS, LISTS, LISTS, LISTS, LISTS)


@given(needs=st.lists(NEEDS, max_size=4), names=st.sets(st.sampled_from(sorted(DEVICES))))
def test_demands_are_met_where_nothing_is_lacked(needs: list[Need], names: set[str]) -> None:
    devices = {name: DEVICES[name] for name in names}
    assert are_met(demands_of(needs), devices) == (find_lacks(needs, devices) == ())
    assert demands_of(reversed(needs)) == demands_of([*needs, *needs])


def test_who_waits_for_approval_or_is_retired_does_not_count() -> None:
    need = Need("machine", "Curing Oven", "curingOven01", methods=("curePaint",))
    retired: dict[str, DeviceFacts] = {"curingOven01": replace(DEVICES["curingOven01"], lifecycle="retired")}
    assert find_matches(need, {"curingOven01": DEVICES["curingOven01"]}) != []
    assert find_matches(need, retired) == []
    assert [lack.methods for lack in find_lacks([need], retired)] == [("curePaint",)]


def test_the_named_device_comes_first_then_who_can_as_much_and_is_called_alike() -> None:
    named = Need("machine", "Paint Mixer B", "paintMixer02", methods=("mixPaint",))
    assert [match.device for match in find_matches(named, DEVICES) if not match.lacks] == [
        "paintMixer02",
        "paintMixer01",
    ]
    strange = Need("machine", "Old oven", "oven9", methods=("curePaint",))
    first, second = find_matches(strange, DEVICES)[:2]
    assert (first.device, first.lacks, bool(second.lacks)) == ("curingOven01", (), True)


def test_places_are_found_in_steps_functions_and_parameters() -> None:
    body = definition({"go": step("move", BODY, to={"place": "dock1"})}, {"name": "p", "default": {"place": "yard"}})
    body["functions"] = {"f": body["function"]}
    assert find_places(body, {}) == ("dock1", "yard")


def with_defaults() -> dict[str, Any]:
    """Return a program whose parameters, and those of its function, name devices and places by default."""
    oven = {"type": "device", "default": "curingOven01"}
    parameters = {
        "oven": oven,
        "dock": {"name": "Dock", "type": "location", "default": "dockA"},
        "shelf": {"type": "place", "default": "itemInventory01"},
        "what": {"type": "text", "default": "dockA"},
    }
    steps = {
        "cure": step("operate", device={"param": "oven"}, method="curePaint", args={}),
        "mix": step("operate", BODY, device={"param": "mixer"}, method="mixPaint", args={}),
    }
    function = {"name": "f", "parameters": [{"name": "mixer", "type": "device", "default": "paintMixer02"}, 7, "x"]}
    return document(steps, functions={"f": function}, parameters=parameters)


def test_devices_and_places_that_are_defaults_are_needed_with_what_is_wanted_of_their_parameters() -> None:
    drawn = with_defaults()
    assert find_needs(drawn, DEVICES) == (
        Need("machine", "Curing Oven", "curingOven01", methods=("curePaint",)),
        Need("machine", "Item Inventory", "itemInventory01"),
        Need("machine", "Paint Mixer B", "paintMixer02", methods=("mixPaint",)),
    )
    assert find_places(drawn, DEVICES) == ("dockA",)


def test_what_a_function_of_the_library_has_by_default_is_not_needed_of_a_site() -> None:
    body = definition({}, {"name": "oven", "type": "device", "default": "curingOven01"})
    assert needs_of(body) == ()


def test_defaults_are_bound_to_who_was_chosen_and_left_out_where_nobody_was() -> None:
    chosen = {"curingOven01": "oven7", "dockA": None, "itemInventory01": "shelf7", "paintMixer02": None}
    made = bind_document(with_defaults(), chosen, {}, {})
    assert made["parameters"] == {
        "oven": {"type": "device", "default": "oven7"},
        "dock": {"name": "Dock", "type": "location"},
        "shelf": {"type": "place", "default": "shelf7"},
        "what": {"type": "text", "default": "dockA"},
    }
    assert made["functions"]["f"]["parameters"] == [{"name": "mixer", "type": "device"}, 7, "x"]


def test_a_parameter_may_be_called_as_a_value_begins() -> None:
    parameters = {"zone": {"type": "text", "default": "wet"}}
    assert bind_document(document({}, parameters=parameters), {}, {}, {})["parameters"] == parameters
