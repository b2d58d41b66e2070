"""The process that plays the devices which are simulated at the moment, of all sites.

Any number may run: whoever holds the lease plays, and another takes over 5 s after it died, with the next start of each
device. It speaks for stand-ins alone (the broker lets its account do no more), and hears what real robots fetch from
machines and bring to them, so that a simulated machine holds what it would hold.
"""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from execution import database
from execution.job_lease import JobLease
from execution.listener import Arrival, Listener
from registry import services as registry
from simulation.services import make_world
from simulation.stand_ins.hand_overs import HandOver, HandOvers, hand_over_of, stock_for
from simulation.stand_ins.shared_connection import SharedConnection
from simulation.stand_ins.stand_in import StandIn, StandInFacts
from simulation.world import Obstacle, Scene, World
from vipo_device.protocol.description import Description
from vipo_device.protocol.errors import VipoError
from vipo_device.protocol.messages import DeviceCommand, parse_ack, read_command
from vipo_device.protocol.topics import STAND_IN_FILTERS, STAND_INS, stop_topic

log = logging.getLogger(__name__)
LOOK_EVERY_S = 1.0
LEASE_EVERY_S = 0.5
SITE_EVERY_S = 5.0
AGAIN_AFTER_S = 60.0
"""One that went wrong is begun anew after so long: nobody fills the log with what cannot be simulated."""
REST_S, TICK_S = 0.2, 0.05


@dataclass(frozen=True, slots=True)
class _Playing:
    """A stand-in with its connection, and the switch since which it plays."""

    stand_in: StandIn
    connection: SharedConnection
    since: str


class StandIns(Listener):
    """One such process; the embedded mode runs it in a thread, `manage.py stand_ins` by itself."""

    account, filters = STAND_INS, STAND_IN_FILTERS
    without_database = "Devices that are simulated begin and end nothing new."

    def __init__(self, settings: Any, heartbeat: registry.HeartbeatWriter | None = None, *, speed: float = 1.0) -> None:
        super().__init__(settings, heartbeat, speed=speed)
        self._folder = Path(settings.VIPO_STATE_DIR) / "stand-ins"
        self._folder.mkdir(parents=True, exist_ok=True)
        self._lease = JobLease("stand-ins", self._name)
        self._playing: dict[str, _Playing] = {}
        self._given_up: dict[str, float] = {}
        self._hand_overs = HandOvers()
        self._stops: dict[str, bytes] = {}
        self._looked_at = self._sites_at = self._asked_at = float("-inf")
        self._machines: dict[str, Mapping[str, Description]] = {}

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
        arrivals = self._heard(self._rest_s)
        first = next(arrivals, None)
        self._advance(time.monotonic())  # before what has come is begun: it takes its whole time from here on
        if self._new_line.is_set():
            self._new_line.clear()
            for playing in self._playing.values():
                playing.connection.say_connected()
        if first is not None:
            self._hear(first)
        for arrival in arrivals:
            self._hear(arrival)

    @property
    def _rest_s(self) -> float:
        if any(playing.stand_in.is_busy for playing in self._playing.values()):
            return TICK_S
        return REST_S if self._playing else LOOK_EVERY_S

    def _give_way(self) -> None:
        """Another process plays: say no more, and forget what was told meanwhile."""
        for playing in self._playing.values():
            playing.stand_in.close()
        self._playing.clear()
        self._hand_overs.forget()
        self._looked_at = self._sites_at = float("-inf")
        self._forget_heard()

    def _give_up(self, device: str) -> None:
        self._given_up[device] = time.monotonic()
        playing = self._playing.pop(device, None)
        if playing is not None:
            playing.stand_in.close()

    def _leave(self) -> None:
        for playing in self._playing.values():
            playing.stand_in.leave()

    def _advance(self, now: float) -> None:
        for name, playing in list(self._playing.items()):
            with self._alone(name):
                for goods in playing.stand_in.advance(now):
                    self._hand_over(goods)

    def _hear(self, arrival: Arrival) -> None:
        parts = arrival.topic.split("/")
        if parts[2:3] == ["site"] and parts[4:5] == ["stop"]:
            self._stops[parts[3]] = arrival.payload  # a stand-in that begins later hears it, too
            for name, playing in list(self._playing.items()):
                self._pass_on(name, playing, arrival)
        elif parts[2:3] == ["srv"]:
            for name, playing in list(self._playing.items()):
                self._pass_on(name, playing, arrival)
        elif self._playing and len(parts) == 6:
            voice, device, _, kind = parts[2:]
            try:
                if voice == "dev":
                    self._hear_real(device, kind, arrival.payload)
                elif device in self._playing:
                    self._share_stock(self._playing[device].stand_in, read_command(kind, arrival.payload))
            except VipoError as error:
                log.debug("What came on %s is not understood: %s", arrival.topic, error.detail)
            if voice == "sim" and device in self._playing:
                self._pass_on(device, self._playing[device], arrival)

    def _pass_on(self, name: str, playing: _Playing, arrival: Arrival) -> None:
        with self._alone(name):
            playing.connection.hear(arrival.topic, arrival.payload, retained=arrival.retained)

    def _hear_real(self, device: str, kind: str, payload: bytes) -> None:
        """Note what a real robot fetches from a machine or brings to it, once it has said that it has done so."""
        if kind == "ack":
            goods = self._hand_overs.take(device, parse_ack(payload))
            if goods is not None:
                self._hand_over(goods)
        elif command := read_command(kind, payload):
            self._hand_overs.note(device, command)

    def _hand_over(self, goods: HandOver) -> None:
        playing = self._playing.get(goods.machine)
        if playing is not None and playing.stand_in.stock is not None:
            with self._alone(goods.machine):
                playing.stand_in.take_over(goods)

    def _share_stock(self, robot: StandIn, command: DeviceCommand | None) -> None:
        """Tell a robot what the machine holds at which it is to fetch or leave something."""
        goods = hand_over_of(command) if command is not None else None
        if goods is None:
            return
        other = self._playing.get(goods.machine)
        stock = other.stand_in.stock if other is not None else None
        machine = self._machines.get(robot.facts.site, {}).get(goods.machine)
        if stock is None and machine is not None:
            said = registry.get_readings(site=robot.facts.site, ids=[goods.machine]).get(goods.machine)
            stock = stock_for(machine, said.values if said else {}, goods)
        if stock is not None:
            robot.see_stock(goods.machine, stock)

    def _look(self, now: float) -> None:
        """Begin to play what people have switched, and end what they have switched back."""
        wanted = {each.device.id: each for each in registry.list_stand_ins()}
        for name, playing in list(self._playing.items()):
            if name not in wanted:
                self._playing.pop(name).stand_in.leave()
            elif wanted[name].since != playing.since:  # back, and simulated again: it begins where the device is now
                self._playing.pop(name).stand_in.close()
        new = [each for name, each in wanted.items() if name not in self._playing and not self._is_given_up(name, now)]
        sites = {each.device.site for each in wanted.values() if each.device.kind == "robot"}
        is_due = now - self._sites_at >= SITE_EVERY_S
        if is_due or sites - self._machines.keys():
            self._sites_at = now
            self._machines = {site: _machines_of(site) for site in sites}
        for each in new:
            with self._alone(each.device.id):
                self._begin(each, now)
        for site in sites:
            self._put_in_the_way(site)
        if is_due:
            self._change(wanted)

    def _put_in_the_way(self, site: str) -> None:
        """Tell the robots of a site what people have put on its floor for simulated ones to meet."""
        obstacles = [Obstacle(each.x, each.y, each.size_m) for each in registry.list_obstacles(site=site)]
        for playing in self._playing.values():
            if playing.stand_in.facts.site == site:
                playing.stand_in.put_in_the_way(obstacles)

    def _is_given_up(self, device: str, now: float) -> bool:
        return now - self._given_up.get(device, float("-inf")) < AGAIN_AFTER_S

    def _change(self, wanted: Mapping[str, registry.StandInView]) -> None:
        """Let those that rest know what has become another: their own description, the machines of a robot's site."""
        for name, playing in list(self._playing.items()):
            with self._alone(name):
                facts = self._facts(wanted[name])
                if not playing.stand_in.is_busy and not playing.stand_in.facts.is_like(facts):
                    playing.stand_in.change(facts)

    def _begin(self, each: registry.StandInView, now: float) -> None:
        connection = SharedConnection(self._client)
        memory = self._folder / f"{each.device.id}.json"
        stand_in = StandIn(self._facts(each), connection, _make_world, memory, self._speed)
        self._playing[each.device.id] = _Playing(stand_in, connection, each.since)
        stand_in.connect(now)
        if stop := self._stops.get(each.device.site):
            connection.hear(stop_topic(each.device.site), stop, retained=True)

    def _facts(self, each: registry.StandInView) -> StandInFacts:
        """Return the device as its stand-in begins; the clock keeps its starts apart from those of another time."""
        view = each.device
        machines = tuple(self._machines[view.site].values()) if view.kind == "robot" else ()
        begins = max(each.boot + 1, int(time.time()))
        return StandInFacts(view.site, view.at_home, machines, view.readings, each.boot, begins, view.pose)


def _machines_of(site: str) -> Mapping[str, Description]:
    """Return the machines that robots of a site may serve, by id."""
    devices = registry.list_devices(site=site, lifecycle="approved")
    return {device.id: device.canonical for device in devices if device.kind == "machine"}


def _make_world(scene: Scene) -> World:
    return make_world(scene=scene, driver="kinematic")
