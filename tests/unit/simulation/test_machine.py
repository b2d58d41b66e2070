"""What a pretend machine does with commands and time."""

from __future__ import annotations

from dataclasses import replace
from math import exp
from typing import Any

import pytest

from simulation.actors import InitialState, Machine
from simulation.actors.machine import first_stock
from simulation.behaviour import behaviour_of
from simulation.kind_file import default_kinds
from simulation.world import Ack, Fault, FaultKind, PropertyChanged, WorldEvent
from tests.unit.simulation.stage_set import BENCH, OVEN, ROLLERS, SHELF
from vipo_device.protocol.description import Description, PropertySpec


class Watched:
    """A machine, its clock and what it said."""

    def __init__(self, description: Description, **beginning: Any) -> None:
        self.events: list[WorldEvent] = []
        beginning.setdefault("behaviour", behaviour_of(description, default_kinds()))
        self.machine = Machine(description, self.events.append, InitialState(**beginning))
        self.t_s = 0.0

    def tell(self, method: str, command: str = "c1", /, **arguments: object) -> None:
        self.machine.command(self.t_s, method, arguments, command)

    def wait(self, seconds: float, dt_s: float = 0.5) -> None:
        for _ in range(round(seconds / dt_s)):
            self.t_s = round(self.t_s + dt_s, 6)
            self.machine.advance(self.t_s, dt_s)

    def answers(self, command: str = "c1") -> list[str]:
        return [e.status for e in self.events if isinstance(e, Ack) and e.command == command]

    def why(self, command: str = "c1") -> str:
        return [e.why for e in self.events if isinstance(e, Ack) and e.command == command][-1]


def test_a_method_with_a_time_takes_that_many_minutes() -> None:
    oven = Watched(OVEN)
    oven.tell("curePaint", time=10)
    assert oven.answers() == ["ACCEPTED", "RUNNING"]
    oven.wait(599.5)
    assert oven.machine.busy
    assert oven.machine.readings["jobStatus"] == 99
    oven.wait(0.5)
    assert not oven.machine.busy
    assert oven.answers() == ["ACCEPTED", "RUNNING", "DONE"]
    done = oven.events[-1]
    assert isinstance(done, Ack)
    assert (done.t_s, done.result) == (600.0, {"quality": "ok"})
    assert oven.machine.readings["jobStatus"] == 100


def test_progress_goes_from_0_to_100_without_going_back() -> None:
    oven = Watched(OVEN)
    oven.tell("curePaint", time=2)
    oven.wait(120)
    shown = [e.value for e in oven.events if isinstance(e, PropertyChanged) and e.name == "jobStatus"]
    assert shown == sorted(set(shown))
    assert shown[-1] == 100


@pytest.mark.parametrize(
    ("method", "arguments", "lasts_s"), [("weld", {"mode": "fast"}, 2.0), ("cool", {"time": 7}, 7.0)]
)
def test_an_unknown_class_does_any_method(method: str, arguments: dict[str, object], lasts_s: float) -> None:
    bench = Watched(BENCH)
    bench.tell(method, **arguments)
    bench.wait(lasts_s - 0.5)
    assert bench.answers() == ["ACCEPTED", "RUNNING"]
    bench.wait(0.5)
    assert bench.answers()[-1] == "DONE"


def test_the_oven_warms_up_and_cools_below_40_within_some_minutes() -> None:
    oven = Watched(OVEN)
    oven.tell("curePaint", time=10)
    oven.wait(600)
    hot = oven.machine.readings["temperature"]
    assert isinstance(hot, float)
    assert hot == pytest.approx(80 - 58 * exp(-10), abs=0.6)
    oven.wait(130)
    still_warm = oven.machine.readings["temperature"]
    assert isinstance(still_warm, float)
    assert still_warm > 40
    oven.wait(20)
    cooler = oven.machine.readings["temperature"]
    assert isinstance(cooler, float)
    assert cooler < 40
    oven.wait(3600)
    assert oven.machine.readings["temperature"] == 22.0
    assert oven.machine.resting


def test_every_fifth_piece_is_scratched() -> None:
    oven = Watched(OVEN)
    seen = []
    for i in range(5):
        oven.tell("curePaint", f"c{i}", time=1)
        oven.wait(60)
        seen.append(oven.machine.readings["quality"])
    assert seen == ["ok", "ok", "ok", "ok", "scratched"]


@pytest.mark.parametrize(
    ("method", "arguments", "why"),
    [
        ("bake", {}, "Oven cannot bake; it can: curePaint."),
        ("curePaint", {}, "curePaint needs a value for time."),
        ("curePaint", {"time": "long"}, "curePaint: time must be a number."),
        ("curePaint", {"time": True}, "curePaint: time must be a number."),
        ("curePaint", {"time": float("nan")}, "curePaint: time must be a number."),
        ("curePaint", {"time": 0}, "curePaint: time must be at least 1, not 0."),
        ("curePaint", {"time": 61}, "curePaint: time must be at most 60, not 61."),
    ],
)
def test_what_does_not_fit_is_rejected_and_nothing_happens(method: str, arguments: dict[str, object], why: str) -> None:
    oven = Watched(OVEN)
    before = dict(oven.machine.readings)
    oven.tell(method, **arguments)
    oven.wait(10)
    assert oven.answers() == ["REJECTED"]
    assert oven.why() == why
    assert oven.machine.readings == before


def test_a_busy_machine_rejects_a_second_command() -> None:
    oven = Watched(OVEN)
    oven.tell("curePaint", "first", time=1)
    oven.tell("curePaint", "second", time=1)
    assert oven.answers("second") == ["REJECTED"]
    assert oven.why("second") == "Oven is busy with curePaint."
    oven.wait(60)
    assert oven.answers("first")[-1] == "DONE"


def test_a_repeated_command_is_answered_again_and_not_done_again() -> None:
    oven = Watched(OVEN)
    oven.tell("curePaint", time=1)
    oven.tell("curePaint", time=1)
    assert oven.answers() == ["ACCEPTED", "RUNNING", "RUNNING"]
    oven.wait(60)
    oven.tell("curePaint", time=1)
    assert oven.answers()[-2:] == ["DONE", "DONE"]
    assert not oven.machine.busy


def test_the_last_16_commands_are_remembered() -> None:
    bench = Watched(BENCH)
    for i in range(17):
        bench.tell("weld", f"c{i}", mode="slow")
        bench.wait(2)
    bench.tell("weld", "c1", mode="slow")
    assert bench.answers("c1") == ["ACCEPTED", "RUNNING", "DONE", "DONE"]
    bench.tell("weld", "c0", mode="slow")
    assert bench.answers("c0") == ["ACCEPTED", "RUNNING", "DONE", "ACCEPTED", "RUNNING"]


def test_pause_keeps_the_work_and_resume_goes_on() -> None:
    oven = Watched(OVEN)
    oven.tell("curePaint", time=1)
    oven.wait(30)
    oven.tell("pause", "p")
    oven.wait(500)
    assert oven.machine.readings["jobStatus"] == 50
    oven.tell("resume", "r")
    oven.wait(29.5)
    assert oven.machine.busy
    oven.wait(0.5)
    assert oven.answers()[-1] == "DONE"
    assert oven.answers("p") == oven.answers("r") == ["DONE"]


def test_a_pause_ends_with_the_command_that_it_held() -> None:
    oven = Watched(OVEN)
    oven.tell("curePaint", "held", time=1)
    oven.wait(5)
    oven.tell("pause", "p", command="held")
    oven.wait(100)
    assert oven.machine.busy
    oven.tell("cancel", "x", command="held")
    assert oven.answers("held") == ["ACCEPTED", "RUNNING", "CANCELED"]
    oven.tell("curePaint", "next", time=1)
    oven.wait(61)
    assert oven.answers("next") == ["ACCEPTED", "RUNNING", "DONE"]


def test_a_pause_that_comes_before_its_command_holds_it() -> None:
    oven = Watched(OVEN)
    oven.tell("pause", "p", command="late")
    oven.tell("curePaint", "late", time=1)
    oven.wait(100)
    assert oven.answers("late") == ["ACCEPTED", "RUNNING"]
    oven.tell("resume", "r", command="late")
    oven.wait(61)
    assert oven.answers("late")[-1] == "DONE"


def test_cancel_ends_the_work() -> None:
    oven = Watched(OVEN)
    oven.tell("curePaint", time=1)
    oven.wait(5)
    oven.tell("cancel", "x", command="c1")
    assert oven.answers() == ["ACCEPTED", "RUNNING", "CANCELED"]
    assert oven.answers("x") == ["DONE"]
    assert not oven.machine.busy


def test_a_command_that_was_cancelled_before_it_came_is_not_done() -> None:
    oven = Watched(OVEN)
    oven.tell("cancel", "x", command="late")
    oven.tell("curePaint", "late", time=1)
    assert oven.answers("late") == ["CANCELED"]
    assert not oven.machine.busy


def test_cancelling_what_is_over_changes_nothing() -> None:
    bench = Watched(BENCH)
    bench.tell("weld", mode="slow")
    bench.wait(2)
    bench.tell("cancel", "x", command="c1")
    bench.tell("weld", mode="slow")
    assert bench.answers() == ["ACCEPTED", "RUNNING", "DONE", "DONE"]


def test_a_held_machine_stands_still_until_it_is_let_go() -> None:
    oven = Watched(OVEN)
    oven.tell("curePaint", time=1)
    oven.machine.held = True
    oven.wait(100)
    assert oven.machine.readings["jobStatus"] == 0
    oven.machine.held = False
    oven.wait(60)
    assert oven.answers()[-1] == "DONE"


def test_dispensing_more_than_there_is_is_rejected() -> None:
    shelf = Watched(SHELF, holds={"box": 1})
    shelf.tell("dispense", object="box", value=2)
    assert shelf.why() == "Shelf is empty: it has 1 box, not 2."
    shelf.tell("dispense", "c2", object="box", value=1)
    shelf.wait(2)
    assert shelf.answers("c2")[-1] == "DONE"
    assert shelf.machine.stock == {"box": 1}, "a robot takes it away, dispensing does not"


@pytest.mark.parametrize("value", [0, -1, 1.5, "two"])
def test_a_quantity_that_is_none_is_rejected(value: object) -> None:
    shelf = Watched(SHELF)
    shelf.tell("dispense", object="box", value=value)
    assert shelf.answers() == ["REJECTED"]


def test_a_sink_tells_how_much_room_it_has() -> None:
    rollers = Watched(ROLLERS)
    assert rollers.machine.readings == {"freeSlots": 2}
    rollers.machine.change_stock(1.0, "box", 2)
    assert rollers.machine.readings == {"freeSlots": 0}
    assert rollers.machine.refusal_to_take("box", 1) == "Rollers is full: 2 of 2 places are taken."
    assert rollers.machine.refusal_to_take("can", 1) == "Rollers does not take can; it takes box."
    assert rollers.machine.wanted_stock() == {}


def test_a_source_is_full_at_the_start_and_wants_to_be_filled_when_empty() -> None:
    shelf = Watched(SHELF)
    assert shelf.machine.stock == {"box": 24}
    assert shelf.machine.wanted_stock() is None
    shelf.machine.set_stock(1.0, {"box": 0})
    assert shelf.machine.wanted_stock() == {"box": 24}
    assert first_stock(OVEN, shelf.machine.behaviour) == {}


def test_what_a_machine_shows_says_what_it_holds() -> None:
    assert Watched(SHELF, readings={"stock": 3}).machine.stock == {"box": 3}
    assert Watched(ROLLERS, readings={"freeSlots": 1}).machine.stock == {"box": 1}


def test_painting_uses_up_a_can() -> None:
    booth = replace(BENCH, methods=(replace(OVEN.methods[0], name="paint"),))
    machine = Watched(booth, holds={"can": 1, "box": 1})
    machine.tell("paint", time=1)
    machine.wait(60)
    assert machine.machine.stock == {"can": 0, "box": 1}


def test_a_counter_that_shows_a_wrong_value_goes_on_from_the_true_one() -> None:
    counting = replace(BENCH, properties=(*BENCH.properties, PropertySpec("cycles", "number")))
    wrong = Fault("bench", "wrong_value", for_s=20.0, name="cycles", value=1000)
    bench = Watched(counting, faults=(wrong,))
    bench.wait(1)
    bench.tell("weld", mode="slow")
    bench.wait(10)
    assert (bench.answers()[-1], bench.machine.readings["cycles"]) == ("DONE", 1000)
    bench.wait(20)
    assert bench.machine.readings["cycles"] == 1


def test_a_fault_makes_the_next_command_fail_and_only_that() -> None:
    bench = Watched(BENCH, faults=(Fault("bench", "fail_next"),))
    bench.tell("weld", "c1", mode="slow")
    bench.wait(2)
    bench.tell("weld", "c2", mode="slow")
    bench.wait(2)
    assert bench.answers("c1") == ["ACCEPTED", "RUNNING", "FAILED"]
    assert bench.answers("c2") == ["ACCEPTED", "RUNNING", "DONE"]


def test_a_lost_answer_is_lost_once() -> None:
    bench = Watched(BENCH, faults=(Fault("bench", "lose_ack"),))
    bench.tell("weld", mode="slow")
    bench.wait(2)
    assert bench.answers() == ["ACCEPTED", "RUNNING"]
    bench.tell("weld", mode="slow")
    assert bench.answers() == ["ACCEPTED", "RUNNING", "DONE"]


def test_an_offline_machine_is_silent_from_that_moment() -> None:
    bench = Watched(BENCH, faults=(Fault("bench", "offline", 1.0),))
    bench.tell("weld", mode="slow")
    bench.wait(5)
    bench.tell("weld", "c2", mode="slow")
    assert bench.answers() == ["ACCEPTED", "RUNNING"]
    assert bench.answers("c2") == []


@pytest.mark.parametrize("kind", ["offline", "dead"])
def test_an_answer_that_is_late_is_lost_where_nothing_is_said_any_more(kind: FaultKind) -> None:
    late, silent = Fault("bench", "late", after_s=3.0), Fault("bench", kind, 2.0, for_s=10.0)
    bench = Watched(BENCH, faults=(late, silent))
    bench.tell("cool", time=60)
    bench.wait(11.5)
    assert bench.answers() == []
    bench.wait(3)
    assert bench.answers() == []
    bench.tell("cool", time=60)
    bench.wait(3)
    assert bench.answers() == ["RUNNING"]


def test_a_stopped_machine_never_ends_its_work() -> None:
    bench = Watched(BENCH, faults=(Fault("bench", "stop", 1.0),))
    bench.tell("weld", mode="slow")
    bench.wait(500)
    assert bench.answers() == ["ACCEPTED", "RUNNING"]
    assert bench.machine.busy
