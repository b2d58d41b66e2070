"""The process that plays the devices which are simulated at the moment, of all sites.

Any number may run: whoever holds the lease plays, and another takes over 5 s after it died, with the next start of each
device. It speaks for stand-ins alone (the broker lets its account do no more), and hears what real robots fetch from
machines and bring to them, so that a simulated machine holds what it would hold.
"""

from __future__ import annotations

import logging
import secrets
import threading
import time
from collections import OrderedDict
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from queue import Empty, SimpleQueue
from typing import Any

from django.db import DatabaseError, InterfaceError, close_old_connections

from execution import database
from execution.lease import HeldLease
from registry import services as registry
from registry.services import Outage
from simulation.services import make_world
from simulation.stand_ins.line import Line
from simulation.stand_ins.stand_in import HandOver, StandIn, StandInFacts, hand_over_of, stock_for
from simulation.world import Scene, World
from vipo_device.protocol.credentials import stand_ins_key
from vipo_device.protocol.errors import VipoError
from vipo_device.protocol.messages import parse_ack, read_command
from vipo_device.protocol.mqtt_client import MqttClient
from vipo_device.protocol.topics import STAND_IN_FILTERS, STAND_INS

log = logging.getLogger(__name__)
LOOK_EVERY_S = 1.0
LEASE_EVERY_S = 0.5
SITE_EVERY_S = 5.0
REST_S, TICK_S = 0.2, 0.05
MOST_AT_ONCE = 500
MOST_WAITING = 20_000
MOST_ORDERS = 2_000
GIVEN_UP = "The stand-in of %s is given up and begins anew."


class StandIns:
    """One such process; the embedded mode runs it in a thread, `manage.py stand_ins` by itself."""

    def __init__(self, settings: Any, heart: registry.Heart | None = None, *, speed: float = 1.0) -> None:
        broker: Mapping[str, Any] = settings.VIPO_MQTT
        own = {**broker, "username": STAND_INS, "password": stand_ins_key(str(broker["password"]))}
        name = f"stand-ins-{secrets.token_hex(6)}"
        self._client = MqttClient.from_settings(own, client_id=name)
        self._folder = Path(settings.VIPO_STATE_DIR) / "stand-ins"
        self._heart, self._speed = heart, speed
        self._lease = HeldLease("stand-ins", name)
        self._inbox: SimpleQueue[tuple[str, bytes, bool]] = SimpleQueue()
        self._new_line = threading.Event()
        self._playing: dict[str, tuple[StandIn, Line]] = {}
        self._orders: OrderedDict[str, tuple[str, HandOver]] = OrderedDict()
        self._held: dict[str, bytes] = {}
        self._looked_at = self._sites_at = self._asked_at = float("-inf")
        self._machines: dict[str, dict[str, registry.DeviceView]] = {}
        self._outage = Outage("The database", "Devices that are simulated begin and end nothing new.")

    def run_forever(self, stopping: threading.Event) -> None:
        """Serve until `stopping` is set."""
        self._folder.mkdir(parents=True, exist_ok=True)
        for topic in STAND_IN_FILTERS:
            self._client.subscribe(topic, 1, self._arrived)
        self._client.on_connected(self._new_line.set)
        self._client.start()
        try:
            while not stopping.is_set():
                if self._heart is not None:
                    self._heart.beat("works" if self._client.connected else "broker_away")
                try:
                    self._turn(stopping)
                    self._outage.end()
                except (DatabaseError, InterfaceError) as error:
                    self._outage.begin(error)
                    close_old_connections()
                    stopping.wait(1.0)
        finally:
            for stand_in, _ in self._playing.values():
                stand_in.leave()
            self._client.stop()
            close_old_connections()

    def _arrived(self, topic: str, payload: bytes, retained: bool) -> None:
        """Keep a message; on the network's thread."""
        if self._inbox.qsize() < MOST_WAITING:
            self._inbox.put((topic, payload, retained))

    def _turn(self, stopping: threading.Event) -> None:
        now = time.monotonic()
        if now - self._asked_at >= LEASE_EVERY_S:  # a process that was frozen asks first, before it says anything
            if not self._lease.hold(database.now()):
                self._give_way()
                stopping.wait(LOOK_EVERY_S)
                return
            self._asked_at = now
        if now - self._looked_at >= LOOK_EVERY_S:
            self._looked_at = now
            self._look(now)
        messages = self._take_in()
        now = time.monotonic()
        for name in list(self._playing):  # before what has come is begun: it takes its whole time from here on
            self._advance(name, now)
        if self._new_line.is_set():
            self._new_line.clear()
            for _, line in self._playing.values():
                line.say_connected()
        for message in messages:
            self._hear(*message)

    def _give_way(self) -> None:
        """Another process plays: say no more, and forget what was told meanwhile."""
        for stand_in, _ in self._playing.values():
            stand_in.close()
        self._playing.clear()
        self._take_in()
        self._looked_at = float("-inf")

    def _take_in(self) -> list[tuple[str, bytes, bool]]:
        """Wait for a message for a moment, and return all that have come."""
        is_busy = any(stand_in.is_busy for stand_in, _ in self._playing.values())
        rest_s = REST_S if self._playing else LOOK_EVERY_S
        messages: list[tuple[str, bytes, bool]] = []
        try:
            messages.append(self._inbox.get(timeout=TICK_S if is_busy else rest_s))
            while len(messages) < MOST_AT_ONCE:
                messages.append(self._inbox.get_nowait())
        except Empty:
            pass
        return messages

    def _hear(self, topic: str, payload: bytes, retained: bool) -> None:
        parts = topic.split("/")
        if parts[2:3] == ["dev"]:
            if self._playing:
                self._hear_real(parts[3], parts[5], payload)
            return
        if parts[2:3] == ["site"]:
            self._held[topic] = payload  # a stand-in that begins later hears it, too
        name = parts[3] if parts[2:3] == ["sim"] else ""
        playing = [self._playing[name]] if name in self._playing else list(self._playing.values())
        for stand_in, line in playing:
            if name in ("", stand_in.id):
                try:
                    self._share_stock(stand_in, parts[5] if name else "", payload)
                    line.hear(topic, payload, retained=retained)
                except (DatabaseError, InterfaceError):
                    raise
                except Exception:  # one device's message must not end the stand-ins of all others
                    log.exception(GIVEN_UP, stand_in.id)
                    self._playing.pop(stand_in.id)[0].close()

    def _hear_real(self, device: str, kind: str, payload: bytes) -> None:
        """Note what a real robot fetches from a machine or brings to it, once it has said that it has done so."""
        try:
            if kind != "ack":
                command = read_command(kind, payload)
                goods = hand_over_of(kind, command.arguments) if command is not None else None
                if command is not None and goods is not None:
                    self._orders[command.id] = (device, goods)
                    if len(self._orders) > MOST_ORDERS:
                        self._orders.popitem(last=False)
                return
            ack = parse_ack(payload)
        except VipoError as error:
            log.debug("What %s said is not understood: %s", device, error.detail)
            return
        robot, goods = self._orders.get(ack.command, ("", None))
        if goods is not None and robot == device and ack.is_final:
            del self._orders[ack.command]
            if ack.status == "DONE":
                self._hand_over(goods)

    def _hand_over(self, goods: HandOver) -> None:
        playing = self._playing.get(goods.machine)
        if playing is not None and playing[0].stock is not None:
            playing[0].take_over(goods)

    def _share_stock(self, robot: StandIn, method: str, payload: bytes) -> None:
        """Tell a robot what the machine holds at which it is to fetch or leave something."""
        command = read_command(method, payload) if method in {"pick", "drop"} else None
        goods = hand_over_of(method, command.arguments) if command is not None else None
        if goods is None:
            return
        other = self._playing.get(goods.machine)
        stock = other[0].stock if other is not None else None
        machine = self._machines.get(robot.facts.site, {}).get(goods.machine)
        if stock is None and machine is not None:
            said = registry.get_readings(site=robot.facts.site, ids=[goods.machine]).get(goods.machine)
            stock = stock_for(machine.canonical, said.values if said else {}, goods)
        if stock is not None:
            robot.see_stock(goods.machine, stock)

    def _advance(self, name: str, now: float) -> None:
        stand_in, _ = self._playing[name]
        try:
            for goods in stand_in.advance(now):
                self._hand_over(goods)
        except (DatabaseError, InterfaceError):
            raise
        except Exception:  # one device's stand-in must not end those of all others
            log.exception(GIVEN_UP, name)
            self._playing.pop(name)[0].close()

    def _look(self, now: float) -> None:
        """Begin to play what people have switched, and end what they have switched back."""
        wanted = {each.device.id: each for each in registry.list_stand_ins()}
        for name in self._playing.keys() - wanted.keys():
            self._playing.pop(name)[0].leave()
        new = [each for name, each in wanted.items() if name not in self._playing]
        sites = {each.device.site for each in wanted.values()}
        if now - self._sites_at >= SITE_EVERY_S or {each.device.site for each in new} - self._machines.keys():
            self._sites_at = now
            self._machines = {site: _machines_of(site) for site in sites}
        for each in new:
            self._begin(each, now)
        for name, (stand_in, _) in self._playing.items():
            facts = self._facts(wanted[name])
            if not stand_in.is_busy and not stand_in.facts.is_like(facts):
                stand_in.change(facts)

    def _begin(self, each: registry.StandInView, now: float) -> None:
        line = Line(self._client)
        memory = self._folder / f"{each.device.id}.json"
        stand_in = StandIn(self._facts(each), line, _make_world, memory, self._speed)
        self._playing[each.device.id] = (stand_in, line)
        stand_in.connect(now)
        for topic, payload in self._held.items():
            line.hear(topic, payload, retained=True)

    def _facts(self, each: registry.StandInView) -> StandInFacts:
        """Return the device as its stand-in begins; the clock keeps its starts apart from those of another time."""
        view = each.device
        machines = [
            replace(machine.canonical, pose=machine.pose)
            for name, machine in self._machines[view.site].items()
            if name != view.id and view.kind == "robot"
        ]
        begins = max(each.boot + 1, int(time.time()))
        return StandInFacts(view.site, view.canonical, machines, view.readings, each.boot, begins)


def _machines_of(site: str) -> dict[str, registry.DeviceView]:
    devices = registry.list_devices(site=site, lifecycle="approved")
    return {device.id: device for device in devices if device.kind == "machine"}


def _make_world(scene: Scene) -> World:
    return make_world(scene=scene, driver="kinematic")
