"""Master control when something goes wrong: restarts at bad moments, refusals, people and others at the vehicle."""

from __future__ import annotations

import json

from connectors.vda5050.control import VehicleControl
from tests.unit.connectors.vehicle import ORDER, Bench, ahead, driving, error, ids, make_vehicle

HALFWAY = {"orderId": ORDER, "lastNodeSequenceId": 2, **ahead(3, 4)}


def start_anew(bench: Bench) -> None:
    """Let the connector be killed and started again, with what it had kept."""
    kept = json.loads(json.dumps(bench.control.to_json()))
    bench.control = VehicleControl(make_vehicle(), ids())
    bench.control.recall(kept)
    bench.control.online = True


def kinds(bench: Bench) -> list[str]:
    return [str(body.get("actionType") or body["orderId"]) for body in bench.sent()]


def acting() -> tuple[Bench, str]:
    """Return a vehicle that is at the action of the pick `p`, and the action's id."""
    bench = Bench()
    bench.tell("pick", "p", object="EPAL")
    (order,) = bench.sent()
    action_id = order["nodes"][0]["actions"][0]["actionId"]
    bench.hear(orderId=ORDER, actionStates=[{"actionId": action_id, "actionStatus": "RUNNING"}])
    bench.said()
    return bench, action_id


def test_a_vehicle_that_a_stop_holds_is_not_set_going_by_a_new_start() -> None:
    bench = driving()
    bench.control.hold(bench.now_s, active=True)
    bench.hear(paused=True, **HALFWAY)
    bench.sent()
    start_anew(bench)
    bench.hear(paused=True, **HALFWAY)
    assert kinds(bench) == []
    bench.control.hold(bench.now_s, active=False)
    assert kinds(bench) == ["stopPause"]


def test_nothing_that_waits_is_begun_while_the_site_is_stopped() -> None:
    bench = driving()
    bench.tell("pick", "p", object="EPAL")
    bench.control.hold(bench.now_s, active=True)
    bench.sent()
    bench.hear(orderId=ORDER, lastNodeSequenceId=4, paused=True)
    assert kinds(bench) == []
    bench.control.hold(bench.now_s, active=False)
    assert kinds(bench) == ["stopPause", "vipo-n4"]


def test_a_vehicle_that_has_lost_its_place_is_not_sent_anywhere() -> None:
    bench = Bench()
    lost = {"x": 0.0, "y": 0.0, "theta": 0.0, "mapId": "hall", "positionInitialized": False}
    bench.hear(agvPosition=lost)
    bench.tell("move", "a", path=[[1, 0]])
    assert bench.said() == ["a REJECTED Acme 1 does not know where it is; set its position."]
    bench.hear()
    bench.tell("move", "b", path=[[1, 0]])
    assert kinds(bench) == [ORDER]


def test_a_vehicle_that_refuses_to_cancel_is_not_called_cancelled_while_it_drives() -> None:
    bench = driving()
    bench.tell("cancel", "x", command="a")
    (cancel,) = bench.sent()
    refused = [{"actionId": cancel["actionId"], "actionStatus": "FAILED"}]
    bench.hear(actionStates=refused, **HALFWAY)
    assert (bench.said(), kinds(bench)) == ([], [])
    bench.wait(5.1)
    (again,) = bench.sent()
    assert (again["actionType"], again["actionId"] == cancel["actionId"]) == ("cancelOrder", False)
    bench.hear(orderId=ORDER, lastNodeSequenceId=2, actionStates=refused)
    assert bench.said() == ["a CANCELED move was cancelled.", "x DONE"]


def test_an_order_that_outlasts_its_cancelling_is_cancelled_again_but_not_without_pause() -> None:
    bench = Bench()
    stubborn = {"orderId": "vipo-of-another-life", "driving": True, **ahead(3, 4)}
    for _ in range(3):
        bench.hear(**stubborn)
        (cancel,) = bench.sent()
        bench.hear(actionStates=[{"actionId": cancel["actionId"], "actionStatus": "FINISHED"}], **stubborn)
        assert kinds(bench) == []
        bench.now_s += 5.1


def test_an_action_is_cancelled_when_the_vehicle_needs_a_person() -> None:
    bench, action_id = acting()
    fault = error("gripper", level="FATAL", text="stuck")
    running = [{"actionId": action_id, "actionStatus": "RUNNING"}]
    bench.hear(orderId=ORDER, actionStates=running, errors=[fault])
    assert (bench.said(), kinds(bench)) == (["p FAILED gripper: stuck"], ["cancelOrder"])


def test_an_action_of_ours_that_nobody_knows_of_is_cancelled() -> None:
    bench = Bench()
    bench.hear(orderId="vipo-old", actionStates=[{"actionId": "vipo-old-0", "actionStatus": "RUNNING"}])
    assert kinds(bench) == ["cancelOrder"]


def test_an_order_of_somebody_else_is_neither_cancelled_nor_driven_over() -> None:
    bench = driving()
    bench.tell("cancel", "x", command="a")
    bench.sent()
    bench.hear(orderId="theirs", driving=True, **ahead(1, 2))
    bench.wait(6.0)
    assert [said.split()[:2] for said in bench.said()] == [["a", "CANCELED"], ["x", "DONE"]]
    bench.tell("move", "b", path=[[1, 0]])
    assert bench.said() == ["b REJECTED Acme 1 carries out an order of somebody else (theirs)."]
    assert not bench.control.look(1, 1).done, "it is busy, though not for VIPO"
    assert bench.sent() == []


def test_what_waits_is_not_ordered_while_a_person_has_the_vehicle() -> None:
    bench, action_id = acting()
    bench.tell("move", "b", path=[[1, 0]], **{"from": [0, 0]})
    bench.said()
    finished = [{"actionId": action_id, "actionStatus": "FINISHED"}]
    bench.hear(orderId=ORDER, actionStates=finished, operatingMode="MANUAL")
    assert (bench.said(), bench.sent()) == (["p DONE"], [])
    away = {"x": 5.0, "y": 0.0, "theta": 0.0, "mapId": "hall", "positionInitialized": True}
    bench.hear(orderId=ORDER, actionStates=finished, agvPosition=away)
    assert bench.said() == ["b FAILED The way begins 5.0 m from where Acme 1 will be."]
    assert bench.sent() == []


def test_a_warning_that_names_the_order_is_no_refusal_of_its_next_update() -> None:
    bench = driving()
    obstacle = error("obstacle", orderId=ORDER)
    bench.tell("move", "b", path=[[3, 0]])
    bench.hear(errors=[obstacle], **HALFWAY)
    assert bench.said() == []
    refused = error("orderUpdateError", text="no", orderId=ORDER)
    bench.hear(errors=[obstacle, refused], **HALFWAY)
    assert bench.said() == ["b REJECTED orderUpdateError: no"]


def test_a_refusal_whose_number_is_no_text_is_understood() -> None:
    bench = driving()
    bench.tell("move", "b", path=[[3, 0]])
    told = [
        {"referenceKey": "orderId", "referenceValue": ORDER},
        {"referenceKey": "orderUpdateId", "referenceValue": 1},
    ]
    bench.hear(errors=[{**error("tooFar"), "errorReferences": told}], **HALFWAY)
    assert bench.said() == ["b REJECTED tooFar"]


def test_an_order_that_was_cancelled_before_it_was_taken_is_not_sent_again_by_a_new_start() -> None:
    bench = Bench()
    bench.tell("move", "a", path=[[1, 0]])
    bench.tell("cancel", "x", command="a")
    start_anew(bench)
    bench.hear()
    assert (bench.said(), bench.sent()) == ([], [])
    bench.wait(3.1)
    assert (bench.said(), bench.sent()) == (["a CANCELED move was cancelled.", "x DONE"], [])
    bench.hear(orderId=ORDER, **ahead(1, 2))
    assert kinds(bench) == ["cancelOrder"], "it was on its way, and is nobody's now"


def given_up() -> Bench:
    """Return a vehicle that drives `a`, and that four messages about the piece `b` have not reached."""
    bench = driving()
    bench.tell("move", "b", path=[[2, 1]], **{"from": [2, 0]})
    for _ in range(4):
        bench.wait(3.1)
    assert bench.said() == ["b REJECTED The vehicle did not take the order."]
    bench.sent()
    return bench


LATE = {"orderId": ORDER, "orderUpdateId": 1, "driving": True}


def test_an_update_that_is_taken_after_it_was_given_up_is_cancelled_and_what_is_wanted_ordered_anew() -> None:
    bench = given_up()
    bench.hear(lastNodeSequenceId=2, **LATE, **ahead(3, 4, 5, 6))
    (cancel,) = bench.sent()
    assert (cancel["actionType"], bench.said()) == ("cancelOrder", [])
    finished = [{"actionId": cancel["actionId"], "actionStatus": "FINISHED"}]
    bench.hear(lastNodeSequenceId=2, actionStates=finished, **LATE)
    (order,) = bench.sent()
    assert [n["nodePosition"]["x"] for n in order["nodes"]] == [0.0, 2]
    bench.hear(orderId=order["orderId"], lastNodeSequenceId=2)
    assert bench.said() == ["a DONE"]


def test_a_vehicle_that_drives_what_was_given_up_is_busy_until_it_stands() -> None:
    bench = given_up()
    bench.hear(lastNodeSequenceId=4, **LATE, **ahead(5, 6))
    assert (bench.said(), kinds(bench)) == (["a DONE"], ["cancelOrder"])
    assert not bench.control.look(1, 1).done
    bench.hear(lastNodeSequenceId=4, **LATE)
    assert bench.control.look(1, 1).done


def test_what_was_given_up_is_noticed_after_a_new_start_and_behind_a_second_one() -> None:
    bench = given_up()
    bench.tell("move", "c", path=[[2, -1]], **{"from": [2, 0]})
    for _ in range(4):
        bench.wait(3.1)
    start_anew(bench)
    bench.hear(lastNodeSequenceId=2, **LATE, **ahead(3, 4, 5, 6))
    assert kinds(bench) == ["cancelOrder"]


def test_a_newer_piece_is_not_taken_for_the_one_that_was_given_up() -> None:
    bench = given_up()
    bench.tell("move", "c", path=[[2, -1]], **{"from": [2, 0]})
    bench.sent()
    bench.hear(lastNodeSequenceId=6, **LATE, agvPosition={"x": 2, "y": 1, "theta": 0, "mapId": "hall"})
    assert bench.said() == ["a DONE", "c REJECTED The way begins 1.0 m from where Acme 1 will be."]
    assert kinds(bench) == []


def test_a_newer_piece_is_ordered_anew_where_the_one_given_up_is_taken_in_its_stead() -> None:
    bench = given_up()
    bench.tell("move", "c", path=[[2, -1]], **{"from": [2, 0]})
    bench.sent()
    bench.hear(lastNodeSequenceId=2, **LATE, **ahead(3, 4, 5, 6))
    assert (bench.said(), kinds(bench)) == ([], ["cancelOrder"])
    bench.hear(lastNodeSequenceId=2, **LATE)
    (order,) = bench.sent()
    assert [(n["nodePosition"]["x"], n["nodePosition"]["y"]) for n in order["nodes"]] == [(0.0, 0.0), (2, 0), (2, -1)]
    bench.hear(orderId=order["orderId"], lastNodeSequenceId=2, **ahead(3, 4))
    assert bench.said() == ["c ACCEPTED", "a DONE", "c RUNNING"]


def test_a_newer_piece_that_is_cancelled_ends_with_the_one_that_was_given_up() -> None:
    bench = given_up()
    bench.tell("move", "c", path=[[2, -1]], **{"from": [2, 0]})
    bench.tell("cancel", "x", command="c")
    bench.hear(lastNodeSequenceId=2, **LATE, **ahead(3, 4, 5, 6))
    bench.hear(lastNodeSequenceId=2, **LATE)
    assert bench.said() == ["c CANCELED move was cancelled.", "x DONE"]


def test_what_a_vehicle_does_not_tell_is_left_out_and_what_stops_it_is_said() -> None:
    bench = Bench()
    bench.hear(batteryState=None, safetyState={"eStop": "MANUAL", "fieldViolation": True}, errors=[error("slip")])
    shown = bench.control.look(1, 1).properties
    assert "battery" not in shown
    assert (shown["error"], shown["warning"]) == (
        "Emergency stop (MANUAL)",
        "Something is in its protective field; slip",
    )


def test_what_is_kept_is_not_copied_with_each_message() -> None:
    control = driving().control
    assert control.to_json()["order"]["body"] is control.to_json()["order"]["body"]


def test_a_pause_that_comes_when_its_command_has_just_ended_is_answered_at_once() -> None:
    bench = driving()
    bench.hear(orderId=ORDER, lastNodeSequenceId=4)
    bench.tell("pause", "p", command="a")
    assert bench.said() == ["a DONE", "p DONE"]
    assert bench.sent() == []
