"""Master control of one vehicle, judged by what it sends and answers."""

from __future__ import annotations

import json

import pytest

from connectors.vda5050.control import VehicleControl
from connectors.vda5050.coordinates import Frame
from tests.integration.connectors.factsheet import action, parameter
from tests.unit.connectors.vehicle import ORDER, Bench, ahead, driving, error, ids, make_vehicle


def test_an_order_begins_where_the_vehicle_stands() -> None:
    bench = Bench()
    bench.tell("move", "a", path=[[1, 0], [2, 0.5]], theta=7.0, speed=0.5)
    (order,) = bench.sent()
    assert (order["orderId"], order["orderUpdateId"]) == (ORDER, 0)
    assert [n["sequenceId"] for n in order["nodes"]] == [0, 2, 4]
    assert [n["nodePosition"] for n in order["nodes"]] == [
        {"x": 0.0, "y": 0.0, "mapId": "hall"},
        {"x": 1, "y": 0, "mapId": "hall"},
        {"x": 2, "y": 0.5, "mapId": "hall", "theta": 0.7168},
    ]
    assert [(e["sequenceId"], e["startNodeId"], e["endNodeId"], e["maxSpeed"]) for e in order["edges"]] == [
        (1, "0.000:0.000", "1.000:0.000", 0.5),
        (3, "1.000:0.000", "2.000:0.500", 0.5),
    ]
    assert all(part["released"] for part in order["nodes"] + order["edges"])
    assert bench.said() == [], "nothing is accepted before the vehicle has taken it"
    bench.hear(orderId=ORDER, **ahead(1, 2, 3, 4))
    assert bench.said() == ["a ACCEPTED", "a RUNNING"]


def test_a_further_piece_grows_the_base_from_its_last_node_unchanged() -> None:
    bench = Bench()
    bench.tell("move", "a", path=[[1, 0]], theta=1.0)
    bench.hear(orderId=ORDER, **ahead(1, 2))
    (first,) = bench.sent()
    bench.tell("move", "b", path=[[1, 1], [1, 2]], **{"from": [1, 0]})
    (update,) = bench.sent()
    assert (update["orderId"], update["orderUpdateId"]) == (ORDER, 1)
    assert update["nodes"][0] == first["nodes"][-1]
    assert [n["sequenceId"] for n in update["nodes"]] == [2, 4, 6]
    bench.hear(orderId=ORDER, orderUpdateId=1, lastNodeSequenceId=2, **ahead(3, 4, 5, 6))
    assert bench.said() == ["a ACCEPTED", "a RUNNING", "b ACCEPTED", "a DONE", "b RUNNING"]
    bench.hear(orderId=ORDER, orderUpdateId=1, lastNodeSequenceId=6)
    assert bench.said() == ["b DONE"]
    bench.tell("move", "c", path=[[0, 0]])
    (new,) = bench.sent()
    assert (new["orderId"], new["orderUpdateId"]) == ("vipo-n2", 0)


def test_the_way_ahead_is_the_horizon_and_each_piece_brings_another() -> None:
    bench = Bench()
    bench.tell("move", "a", path=[[1, 0]], ahead=[[2, 0], [3, 0]])
    (first,) = bench.sent()
    assert [n["released"] for n in first["nodes"]] == [True, True, False, False]
    assert [(e["sequenceId"], e["released"]) for e in first["edges"]] == [(1, True), (3, False), (5, False)]
    bench.hear(orderId=ORDER, **ahead(1, 2, horizon=(3, 4, 5, 6)))
    bench.hear(orderId=ORDER, lastNodeSequenceId=2, **ahead(horizon=(3, 4, 5, 6)))
    assert bench.said() == ["a ACCEPTED", "a RUNNING", "a DONE"]
    bench.tell("move", "b", path=[[1, 1]], ahead="nonsense")
    (update,) = bench.sent()
    assert (update["orderId"], update["orderUpdateId"]) == (ORDER, 1)
    assert [(n["sequenceId"], n["released"]) for n in update["nodes"]] == [(2, True), (4, True)]


def test_a_horizon_is_taken_away_before_the_vehicle_is_to_act() -> None:
    bench = Bench()
    bench.tell("move", "a", path=[[1, 0]], ahead=[[2, 0]])
    bench.hear(orderId=ORDER, lastNodeSequenceId=2, **ahead(horizon=(3, 4)))
    (first,) = bench.sent()
    bench.tell("pick", "p", object="EPAL")
    (away,) = bench.sent()
    assert (away["orderUpdateId"], away["nodes"], away["edges"]) == (1, [first["nodes"][1]], [])
    bench.hear(orderId=ORDER, orderUpdateId=1, lastNodeSequenceId=2)
    (act,) = bench.sent()
    assert act["nodes"][0]["actions"][0]["actionType"] == "pick"
    assert bench.said() == ["a ACCEPTED", "a DONE"]


def test_a_vehicle_that_keeps_its_horizon_does_not_act() -> None:
    bench = Bench()
    bench.tell("move", "a", path=[[1, 0]], ahead=[[2, 0]])
    bench.hear(orderId=ORDER, lastNodeSequenceId=2, **ahead(horizon=(3, 4)))
    bench.tell("pick", "p", object="EPAL")
    bench.sent()
    refused = error("orderUpdateError", text="no", orderId=ORDER, orderUpdateId="1")
    bench.hear(orderId=ORDER, lastNodeSequenceId=2, errors=[refused], **ahead(horizon=(3, 4)))
    assert bench.said() == ["a ACCEPTED", "a DONE", "p REJECTED orderUpdateError: no"]
    assert bench.sent() == []


def test_pieces_that_come_while_an_update_is_on_its_way_go_together_in_the_next() -> None:
    bench = Bench()
    bench.tell("move", "a", path=[[1, 0]])
    bench.tell("move", "b", path=[[2, 0]], **{"from": [1, 0]})
    bench.tell("move", "c", path=[[3, 0]], **{"from": [2, 0]})
    assert len(bench.sent()) == 1
    bench.hear(orderId=ORDER, **ahead(1, 2))
    (update,) = bench.sent()
    assert [n["sequenceId"] for n in update["nodes"]] == [2, 4, 6]


def test_a_lost_order_is_sent_again_and_given_up_in_the_end() -> None:
    bench = Bench()
    bench.tell("move", "a", path=[[1, 0]])
    first = bench.sent()
    bench.wait(2.0)
    assert bench.sent() == []
    for _ in range(3):
        bench.wait(3.1)
        assert bench.sent() == first
    bench.wait(3.1)
    assert bench.said() == ["a REJECTED The vehicle did not take the order."]
    assert bench.sent() == []


def test_a_refused_order_is_rejected_with_the_vehicles_reason() -> None:
    bench = Bench()
    bench.tell("move", "a", path=[[1, 0]])
    bench.tell("move", "b", path=[[2, 0]])
    bench.hear(errors=[error("noRouteError", text="blocked", orderId=ORDER, orderUpdateId="0")])
    assert bench.said() == ["a REJECTED noRouteError: blocked", "b CANCELED The way before it failed."]


def test_a_refusal_without_references_counts_only_if_it_is_new() -> None:
    old = error("validationError", text="long ago")
    bench = Bench()
    bench.hear(errors=[old])
    bench.tell("move", "a", path=[[1, 0]])
    bench.hear(errors=[old])
    assert bench.said() == []
    bench.hear(errors=[old, error("validationError", text="no such map")])
    assert bench.said() == ["a REJECTED validationError: no such map"]


def test_a_refused_update_leaves_the_pieces_before_it() -> None:
    bench = driving()
    bench.tell("move", "b", path=[[9, 9]])
    refused = error("orderUpdateError", text="no", orderId=ORDER, orderUpdateId="1")
    bench.hear(orderId=ORDER, lastNodeSequenceId=2, errors=[refused], **ahead(3, 4))
    assert bench.said() == ["b REJECTED orderUpdateError: no"]
    bench.sent()
    bench.tell("move", "c", path=[[3, 0]], **{"from": [2, 0]})
    (update,) = bench.sent()
    assert (update["orderUpdateId"], update["nodes"][0]["sequenceId"]) == (2, 4)
    bench.hear(orderId=ORDER, orderUpdateId=2, lastNodeSequenceId=6)
    assert bench.said() == ["c ACCEPTED", "a DONE", "c DONE"]


def test_an_order_that_the_vehicle_no_longer_has_has_failed() -> None:
    bench = driving()
    bench.hear(orderId="")
    (said,) = bench.said()
    assert said.startswith("a FAILED The vehicle no longer has the order")


def test_an_order_that_somebody_else_ended_has_failed() -> None:
    bench = driving()
    bench.hear(orderId=ORDER, lastNodeSequenceId=2)
    assert bench.said() == ["a FAILED The vehicle ended its order before the end of the way."]


def test_an_action_that_the_vehicle_no_longer_has_has_failed() -> None:
    bench = Bench()
    bench.tell("pick", "p", object="EPAL")
    bench.tell("move", "b", path=[[1, 0]])
    (order,) = bench.sent()
    running = [{"actionId": order["nodes"][0]["actions"][0]["actionId"], "actionStatus": "RUNNING"}]
    bench.hear(orderId=ORDER)
    bench.wait(3.1)
    assert bench.said() == ["b ACCEPTED", "p ACCEPTED", "p RUNNING"], "one state may be early"
    bench.hear(orderId=ORDER, actionStates=running)
    bench.hear(orderId=ORDER)
    bench.wait(3.1)
    assert bench.said() == []
    bench.hear(orderId=ORDER)
    assert bench.said() == [
        "p FAILED The vehicle no longer has the action; it was started anew, or its order was ended."
    ]
    assert [n["sequenceId"] for n in bench.sent()[0]["nodes"]] == [0, 2], "the next command is its turn"


def test_to_cancel_a_later_piece_sends_the_vehicle_on_to_the_end_of_those_before() -> None:
    bench = driving()
    bench.tell("move", "b", path=[[3, 0]])
    bench.hear(orderId=ORDER, orderUpdateId=1, lastNodeSequenceId=2, **ahead(3, 4, 5, 6))
    bench.said(), bench.sent()
    bench.tell("cancel", "x", command="b")
    (cancel,) = bench.sent()
    assert (cancel["actionType"], cancel["blockingType"]) == ("cancelOrder", "HARD")
    assert bench.said() == []
    here = {"x": 1.4, "y": 0.0, "theta": 0.0, "mapId": "hall"}
    finished = [{"actionId": cancel["actionId"], "actionStatus": "FINISHED"}]
    bench.hear(orderId=ORDER, orderUpdateId=1, lastNodeSequenceId=2, agvPosition=here, actionStates=finished)
    assert bench.said() == ["b CANCELED move was cancelled.", "x DONE"]
    (order,) = bench.sent()
    assert [n["nodePosition"]["x"] for n in order["nodes"]] == [1.4, 2]
    bench.hear(orderId=order["orderId"], lastNodeSequenceId=2)
    assert bench.said() == ["a DONE"]


def test_to_cancel_a_piece_cancels_those_behind_it() -> None:
    bench = driving()
    bench.tell("move", "b", path=[[3, 0]])
    bench.hear(orderId=ORDER, orderUpdateId=1, lastNodeSequenceId=2, **ahead(3, 4, 5, 6))
    bench.tell("cancel", "x", command="a")
    bench.said()
    bench.hear(orderId=ORDER, orderUpdateId=1, lastNodeSequenceId=2)
    assert bench.said() == ["a CANCELED move was cancelled.", "b CANCELED move was cancelled.", "x DONE"]


def test_what_is_cancelled_before_it_came_is_not_carried_out() -> None:
    bench = Bench()
    bench.tell("cancel", "x", command="later")
    bench.tell("move", "later", path=[[1, 0]])
    assert bench.said() == [
        "later CANCELED It was cancelled before it arrived.",
        "x DONE",
        "later CANCELED It was cancelled before it arrived.",
    ]
    assert bench.sent() == []


def test_an_order_of_ours_that_nobody_knows_of_is_cancelled() -> None:
    bench = Bench()
    bench.hear(orderId="vipo-of-another-life", driving=True, **ahead(3, 4))
    (cancel,) = bench.sent()
    assert cancel["actionType"] == "cancelOrder"
    bench.hear(orderId="of-somebody-else", **ahead(3, 4))
    assert bench.sent() == []


def test_a_pick_waits_for_the_way_before_it_and_a_move_for_the_pick() -> None:
    bench = driving()
    bench.tell("pick", "p", object="EPAL", device="shelf")
    bench.tell("move", "b", path=[[0, 0]])
    assert bench.said() == ["p ACCEPTED", "b ACCEPTED"]
    assert bench.sent() == []
    bench.hear(orderId=ORDER, lastNodeSequenceId=4)
    (order,) = bench.sent()
    (node,) = order["nodes"]
    (action,) = node["actions"]
    assert (action["actionType"], action["blockingType"]) == ("pick", "HARD")
    assert action["actionParameters"] == [
        {"key": "stationType", "value": "floor"},
        {"key": "loadType", "value": "EPAL"},
    ]
    running = [{"actionId": action["actionId"], "actionStatus": "RUNNING"}]
    bench.hear(orderId=order["orderId"], actionStates=running)
    assert bench.said() == ["a DONE", "p RUNNING"]
    bench.hear(orderId=order["orderId"], actionStates=[{**running[0], "actionStatus": "FINISHED"}])
    assert bench.said() == ["p DONE"]
    assert [n["sequenceId"] for n in bench.sent()[0]["nodes"]] == [0, 2]


@pytest.mark.parametrize("value", [3, 3.0, -1, 0])
def test_a_whole_number_is_taken_where_an_action_wants_one(value: float) -> None:
    bench = Bench(make_vehicle(more=[action("liftTo", ["NODE"], parameter("level", "INTEGER"))]))
    bench.tell("liftTo", "a", level=value)
    (order,) = bench.sent()
    assert order["nodes"][0]["actions"][0]["actionParameters"] == [{"key": "level", "value": value}]


@pytest.mark.parametrize("value", [0.00001, 2.5, 1e16, 1e300, True, "3"])
def test_what_is_no_whole_number_is_rejected_where_an_action_wants_one(value: object) -> None:
    bench = Bench(make_vehicle(more=[action("liftTo", ["NODE"], parameter("level", "INTEGER"))]))
    bench.tell("liftTo", "a", level=value)
    assert bench.said() == ["a REJECTED liftTo: level must be of the type INTEGER."]


def test_a_failed_action_says_why() -> None:
    bench = Bench()
    bench.tell("drop", "d", object="EPAL")
    (order,) = bench.sent()
    action_id = order["nodes"][0]["actions"][0]["actionId"]
    failed = [{"actionId": action_id, "actionStatus": "FAILED", "resultDescription": "no load"}]
    bench.hear(orderId=order["orderId"], actionStates=failed)
    assert bench.said() == ["d ACCEPTED", "d FAILED no load"]


def test_a_pause_is_repeated_until_the_vehicle_pauses_and_ends_with_its_command() -> None:
    bench = driving()
    bench.tell("pause", "p", command="a")
    (pause,) = bench.sent()
    assert pause["actionType"] == "startPause"
    bench.wait(1.0)
    assert bench.sent() == []
    bench.wait(1.5)
    assert [a["actionType"] for a in bench.sent()] == ["startPause"]
    assert bench.said() == []
    bench.hear(orderId=ORDER, lastNodeSequenceId=2, paused=True, **ahead(3, 4))
    assert bench.said() == ["p DONE"]
    bench.hear(orderId="", paused=True)
    assert [a["actionType"] for a in bench.sent()] == ["stopPause"]


def test_a_vehicle_that_somebody_else_paused_is_not_set_going() -> None:
    bench = driving()
    bench.hear(orderId=ORDER, lastNodeSequenceId=2, paused=True, **ahead(3, 4))
    bench.tell("resume", "r", command="a")
    assert bench.sent() == []
    bench.wait(21.0)
    assert bench.said() == ["r REJECTED The vehicle did not go on within 20 s."]


def test_a_stop_holds_the_vehicle_and_its_reset_lets_it_go() -> None:
    bench = driving()
    bench.control.hold(bench.now_s, active=True)
    assert [a["actionType"] for a in bench.sent()] == ["startPause"]
    bench.hear(orderId=ORDER, lastNodeSequenceId=2, paused=True, **ahead(3, 4))
    bench.tell("move", "b", path=[[3, 0]])
    assert bench.said() == ["b REJECTED The site is stopped."]
    bench.control.hold(bench.now_s, active=False)
    assert [a["actionType"] for a in bench.sent()] == ["stopPause"]


def test_a_vehicle_that_cannot_pause_gives_its_order_up_at_a_stop() -> None:
    bench = Bench(make_vehicle(without="startPause"))
    bench.tell("move", "a", path=[[1, 0]])
    bench.hear(orderId=ORDER, **ahead(1, 2))
    bench.tell("pause", "p", command="a")
    assert bench.said()[-1] == "p REJECTED Acme 1 cannot pause."
    bench.sent()
    bench.control.hold(bench.now_s, active=True)
    assert [a["actionType"] for a in bench.sent()] == ["cancelOrder"]
    bench.hear(orderId=ORDER)
    assert bench.said() == ["a CANCELED move was cancelled."]


def test_a_fatal_error_ends_everything_and_the_order_is_cancelled() -> None:
    bench = driving()
    fault = error("batteryLowError", level="FATAL", text="empty")
    bench.hear(orderId=ORDER, lastNodeSequenceId=2, errors=[fault], **ahead(3, 4))
    assert bench.said() == ["a FAILED batteryLowError: empty"]
    assert [a["actionType"] for a in bench.sent()] == ["cancelOrder"]
    assert bench.control.look(1, 1).properties["error"] == "batteryLowError: empty"


def test_what_is_open_is_taken_up_by_the_next_start_without_being_done_again() -> None:
    bench = driving()
    bench.tell("move", "b", path=[[3, 0]])
    kept = json.loads(json.dumps(bench.control.to_json()))
    update = bench.sent()
    again = VehicleControl(make_vehicle(), ids())
    again.recall(kept)
    again.online = True
    bench.control = again
    bench.hear(orderId=ORDER, lastNodeSequenceId=2, **ahead(3, 4))
    assert [json.loads(json.dumps(m)) for m in bench.sent()] == json.loads(json.dumps(update))
    bench.hear(orderId=ORDER, orderUpdateId=1, lastNodeSequenceId=4, **ahead(5, 6))
    assert bench.said() == ["b ACCEPTED", "a DONE", "b RUNNING"]
    bench.tell("move", "a", path=[[1, 0], [2, 0]])
    assert bench.said() == ["a DONE"]
    assert bench.sent() == []


def test_the_vehicles_map_may_lie_anywhere_in_the_sites() -> None:
    bench = Bench(make_vehicle(frame=Frame(10.0, 20.0, 1.5707963267948966)))
    assert bench.control.look(1, 1).pose is not None
    assert (bench.control.look(1, 1).pose.x, bench.control.look(1, 1).pose.y) == (10.0, 20.0)  # type: ignore[union-attr]
    bench.tell("move", "a", path=[[10.0, 23.0]], theta=1.5708, **{"from": [10.0, 20.0]})
    position = bench.sent()[0]["nodes"][-1]["nodePosition"]
    assert position == {"x": 3.0, "y": 0.0, "mapId": "hall", "theta": 0.0}


def test_what_cannot_be_is_rejected_with_a_reason() -> None:
    bench = Bench()
    bench.tell("fly", "f")
    bench.tell("move", "p", path="north")
    bench.tell("move", "s", path=[[1, 0]], speed=0)
    bench.tell("move", "t", path=[[1, 0]], theta=True)
    bench.tell("move", "o", path=[[1, 0]], **{"from": [4, 0]})
    bench.tell("pick", "q", object="EPAL", value=2)
    assert bench.said() == [
        "f REJECTED Acme 1 cannot fly; it can: move, pick, drop, noop.",
        "p REJECTED move needs a path: a list of 1 to 200 points [x, y] in metres.",
        "s REJECTED speed must be a number above 0, in metres a second.",
        "t REJECTED theta must be a number in radians.",
        "o REJECTED The way begins 4.0 m from where Acme 1 will be.",
        "q REJECTED The quantity must be a whole number from 1 to 1.",
    ]
    assert bench.sent() == []
