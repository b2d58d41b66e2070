"""What vehicles say is read with suspicion."""

from __future__ import annotations

import json
from contextlib import suppress
from copy import deepcopy
from datetime import UTC, datetime
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from connectors.vda5050.factsheet import device_id, read_factsheet, read_properties
from connectors.vda5050.messages import Header, VehicleName, read_connection, read_state, read_visualization
from connectors.vda5050.orders import instant_actions
from tests.integration.connectors.factsheet import FACTSHEET
from tests.kit.programs import paths_in
from tests.unit.connectors.vehicle import HEADER, NAME, STATE, payload
from vipo_device.protocol.loads import read_load
from vipo_device.protocol.messages import BadMessage, is_device_id

JUNK = st.one_of(
    st.none(), st.booleans(), st.integers(), st.floats(allow_nan=False, allow_infinity=False), st.text(max_size=5),
    st.lists(st.integers(), max_size=3), st.dictionaries(st.text(max_size=3), st.integers(), max_size=2),
)  # fmt: skip
NESTED: dict[str, Any] = {
    **STATE,
    "nodeStates": [{"nodeId": "n", "sequenceId": 2, "released": True}],
    "actionStates": [{"actionId": "a", "actionStatus": "RUNNING"}],
    "errors": [
        {"errorType": "e", "errorLevel": "WARNING", "errorReferences": [{"referenceKey": "k", "referenceValue": "v"}]}
    ],
    "loads": [{"loadType": "EPAL"}],
}


@given(st.sampled_from(paths_in(NESTED)[1:]), JUNK)
def test_a_state_with_anything_anywhere_is_read_or_refused(path: tuple[Any, ...], junk: Any) -> None:
    body = deepcopy(NESTED)
    at = body
    for key in path[:-1]:
        at = at[key]
    at[path[-1]] = junk
    with suppress(BadMessage):
        read_state(json.dumps(body).encode(), NAME)


@given(st.binary(max_size=200))
def test_bytes_are_read_or_refused(said: bytes) -> None:
    for read in (read_state, read_connection, read_visualization, read_factsheet):
        with pytest.raises(BadMessage):
            read(said, NAME)


@pytest.mark.parametrize(
    ("changes", "why"),
    [
        ({"serialNumber": "2"}, "state names another vehicle than its topic, which is Acme/1."),
        ({"version": "1.1.0"}, "state/version must be 2.0 or 2.1."),
        ({"headerId": -1}, "state/headerId must be a whole number from 0 to 4294967295."),
        ({"nodeStates": None}, "state/nodeStates must be a list of at most 1000."),
        ({"nodeStates": [{"sequenceId": 1}] * 1001}, "state/nodeStates must be a list of at most 1000."),
        ({"agvPosition": {"x": "1", "y": 0, "theta": 0}}, "state/agvPosition/x must be a number."),
        ({"batteryState": {"batteryCharge": True}}, "state/batteryState/batteryCharge must be a number."),
        ({"errors": [{"errorType": "e", "errorLevel": "BAD"}]}, "state/errors/0/errorLevel must be WARNING or FATAL."),
    ],
)
def test_a_refusal_says_where(changes: dict[str, Any], why: str) -> None:
    with pytest.raises(BadMessage) as caught:
        read_state(payload(STATE, **changes), NAME)
    assert caught.value.detail == why


def test_what_no_text_may_hold_is_left_out_and_the_rest_of_the_state_is_read() -> None:
    told = {"errorType": "scan", "errorLevel": "WARNING", "errorDescription": "no\x07 code"}
    said = payload(
        STATE, loads=[{"loadType": "01\x1d10"}], errors=[told], information=[{"infoType": "\0"}], **{"a\x01": 1}
    )
    read = read_state(said, NAME)
    assert (read.loads, [e.sentence for e in read.errors]) == (("0110",), ["scan: no code"])


def test_a_load_is_shown_by_the_whole_name_of_its_type() -> None:
    carried = [{"loadType": "Euro pallet"}, {"loadType": "Euro pallet"}, {"loadType": "KLT/6428"}, {"loadType": "a:b"}]
    sheet = read_factsheet(payload({**HEADER, **FACTSHEET}), NAME)
    said = read_properties(read_state(payload(STATE, loads=carried), NAME), sheet)
    assert read_load(said["load"]) == {"Euro pallet": 2, "KLT/6428": 1, "a-b": 1}


def test_a_message_that_was_overtaken_is_stale_and_a_new_start_is_not() -> None:
    at, later = datetime(2026, 1, 1, tzinfo=UTC), datetime(2026, 1, 2, tzinfo=UTC)
    newest = Header(7, at, "2.0.0")
    assert Header(7, at, "2.0.0").is_stale(newest)
    assert Header(6, at, "2.0.0").is_stale(newest)
    assert Header(6, None, "2.0.0").is_stale(newest)
    assert not Header(8, at, "2.0.0").is_stale(newest)
    assert not Header(0, later, "2.0.0").is_stale(newest)
    assert not Header(0, at, "2.0.0").is_stale(None)


def test_a_position_that_is_not_initialised_is_none() -> None:
    lost = {"x": 0, "y": 0, "theta": 0, "mapId": "hall", "positionInitialized": False}
    assert read_visualization(payload(HEADER, agvPosition=lost), NAME)[1] is None


def test_a_factsheet_without_a_size_is_refused() -> None:
    body = {**HEADER, **FACTSHEET}
    with pytest.raises(BadMessage, match="factsheet must have typeSpecification and physicalParameters"):
        read_factsheet(payload(HEADER), NAME)
    with pytest.raises(BadMessage, match=r"^factsheet/physicalParameters/width must be above 0\.$"):
        read_factsheet(payload(body, physicalParameters={**FACTSHEET["physicalParameters"], "width": 0}), NAME)


@given(st.text(min_size=1, max_size=80), st.text(min_size=1, max_size=80))
def test_every_vehicle_has_an_id(manufacturer: str, serial: str) -> None:
    assert is_device_id(device_id(VehicleName(manufacturer, serial)))


def test_vehicles_that_look_alike_have_ids_of_their_own() -> None:
    alike = [
        ("Acme", "1"),
        ("Ac-me", "1"),
        ("Ac", "me-1"),
        ("Ac:me", "1"),
        ("Ac me", "1"),
        ("A" * 70, "1"),
        ("A" * 70, "2"),
    ]
    found = [device_id(VehicleName(*pair)) for pair in alike]
    assert found[0] == "Acme-1"
    assert len(set(found)) == len(alike)


def test_the_list_of_instant_actions_has_the_name_of_its_version() -> None:
    assert set(instant_actions([], "2.0.0")) == {"actions", "instantActions"}
    assert set(instant_actions([], "2.1.0")) == {"actions"}
