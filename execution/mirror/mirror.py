"""The mirror: hears what devices are told and say, lets their copies do the same, and keeps what both took.

It says nothing to any device: the broker lets its account hear only. What it shows of copies goes to screens, what it
measures into the database. Several may run; what two measure is kept once.
"""

from __future__ import annotations

import logging
import threading
import time
from collections import defaultdict
from dataclasses import dataclass, replace
from typing import Any

from execution import database
from execution.listener import Arrival, Listener
from execution.mirror.attention import Attention
from execution.mirror.measurements import Kept, keep_job
from execution.mirror.paces import Change
from registry import services as registry
from simulation.mirror.device_copy import DeviceCopy
from simulation.services import make_world
from simulation.world import Scene, World
from vipo_device.protocol.errors import VipoError
from vipo_device.protocol.messages import BadMessage, parse_ack, parse_state, read_command, read_stop
from vipo_device.protocol.topics import MIRROR, MIRROR_FILTERS

log = logging.getLogger(__name__)
REST_S, TICK_S = 0.5, 0.05
SHOW_EVERY_S = 0.25
TELL_EVERY_S = 2.0
"""Pages read measured times anew upon it: in a crowd not at each command."""
KNOWN_FOR_S = 10.0
MOST_COPIES = 500


@dataclass(slots=True)
class _Known:
    """A device, its site, when that was read, and its copy."""

    site: str
    read_at: float
    copy: DeviceCopy


class Mirror(Listener):
    """One mirror; the embedded mode runs it in a thread, `manage.py mirror` in a process."""

    account, filters = MIRROR, MIRROR_FILTERS
    without_database = "What devices take is not measured."

    def __init__(self, settings: Any, heartbeat: registry.HeartbeatWriter | None = None, *, speed: float = 1.0) -> None:
        super().__init__(settings, heartbeat, speed=speed)
        self._attention = Attention()
        self._known: dict[str, _Known] = {}
        self._stopped: dict[str, bool] = {}
        self._changed: dict[tuple[str, str], set[str]] = {}
        self._shown: set[str] = set()
        self._shown_at = self._told_at = 0.0
        self._measured: dict[str, set[str]] = {}

    def _turn(self, _stopping: threading.Event) -> None:
        is_new_line = self._new_line.is_set()
        self._new_line.clear()
        if not self._attention.turn(time.monotonic(), is_new_line=is_new_line):
            for known in self._known.values():
                known.copy.forget()
        at_work = [known for known in self._known.values() if known.copy.is_at_work]
        for arrival in self._heard(TICK_S if at_work else REST_S):
            self._hear(arrival)
        now = time.monotonic()
        for device, known in list(self._known.items()):
            if known.copy.is_at_work:
                with self._alone(device):
                    known.copy.advance(now)
                    self._keep(known)
        if now - self._shown_at >= SHOW_EVERY_S:
            self._shown_at = now
            self._show()

    def _give_up(self, device: str) -> None:
        self._known.pop(device, None)

    def _hear(self, arrival: Arrival) -> None:
        at, topic, payload, retained = arrival
        if retained and not topic.endswith(("/up/state", "/stop")):
            return
        parts = topic.split("/")
        if parts[2:3] == ["site"] and parts[4:] == ["stop"]:
            self._hold(at, parts[3], active=read_stop(payload).active)
        elif len(parts) == 6 and parts[2] == "dev":
            device, way, kind = parts[3:]
            with self._alone(device):
                try:
                    self._hear_of(at, (device, way, kind), payload)
                except (BadMessage, VipoError) as error:
                    log.debug("The mirror does not understand %s: %s", topic, error.detail)

    def _hear_of(self, at: float, said: tuple[str, str, str], payload: bytes) -> None:
        device, way, kind = said
        if way == "down":
            self._hear_command(at, device, kind, payload)
        elif device in self._known:
            copy = self._known[device].copy
            if kind == "ack":
                copy.hear_answer(at, parse_ack(payload))
            elif payload:
                copy.hear_state(at, parse_state(payload))

    def _hear_command(self, at: float, device: str, method: str, payload: bytes) -> None:
        command = read_command(method, payload)
        if command is None or method == "credential" or not self._attention.hears(at):
            return
        known = self._find(at, device)
        if known is not None:
            known.copy.hear_command(at, command)

    def _find(self, now: float, device: str) -> _Known | None:
        """Return a device that takes part; what is known of it is read anew before a job, every 10 s at most."""
        known = self._known.get(device)
        if known is not None and (known.copy.is_at_work or now - known.read_at < KNOWN_FOR_S):
            return known
        if known is None and len(self._known) >= MOST_COPIES:
            self._forget_resting()
        view = registry.find_device(device_id=device)
        if view is None or view.lifecycle != "approved" or len(self._known) >= MOST_COPIES:
            self._known.pop(device, None)
            return None
        machines = [
            replace(each.canonical, pose=each.pose)
            for each in registry.list_devices(site=view.site, lifecycle="approved")
            if each.kind == "machine"
        ]
        description = replace(view.canonical, pose=view.pose)
        if known is not None and known.copy.is_of(description, machines):
            known.read_at = now
            return known
        copy = DeviceCopy(description, machines, _make_world, self._speed)
        if known is not None:
            copy.learn_from(known.copy)
        else:
            copy.begin_with(view.readings)
        copy.hold(now, active=self._stopped.get(view.site, False))
        self._known[device] = _Known(view.site, now, copy)
        return self._known[device]

    def _forget_resting(self) -> None:
        for device in [name for name, known in self._known.items() if not known.copy.is_at_work]:
            del self._known[device]

    def _hold(self, at: float, site: str, *, active: bool) -> None:
        self._stopped[site] = active
        for known in self._known.values():
            if known.site == site:
                known.copy.hold(at, active=active)

    def _keep(self, known: _Known) -> None:
        job = known.copy.take_job()
        if job is None or not job.measured:
            return
        for kept in keep_job(job=job, at=database.now()):
            self._tell(kept)
        registry.flush_alerts()

    def _tell(self, kept: Kept) -> None:
        """Raise an alert when a pace has changed, and end it once all of the device's are as before."""
        for code, is_so in _directions(kept.change):
            changed = self._changed.get((kept.device, code))
            if is_so and (changed is None or kept.method not in changed):
                args = {"method": kept.method, "percent": abs(kept.change.percent) if kept.change else 0}
                registry.note_alert(device_id=kept.device, code=code, args=args)
                self._changed.setdefault((kept.device, code), set()).add(kept.method)
            elif not is_so and (changed is None or kept.method in changed):  # None: one may be left from before
                left = self._changed.setdefault((kept.device, code), set())
                left.discard(kept.method)
                if not left:
                    registry.end_alert(device_id=kept.device, code=code, at=database.now())
        self._measured.setdefault(kept.site, set()).add(kept.device)

    def _show(self) -> None:
        """Show screens where the copies of robots are, and, more seldom, of which devices something was measured."""
        copies: defaultdict[str, list[dict[str, Any]]] = defaultdict(list)
        for name, known in self._known.items():
            pose = known.copy.pose
            if pose is not None:
                at = {"x": round(pose.x, 3), "y": round(pose.y, 3), "theta": round(pose.theta, 3)}
                copies[known.site].append({"device": name, **at})
        for site in self._shown | copies.keys():
            registry.publish(site, {"type": "copies", "copies": copies.get(site, [])})
        self._shown = set(copies)
        if self._shown_at - self._told_at >= TELL_EVERY_S and self._measured:
            self._told_at = self._shown_at
            for site, devices in self._measured.items():
                registry.publish(site, {"type": "measured", "devices": sorted(devices)})
            self._measured = {}


def _make_world(scene: Scene) -> World:
    return make_world(scene=scene, driver="kinematic")


def _directions(change: Change | None) -> tuple[tuple[registry.AlertCode, bool], ...]:
    """Return which alert there is to be about a method."""
    percent = 0 if change is None else change.percent
    return (("became_slower", percent > 0), ("became_faster", percent < 0))
