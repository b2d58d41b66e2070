"""VIPO's own MTConnect agent, asked over HTTP by VIPO's own connector: each holds the other to the standard."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from queue import Queue
from threading import Event, Thread
from typing import Any

import pytest
from django.utils import timezone

from connectors.mtconnect.agent import Agent, AgentAway, read_address
from connectors.mtconnect.condition import MachineCondition
from connectors.mtconnect.description import Stand, describe_machine, device_id
from connectors.mtconnect.follower import AgentEvent, Follower, MachinesListed, Observed
from registry import services
from registry.devices import samples
from registry.devices.samples import SampleBuffer
from registry.models import Device
from tests.integration.registry.conftest import hall
from tests.kit.sign_in import signed_in
from tests.kit.sites import MIXER, come, describe, say
from vipo_device.protocol.description import Pose, PropertySpec, Size

__all__ = ["hall"]
PROPERTIES = (PropertySpec("width", "number", "M"), PropertySpec("lid", "text"), PropertySpec("error", "text"))


@pytest.fixture
def told(hall: str, live_server: Any, monkeypatch: pytest.MonkeyPatch) -> Iterator[Queue[AgentEvent]]:
    """Follow the site's agent as its viewer; gives what is heard."""
    monkeypatch.setattr(samples, "_buffer", SampleBuffer())
    describe(replace(MIXER, properties=PROPERTIES))
    Device.objects.update(lifecycle="approved")
    come(at=timezone.now())
    tell(1, width=1.5, lid="shut", error="")
    cookie = f"Cookie: sessionid={signed_in('viewer').cookies['sessionid'].value}"
    queue: Queue[AgentEvent] = Queue()
    stopping = Event()
    address = read_address(f"{live_server.url}/api/sites/hall/mtconnect", headers=cookie)
    thread = Thread(target=Follower(Agent(address), 0.1, queue.put).run, args=(stopping,))
    thread.start()
    yield queue
    stopping.set()
    thread.join(30)


def tell(seq: int, *, done: bool = True, **readings: Any) -> None:
    now = timezone.now()
    say(at=now, seq=seq, done=done, props=readings)
    services.flush_samples(all_of_it=True)


@pytest.mark.django_db(transaction=True)
def test_a_device_of_one_site_can_be_a_machine_of_another(told: Queue[AgentEvent]) -> None:
    probed = told.get(timeout=60)
    assert isinstance(probed, MachinesListed)
    (machine,) = probed.machines
    described = describe_machine(machine, "other", Stand(Pose(0, 0), Size(1, 1, 1)), device_id(machine.uuid))
    assert (machine.uuid, machine.name) == ("urn:vipo:device:mixer1", "mixer1")
    assert [(p.name, p.type, p.unit) for p in described.description.properties[3:]] == [
        ("width", "number", "M"),
        ("lid", "text", ""),
    ]
    condition = MachineCondition(described)

    def wait(**wanted: Any) -> None:
        while True:
            state = condition.look(1, 1)
            now = {**state.properties, "done": state.done}
            if all(now[name] == value for name, value in wanted.items()):
                return
            heard = told.get(timeout=60)
            assert isinstance(heard, Observed)
            condition.take(heard.observations)

    wait(width=1.5, lid="shut", error="", execution="READY")
    tell(2, done=False, width=2.25, lid="open", error="Lid open")
    wait(width=2.25, lid="open", error="Lid open", execution="ACTIVE", done=False)
    tell(3, width=2.25, lid="shut", error="")
    wait(lid="shut", error="", execution="READY", done=True)


@pytest.mark.django_db(transaction=True)
def test_who_is_not_signed_in_is_told_so(hall: str, live_server: Any) -> None:
    with pytest.raises(AgentAway, match=r"answers with application/problem\+json \(status 401\)"):
        Agent(read_address(f"{live_server.url}/api/sites/hall/mtconnect")).ask("probe")
