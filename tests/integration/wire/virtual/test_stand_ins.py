"""Stand-ins beside a device that somebody else might have written, on both brokers: one of the two is told."""

from __future__ import annotations

import json
import subprocess
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import pytest
from django.conf import LazySettings

from execution.commands.manual_calls import call_method
from execution.errors import NotPossibleNow
from execution.models import Command, Lease
from execution.stand_ins.stand_ins import StandIns
from execution.stand_ins.switches import simulate_device
from registry import services
from registry.demo.devices import DEVICES
from registry.models import Device
from tests.integration.wire.bus import SERVER_WORD, SITE, Bus
from tests.integration.wire.virtual.mixer import A_MINUTE_S, MIXER, Mixer, is_over, tell
from tests.kit.files import describe_mixer
from tests.kit.mqtt import Ear
from tests.kit.waiting import wait_for
from vipo_device.protocol.credentials import own_key
from vipo_device.protocol.topics import STAND_IN_FILTERS, STAND_INS

pytestmark = pytest.mark.servers


@contextmanager
def playing(settings: LazySettings) -> Iterator[StandIns]:
    """Run a process of stand-ins that lets a minute pass in a second, as the mixer does."""
    made, stopping = StandIns(settings, speed=60 / A_MINUTE_S), threading.Event()
    thread = threading.Thread(target=made.run_forever, args=(stopping,))
    thread.start()
    try:
        yield made
    finally:
        stopping.set()
        thread.join(20)


@pytest.fixture
def stand_ins(bus: Bus, mixer: Mixer, settings: LazySettings, tmp_path: Path) -> Iterator[StandIns]:
    settings.VIPO_STATE_DIR = tmp_path
    wait_for("the account", lambda: bus.lets_in(STAND_INS, own_key(STAND_INS, SERVER_WORD)))
    with playing(settings) as made:
        yield made


def switch(simulated: bool) -> None:
    simulate_device(site=SITE, device_id=MIXER, simulated=simulated, by=None)
    wait_for("who speaks now", lambda: services.get_device(site=SITE, device_id=MIXER).online)


def call() -> Command:
    """Let the mixer mix for a minute by hand, and return what came of it."""
    made = call_method(site=SITE, device_id=MIXER, method="mixPaint", arguments={"time": 1}, by="Ada")
    wait_for("the end", lambda: Command.objects.get(pk=made.id).ended_at)
    return Command.objects.get(pk=made.id)


def test_the_stand_in_does_what_the_device_is_told_until_it_is_switched_back(mixer: Mixer, stand_ins: StandIns) -> None:
    switch(simulated=True)
    done = call()
    assert (done.status, done.stand_in, mixer.heard) == ("done", True, 0)
    switch(simulated=False)
    done = call()
    assert (done.status, done.stand_in, mixer.heard) == ("done", False, 1)


def test_what_the_device_itself_says_waits_until_it_counts_again(mixer: Mixer, stand_ins: StandIns) -> None:
    switch(simulated=True)
    mixer.client.publish(f"vipo/v1/dev/{MIXER}/up/state", b'{"boot": 1, "seq": 9, "done": false}')
    row = wait_for("what it said", lambda: Device.objects.filter(pk=MIXER, aside__seq=9).first())
    assert (row.done, row.online, services.get_device(site=SITE, device_id=MIXER).status) == (True, True, "idle")
    switch(simulated=False)
    view = services.get_device(site=SITE, device_id=MIXER)
    assert (view.done, view.status, view.stand_in) == (False, "busy", False)
    assert Device.objects.get(pk=MIXER).aside is None


def test_a_device_that_works_is_not_switched(mixer: Mixer, stand_ins: StandIns) -> None:
    mixer.pace = 3
    made = call_method(site=SITE, device_id=MIXER, method="mixPaint", arguments={"time": 1}, by="Ada")
    with pytest.raises(NotPossibleNow, match="still carries out mixPaint"):
        simulate_device(site=SITE, device_id=MIXER, simulated=True, by=None)
    wait_for("the end", lambda: Command.objects.get(pk=made.id).status == "done")
    simulate_device(site=SITE, device_id=MIXER, simulated=True, by=None)


def test_another_process_takes_over_from_one_that_is_gone(
    mixer: Mixer, stand_ins: StandIns, settings: LazySettings
) -> None:
    switch(simulated=True)
    first = Device.objects.get(pk=MIXER).boot
    with playing(settings) as second:
        time.sleep(1.5)
        assert not second._playing, "one plays"
        Lease.objects.filter(name="stand-ins").update(holder=second._lease._holder)  # as after the first was frozen
        wait_for("the second", lambda: second._playing and not stand_ins._playing, 20)
        wait_for("its first word", lambda: Device.objects.get(pk=MIXER).boot > first)
        assert (call().status, mixer.heard) == ("done", 0)


def test_the_account_speaks_for_stand_ins_alone(bus: Bus, mixer: Mixer, stand_ins: StandIns) -> None:
    switch(simulated=True)
    account, heard = bus.client(STAND_INS, own_key(STAND_INS, SERVER_WORD)), []
    for topic in (
        *STAND_IN_FILTERS,
        "vipo/v1/dev/+/up/state",
        "vipo/v1/dev/+/down/+",
        "vipo/v1/join/+/+",
        "$CONTROL/#",
    ):
        account.subscribe(topic, 1, lambda topic, *_: heard.append(topic))
    account.start()
    wait_for("the account", lambda: account.connected)
    with Ear(bus.server_port, SERVER_WORD, "vipo/#") as ear:
        account.publish(f"vipo/v1/dev/{MIXER}/up/ack", b'{"id": "forged", "st": "DONE"}')
        account.publish(f"vipo/v1/dev/{MIXER}/down/mixPaint", b'{"id": "forged", "v": {"time": 1}, "ttl_s": 60}')
        account.publish(f"vipo/v1/site/{SITE}/stop", b'{"active": true}', retain=True)
        account.publish(f"vipo/v1/sim/{MIXER}/up/desc", b"not its business")
        assert call().status == "done"
        said = {(each.topic, b"forged" in each.payload) for each in ear.heard if not each.retained}
        assert (f"vipo/v1/sim/{MIXER}/up/ack", False) in said
        assert not any(is_forged or topic.endswith(("/stop", f"sim/{MIXER}/up/desc")) for topic, is_forged in said)
    account.stop()
    assert mixer.heard == 0
    assert not any("/up/state" in topic or "credential" in topic for topic in heard)
    assert not bus.lets_in(STAND_INS, SERVER_WORD)


def test_no_device_speaks_for_a_stand_in(bus: Bus, mixer: Mixer, stand_ins: StandIns) -> None:
    switch(simulated=True)
    mixer.client.publish(f"vipo/v1/sim/{MIXER}/up/state", b'{"boot": 9999999999, "seq": 1, "done": false}')
    mixer.client.subscribe(f"vipo/v1/sim/{MIXER}/down/mixPaint", 1, mixer._told)
    assert call().status == "done"
    assert (mixer.heard, Device.objects.get(pk=MIXER).boot < 9999999999) == (0, True)


def test_one_that_is_switched_back_and_on_within_a_moment_begins_anew(mixer: Mixer, stand_ins: StandIns) -> None:
    switch(simulated=True)
    first, played = Device.objects.get(pk=MIXER).boot, stand_ins._playing[MIXER]
    simulate_device(site=SITE, device_id=MIXER, simulated=False, by=None)
    simulate_device(site=SITE, device_id=MIXER, simulated=True, by=None)
    wait_for("the new one", lambda: stand_ins._playing.get(MIXER, played) is not played)
    wait_for("its word", lambda: Device.objects.get(pk=MIXER).online)
    assert Device.objects.get(pk=MIXER).boot >= first
    assert (call().status, mixer.heard) == ("done", 0)


def test_what_goes_wrong_with_one_ends_no_other(mixer: Mixer, stand_ins: StandIns) -> None:
    """Where its file belongs is a folder: it can keep no answer, and so gives none."""
    join("paintMixer09", describe_mixer("paintMixer09"))
    (stand_ins._folder / "paintMixer09.json").mkdir()
    switch(simulated=True)
    simulate_device(site=SITE, device_id="paintMixer09", simulated=True, by=None)
    wait_for("both", lambda: services.get_device(site=SITE, device_id="paintMixer09").online)
    broken = tell(to="paintMixer09", stand_in=True, time=1)
    wait_for("the one that is given up", lambda: "paintMixer09" in stand_ins._given_up)
    assert call().status == "done"
    assert not is_over(broken)


def test_a_simulated_store_learns_what_a_real_robot_takes(bus: Bus, mixer: Mixer, stand_ins: StandIns) -> None:
    """The robot speaks by Mosquitto's own clients: it hears one command, and answers it."""
    join("itemInventory01", (DEVICES / "itemInventory01.ttl").read_bytes())
    join("robot01", (DEVICES / "robot01.ttl").read_bytes(), key="the-key-of-the-robot-0001")
    simulate_device(site=SITE, device_id="itemInventory01", simulated=True, by=None)
    wait_for("the store", lambda: services.get_device(site=SITE, device_id="itemInventory01").readings.get("stock"))
    before = stock()
    who = ("-h", "127.0.0.1", "-p", str(bus.device_port), "-u", "robot01", "-i", "robot01")
    who = (*who, "-P", "the-key-of-the-robot-0001", "-V", "mqttv311", "-q", "1")
    command = tell("pick", to="robot01", device="itemInventory01", object="box", value=2)
    heard = subprocess.run(
        ["mosquitto_sub", *who, "-t", "vipo/v1/dev/robot01/down/pick", "-C", "1", "-W", "30"],
        capture_output=True, check=True, timeout=40,
    )  # fmt: skip
    assert json.loads(heard.stdout)["id"] == str(command)
    for _ in range(2):  # it says so twice
        answer = json.dumps({"id": str(command), "st": "DONE"})
        said = ["mosquitto_pub", *who, "-t", "vipo/v1/dev/robot01/up/ack", "-m", answer]
        subprocess.run(said, check=True, timeout=20)
    wait_for("what is left", lambda: stock() == before - 2)
    time.sleep(1)
    assert stock() == before - 2


def stock() -> Any:
    return services.get_device(site=SITE, device_id="itemInventory01").readings["stock"]


def join(device: str, text: bytes, key: str = "the-key-of-a-device-00001") -> None:
    """Let a device take part that has described itself once."""
    at = datetime.now(UTC)
    services.enrol_device(site=SITE, device_id=device, payload=json.dumps({"key": key}).encode(), at=at)
    services.ingest_description(device_id=device, payload=text, at=at)
    services.approve_device(site=SITE, device_id=device, by=None, at=at)
