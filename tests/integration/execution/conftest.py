"""The painting factory in the database, its devices answered by the kinematic world instead of MQTT."""

import time
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from uuid import uuid4

import pytest

from editor.language import plan_to_json
from execution import database, services
from execution.engine.drive import advance_site
from execution.models import Command, FloorState, InboxEvent, Run, Timer
from execution.ticker.ticker import fire_timers
from registry import services as registry
from registry.demo.factory import make_grid, read_plan
from registry.models import Device
from registry.sites.views import PlaceView
from simulation.services import make_world
from simulation.world import Ack, PropertyChanged, Scene
from tests.kit import demo_floor
from vipo_device.descriptions.reader import hash_of_json
from vipo_device.protocol.description import description_to_json

SITE = "painting-factory"
DEVICES = [replace(d, speed_m_s=2.0) if d.kind == "robot" else d for d in demo_floor.devices()]
"""The demo's devices, with robots that drive fast, so that the tests are quick."""


@pytest.fixture
def factory(db):
    registry.create_site(name="Painting Factory", slug=SITE)
    registry.save_map(site=SITE, grid=make_grid(read_plan()), source="test")
    places = [PlaceView(p.id, p.name, p.kind, p.x, p.y, p.theta) for p in demo_floor.places()]
    registry.save_places(site=SITE, places=places)
    site = FloorState._meta.get_field("site").related_model.objects.get(slug=SITE)
    for device in DEVICES:
        said = description_to_json(device)
        Device.objects.create(
            id=device.id,
            site=site,
            lifecycle="approved",
            description=said,
            description_hash=hash_of_json(said),
            online=True,
        )
    return Shop()


class Shop:
    """Drives everything by hand, in virtual time: workers, ticker, gateway and devices."""

    def __init__(self):
        self.world = make_world(scene=Scene(demo_floor.grid(), DEVICES, seed=1), driver="kinematic")
        self.offline = set()
        self.deliveries = 1

    def start(self, plan, **parameters):
        prepared = services.Prepared(uuid4(), SITE, "Task", 1, {}, {}, plan_to_json(plan), parameters)
        return str(services.start_run(prepared=prepared, by="Ada").id)

    def work(self):
        """What a worker does with hints: everything that waits is taken in."""
        for _ in range(100):
            waits = InboxEvent.objects.filter(taken_at=None).exists()
            pending = Run.objects.filter(status="pending").exclude(not_before__gt=datetime.now(UTC)).exists()
            if not waits and not pending:
                return
            assert advance_site(SITE)
        raise AssertionError("the inboxes never run empty")

    def work_once(self):
        """What a worker does in a moment: what is held back for a device's next word stays."""
        assert advance_site(SITE)

    def send(self):
        """What the gateway does: commands to devices, each as often as `deliveries` says."""
        Command.objects.filter(status="sent").update(send_after=datetime.now(UTC))
        commands = services.claim_commands(limit=100)
        for outgoing in commands:
            row = Command.objects.get(id=outgoing.id)
            if row.device not in self.offline:
                for _ in range(self.deliveries):
                    self.world.command(row.device, row.method, row.arguments, outgoing.id)
        services.mark_sent(sent={c.id: database.now() for c in commands})
        return commands

    def pass_time(self, seconds):
        """Let the devices work, and report what they say."""
        for event in self.world.advance(seconds):
            if isinstance(event, Ack):
                for _ in range(self.deliveries):
                    services.record_ack(device=event.device, command_id=event.command, status=event.status,
                                        why=event.why, result=event.result, at=datetime.now(UTC))  # fmt: skip
            elif isinstance(event, PropertyChanged):
                device = Device.objects.get(id=event.device)
                device.properties[event.name] = event.value
                device.save(update_fields=["properties"])
        for name, robot in self.world.robots().items():
            pose = {"x": robot.pose.x, "y": robot.pose.y, "z": 0.0, "theta": robot.pose.theta}
            Device.objects.filter(id=name).update(pose=pose)
        Timer.objects.update(due_at=_earlier(seconds))
        fire_timers(datetime.now(UTC))

    def go(self, until, limit_s=600.0, dt_s=0.5):
        """Go on until a condition holds."""
        begun = time.monotonic()
        while not until():
            assert limit_s > 0, f"not reached: {list(Run.objects.values('status', 'reason', 'steps'))}"
            assert time.monotonic() - begun < 300
            self.work()
            self.send()
            self.pass_time(dt_s)
            if FloorState.objects.filter(active=True).exists():
                advance_site(SITE)
            self.work()
            limit_s -= dt_s


def _earlier(seconds):
    from django.db.models import F

    return F("due_at") - timedelta(seconds=seconds)
