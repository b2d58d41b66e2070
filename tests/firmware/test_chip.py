"""main.py as on the board: the real MicroPython with 112 kB of heap, its hardware recorded, its display read."""

from __future__ import annotations

import itertools
import signal
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.firmware.hd44780 import Hd44780, texts
from tests.firmware.rig import (
    BLUE,
    GREEN,
    LIMIT_S,
    OUTPUT,
    PINS,
    RED,
    Chip,
    Running,
    configuration,
    flash,
    levels,
    listening,
    running_bus,
    running_chip,
)
from tests.kit.waiting import wait_for

LCD = 0x27


def line(text: str) -> str:
    return text.ljust(16)


@pytest.fixture
def board(micropython: str, tmp_path: Path) -> Iterator[tuple[Chip, Running]]:
    with running_bus("mosquitto", tmp_path) as bus, listening(bus) as ear:
        flash(tmp_path, configuration(bus, tmp_path, pins=PINS, boot_file="boot.txt"))
        with running_chip(micropython, tmp_path, {}) as chip:
            running = Running(ear, bus, chip.process, tmp_path / "console")
            running.state(lambda _state: True)
            yield chip, running


def test_the_display_says_what_the_paper_says_and_the_light_follows(board: tuple[Chip, Running]) -> None:
    chip, mixer = board
    online, complete = (line("VIPO online"), line(mixer.device)), (line("Mixing Complete"), line("1 min"))
    chip.wait(lambda record: texts(record)[-1:] == [online])  # a command at once is faster than an eye
    mixer.tell("mixPaint", "c1", time=1)
    mixer.answer("c1", "DONE")
    chip.wait(lambda record: texts(record)[-1:] == [complete] and levels(record, GREEN)[-1] == 1)
    record = chip.record
    shown = texts(record)
    assert shown.index((line("Mixing Started"), line("1 min"))) < shown.index(complete)
    assert [entry[2:] for entry in record if entry[1] == "i2c"] == [[0, 22, 21, 100000]]
    assert {entry[2] for entry in record if entry[1] == "write"} == {LCD}
    assert levels(record, BLUE)[-2:] == [1, 0]  # at work, then not
    assert (levels(record, RED)[-1], levels(record, OUTPUT)) == (0, [0, 1, 0])


def test_what_holds_the_work_switches_the_output_off(board: tuple[Chip, Running]) -> None:
    chip, mixer = board
    mixer.tell("mixPaint", "c1", time=30)
    chip.wait(lambda record: levels(record, OUTPUT)[-1:] == [1])
    mixer.tell("pause", "p1", command="c1")
    chip.wait(lambda record: levels(record, OUTPUT)[-1] == 0)
    assert [levels(chip.record, pin)[-1] for pin in (RED, GREEN, BLUE)] == [1, 1, 0]  # amber
    mixer.tell("resume", "p2", command="c1")
    chip.wait(lambda record: levels(record, OUTPUT)[-1] == 1)
    mixer.ear.say("vipo/v1/site/hall/stop", b"\xff not JSON")
    chip.wait(lambda record: levels(record, OUTPUT)[-1] == 0 and levels(record, RED)[-1] == 1)
    mixer.tell("cancel", "x1", command="c1")
    mixer.answer("c1", "CANCELED")
    assert levels(chip.record, OUTPUT) == [0, 1, 0, 1, 0]


def test_whatever_ends_the_program_the_output_is_off(board: tuple[Chip, Running]) -> None:
    chip, mixer = board
    mixer.tell("mixPaint", "c1", time=30)
    chip.wait(lambda record: levels(record, OUTPUT)[-1:] == [1])
    chip.process.send_signal(signal.SIGINT)
    chip.process.wait(LIMIT_S)
    assert levels(chip.record, OUTPUT) == [0, 1, 0]
    assert chip.record[-1][1] != "reset"  # Ctrl-C leaves the board to whoever works on it


def test_a_machine_without_a_connection_does_not_look_ready(board: tuple[Chip, Running]) -> None:
    chip, mixer = board
    mixer.tell("mixPaint", "c1", time=6)
    mixer.answer("c1", "RUNNING")
    mixer.bus.kill()
    chip.wait(lambda record: any(text[0] == line("Mixing Complete") for text in texts(record)))
    wait_for("the end of its work", lambda: levels(chip.record, BLUE)[-1] == 0)
    assert [levels(chip.record, pin)[-1] for pin in (RED, GREEN, BLUE)] == [1, 0, 0]
    mixer.bus.start()
    chip.wait(lambda record: [levels(record, pin)[-1] for pin in (RED, GREEN, BLUE)] == [0, 1, 0])


def test_the_watchdog_is_fed_while_the_device_works_and_only_once_it_does(board: tuple[Chip, Running]) -> None:
    chip, _ = board
    chip.wait(lambda record: sum(entry[1] == "fed" for entry in record) > 3)
    record = chip.record
    begun = next(index for index, entry in enumerate(record) if entry[1] == "watchdog")
    assert record[begun][2] == 60000
    assert not any(entry[1] == "fed" for entry in record[:begun])
    times = [record[begun][0], *(entry[0] for entry in record if entry[1] == "fed")]
    assert max(later - earlier for earlier, later in itertools.pairwise(times)) < 60e6


def test_an_lcd_that_is_unplugged_and_plugged_in_again(micropython: str, tmp_path: Path) -> None:
    unplugged = tmp_path / "unplugged"
    with running_bus("mosquitto", tmp_path) as bus, listening(bus) as ear:
        flash(tmp_path, configuration(bus, tmp_path, pins=PINS))
        with running_chip(micropython, tmp_path, {"VIPO_UNPLUGGED": str(unplugged)}) as chip:
            mixer = Running(ear, bus, chip.process, tmp_path / "console")
            mixer.state(lambda _state: True)
            unplugged.touch()
            mixer.tell("mixPaint", "c1", time=1)
            mixer.answer("c1", "DONE")
            assert "no LCD: " in chip.console
            unplugged.unlink()
            mixer.tell("dispense", "c2", object="can", value=1)
            mixer.answer("c2", "DONE")
            chip.wait(lambda record: texts(record)[-1:] == [(line("Ready"), line(""))])


def test_without_wifi_it_says_so_and_starts_again(micropython: str, tmp_path: Path) -> None:
    flash(tmp_path, {"host": "127.0.0.1", "port": 1, "id": "x", "password": "p", "pins": PINS})
    (tmp_path / "fast.py").write_text(
        "import vipo.chip as chip, vipo.wifi as wifi\nwifi.TIMEOUT_S, chip.SHOWN_S = 1, 0\nchip.run()\n"
    )
    with running_chip(micropython, tmp_path, {"VIPO_WIFI": "another"}, main=tmp_path / "fast.py") as chip:
        assert chip.process.wait(LIMIT_S) == 7
        assert texts(chip.record)[-1] == (line("No Wi-Fi"), line("hall"))
        assert ["join", "hall", "warm paint"] in [entry[1:] for entry in chip.record]
        assert chip.record[-1][1] == "reset"


INIT = """
import machine, sys
from vipo.lcd import Lcd
lcd = Lcd(machine.I2C(0, machine.Pin(22), machine.Pin(21), 100000))
lcd.begin()
lcd.write(0, "Mixing Started  ")
lcd.write(1, "}{~ \\\\ \\xe4 \\x00 0-9!  ")
"""


def test_the_display_is_set_up_however_it_was_left(micropython: str, tmp_path: Path) -> None:
    (tmp_path / "init.py").write_text(INIT)
    with running_chip(micropython, tmp_path, {"VIPO_I2C": "80 39"}, main=tmp_path / "init.py") as chip:
        assert chip.process.wait(LIMIT_S) == 0, chip.console
        record = chip.record
    for bits, half in ((8, None), (4, None), *((4, half) for half in range(16))):
        assert texts(record, LCD, Hd44780(bits, half))[-1] == ("Mixing Started  ", "}{? ? ? ? 0-9!  ")
    too_fast = [[entry[0] * 0.2, *entry[1:]] for entry in record]
    with pytest.raises(AssertionError, match="came too early"):
        texts(too_fast, LCD)


def test_a_single_led_blinks_in_rhythms(micropython: str, tmp_path: Path) -> None:
    with running_bus("mosquitto", tmp_path) as bus, listening(bus) as ear:
        flash(tmp_path, configuration(bus, tmp_path, pins={"led": 2, "inverted": True}))
        with running_chip(micropython, tmp_path, {}) as chip:
            mixer = Running(ear, bus, chip.process, tmp_path / "console")
            mixer.state(lambda _state: True)
            wait_for("the steady light of ready, which is lit when low", lambda: levels(chip.record, 2)[-1] == 0)
            mixer.ear.say("vipo/v1/site/hall/stop", {"active": True})
            chip.wait(lambda record: levels(record, 2)[-4:] in ([0, 1, 0, 1], [1, 0, 1, 0]))


def test_a_fault_is_shown_and_the_board_starts_again(micropython: str, tmp_path: Path) -> None:
    flash(
        tmp_path, {"host": "127.0.0.1", "port": 1, "id": "x", "password": "p", "pins": PINS, "description": "gone.ttl"}
    )
    (tmp_path / "fast.py").write_text("import vipo.chip as chip\nchip.SHOWN_S = 0\nchip.run()\n")
    with running_chip(micropython, tmp_path, {}, main=tmp_path / "fast.py") as chip:
        assert chip.process.wait(LIMIT_S) == 7
        assert "There is no description file gone.ttl." in chip.console
        assert texts(chip.record)[-1] == (line("Fault"), "There is no desc")
        assert chip.record[-1][1] == "reset"


def come_back(mixer: Running, told: int) -> int:
    """Wait for a state that is newer than the `told`-th, and return its number."""
    sequence: int = mixer.state(lambda state: state["seq"] > told)["seq"]
    return sequence


def test_a_board_that_says_much_of_itself_comes_in_over_tls_each_time(micropython: str, tmp_path: Path) -> None:
    with running_bus("mosquitto with TLS", tmp_path) as bus, listening(bus) as ear:
        flash(tmp_path, configuration(bus, tmp_path, pins=PINS, name="n" * 100, about="a" * 300))
        with running_chip(micropython, tmp_path, {}) as chip:
            mixer = Running(ear, bus, chip.process, tmp_path / "console")
            told = mixer.state(lambda _state: True)["seq"]
            for _ in range(2):
                bus.kill()
                bus.start()
                told = come_back(mixer, told)
            assert "memory" not in chip.console
            assert chip.console.count("VIPO online") == 3


def test_the_time_is_asked_for_until_it_comes(micropython: str, tmp_path: Path) -> None:
    """A certificate is dated: a factory whose time server starts after its boards has to get them back."""
    came = tmp_path / "came"
    (tmp_path / "late.py").write_text(
        "import vipo.portable as portable\nportable.CLOCK_IS_SET_S = 1 << 40\nimport vipo.chip as chip\nchip.run()\n"
    )
    with running_bus("mosquitto with TLS", tmp_path) as bus, listening(bus) as ear:
        flash(tmp_path, configuration(bus, tmp_path, pins=PINS, time_server="clock.hall"))
        with running_chip(micropython, tmp_path, {"VIPO_TIME": str(came)}, main=tmp_path / "late.py") as chip:
            wait_for("its question for the time", lambda: "no time yet" in chip.console)
            assert "no time from clock.hall: " in chip.console
            assert not ear.heard
            came.touch()
            Running(ear, bus, chip.process, tmp_path / "console").state(lambda _state: True)
            assert sum(entry[1] == "time" for entry in chip.record) == chip.console.count("no time from") + 1


def test_a_board_whose_heap_stays_too_full_to_connect_starts_again(micropython: str, tmp_path: Path) -> None:
    (tmp_path / "full.py").write_text(
        "import vipo.mqtt as mqtt, vipo.chip as chip\n"
        "async def full(client):\n    raise MemoryError\n"
        "mqtt.open_stream, mqtt.LONGEST_BACK_OFF_S, chip.SHOWN_S = full, 0.01, 0\nchip.run()\n"
    )
    with running_bus("mosquitto", tmp_path) as bus:
        flash(tmp_path, configuration(bus, tmp_path, pins=PINS))
        with running_chip(micropython, tmp_path, {}, main=tmp_path / "full.py") as chip:
            assert chip.process.wait(LIMIT_S) == 7
            assert chip.record[-1][1] == "reset"
            assert "|Fault" in chip.console


def test_a_board_whose_heap_is_too_full_to_end_a_command_starts_again_and_answers_for_it(
    micropython: str, tmp_path: Path
) -> None:
    (tmp_path / "full.py").write_text(
        "import vipo.duties as duties, vipo.chip as chip\n"
        "make_answer = duties.make_answer\n"
        "def full(command, status, *more):\n"
        "    if status == 'DONE':\n        raise MemoryError\n"
        "    return make_answer(command, status, *more)\n"
        "duties.make_answer, chip.SHOWN_S = full, 0\nchip.run()\n"
    )
    with running_bus("mosquitto", tmp_path) as bus, listening(bus) as ear:
        flash(tmp_path, configuration(bus, tmp_path, pins=PINS))
        with running_chip(micropython, tmp_path, {}, main=tmp_path / "full.py") as chip:
            mixer = Running(ear, bus, chip.process, tmp_path / "console")
            told = mixer.state(lambda _state: True)["boot"]
            mixer.tell("mixPaint", "c1", time=1)
            assert chip.process.wait(LIMIT_S) == 7
            assert (chip.record[-1][1], "|Fault" in chip.console) == ("reset", True)
        with running_chip(micropython, tmp_path, {}) as chip:
            mixer = Running(ear, bus, chip.process, tmp_path / "console")
            assert mixer.state(lambda state: state["boot"] > told)["done"]
            mixer.tell("mixPaint", "c1", time=1)
            mixer.answer("c1", "DONE")
            assert mixer.answers("c1") == ["ACCEPTED", "RUNNING", "DONE"], "it is not done twice"


def test_a_board_whose_heap_is_too_full_to_accept_a_command_ends_it_all_the_same(
    micropython: str, tmp_path: Path
) -> None:
    (tmp_path / "full.py").write_text(
        "import vipo.duties as duties, vipo.chip as chip\n"
        "make_answer = duties.make_answer\n"
        "def full(command, status, *more):\n"
        "    if status == 'ACCEPTED':\n        raise MemoryError\n"
        "    return make_answer(command, status, *more)\n"
        "duties.make_answer = full\nchip.run()\n"
    )
    with running_bus("mosquitto", tmp_path) as bus, listening(bus) as ear:
        flash(tmp_path, configuration(bus, tmp_path, pins=PINS))
        with running_chip(micropython, tmp_path, {}, main=tmp_path / "full.py") as chip:
            mixer = Running(ear, bus, chip.process, tmp_path / "console")
            mixer.state(lambda _state: True)
            mixer.tell("mixPaint", "c1", time=1)
            mixer.answer("c1", "DONE")
            assert mixer.state(lambda state: state["done"] and state["seq"] > 2)["cmd"] == ""
