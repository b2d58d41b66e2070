"""What a rehearsal leaves behind: the trajectory and the figures, in the shape of `RehearsalResultShape`."""

from __future__ import annotations

from collections.abc import Mapping
from math import hypot, inf
from typing import Any

from execution.machine import messages as r
from execution.machine.evaluation import in_words
from execution.rehearsals.footprint_monitor import FootprintMonitor
from execution.rehearsals.zone_waits import LIMITED, mark_of
from execution.traffic import messages as m
from execution.traffic.layout import Layout
from execution.traffic.path_planner import length_m
from simulation.fault_form import faults_to_json
from simulation.world import Ack, Contact, FaultBegan, PropertyChanged, RobotSnapshot, WorldEvent
from vipo_device.protocol.description import Scalar

FRAME_S = 0.2
MOST_FRAMES = 20_000


class Recorder:
    """Takes down what happens while a rehearsal runs; `result` puts it into one piece of JSON."""

    def __init__(self, layout: Layout, readings: Mapping[str, Mapping[str, Scalar]]) -> None:
        self._layout = layout
        robots = [d for d in layout.devices.values() if d.kind == "robot"]
        self._machines = [d.id for d in layout.devices.values() if d.kind == "machine"]
        self.monitor = FootprintMonitor({d.id: d.radius_m or 0.18 for d in robots})
        self.errors: list[dict[str, Any]] = []
        self.collisions: list[dict[str, Any]] = []
        self.steps: list[dict[str, Any]] = []
        self.log: list[dict[str, Any]] = []
        self._open_steps: list[dict[str, Any]] = []
        self._counts: dict[str, int] = {}
        self._waits: list[dict[str, Any]] = []
        self._open_waits: dict[int, dict[str, Any]] = {}
        self._figures = {d.id: {"distance_m": 0.0, "busy_s": 0.0, "wait_s": 0.0, "battery": 100.0} for d in robots}
        self._machine_busy_s = dict.fromkeys(self._machines, 0.0)
        self._states: dict[str, list[list[Any]]] = {name: [] for name in self._machines}
        self._carrying: dict[str, list[list[Any]]] = {d.id: [] for d in robots}
        self._frames: dict[str, list[list[float]]] = {d.id: [] for d in robots}
        self._properties: dict[str, list[list[Any]]] = {
            device: [[0.0, name, value] for name, value in values.items()] for device, values in readings.items()
        }
        self._routes: list[dict[str, Any]] = []
        self._obstacles: list[dict[str, Any]] = []
        limited = [zone for zone in layout.zones if zone.rule == LIMITED]
        self._zone_waits = {z.key: {"mark": mark_of(z.points, z.robots), "waited_s": 0.0} for z in limited}
        self._commands: dict[str, tuple[str, str, str]] = {}
        self._frame_s = FRAME_S
        self._next_frame = 0.0
        self._last: dict[str, tuple[float, float]] = {}

    def look(self, t_s: float, dt_s: float, robots: Mapping[str, RobotSnapshot], busy: Mapping[str, bool]) -> None:
        """Take down an instant: poses, loads, who is busy."""
        self.monitor.look(t_s, {name: (robot.pose.x, robot.pose.y) for name, robot in robots.items()})
        for name, robot in robots.items():
            self._look_at_robot(t_s, dt_s, name, robot, busy.get(name, False))
        for name in self._machines:
            states = self._states[name]
            if not states or states[-1][1] is not busy.get(name, False):
                states.append([round(t_s, 2), busy.get(name, False)])
            self._machine_busy_s[name] += dt_s if busy.get(name, False) else 0.0
        while self._next_frame <= t_s + 1e-9:
            self._take_frame(robots)

    def _look_at_robot(self, t_s: float, dt_s: float, name: str, robot: RobotSnapshot, busy: bool) -> None:
        figures, here = self._figures[name], (robot.pose.x, robot.pose.y)
        last = self._last.get(name, here)
        figures["distance_m"] += hypot(here[0] - last[0], here[1] - last[1])
        figures["busy_s"] += dt_s if busy else 0.0
        figures["battery"] = round(robot.battery, 1)
        self._last[name] = here
        loads = self._carrying[name]
        if not loads or loads[-1][1] != dict(robot.carrying):
            loads.append([round(t_s, 2), dict(robot.carrying)])

    def _take_frame(self, robots: Mapping[str, RobotSnapshot]) -> None:
        for name, robot in robots.items():
            pose = robot.pose
            self._frames[name].append([round(pose.x, 3), round(pose.y, 3), round(pose.theta, 3)])
        self._next_frame += self._frame_s
        if self._frames and len(next(iter(self._frames.values()), [])) > MOST_FRAMES:
            self._frames = {name: frames[::2] for name, frames in self._frames.items()}
            self._next_frame += self._frame_s
            self._frame_s *= 2

    def note_world(self, event: WorldEvent) -> None:
        """Take down what the world says."""
        t_s = round(event.t_s, 2)
        match event:
            case PropertyChanged(device=device, name=name, value=value):
                self._properties.setdefault(device, []).append([t_s, name, value])
            case Contact(device=device, other=other, distance_m=gap_m, x=x, y=y):
                if gap_m <= 0 and not self._is_going_on(t_s, device, other):
                    place = {"distance_m": round(gap_m, 3), "x": round(x, 2), "y": round(y, 2)}
                    self.collisions.append({"t": t_s, "a": device, "b": other, **place})
            case FaultBegan(fault=fault):
                entry = faults_to_json([fault])["faults"][0]
                word, where = str(entry["fault"]), self._layout.name(fault.device) if fault.device else "the floor"
                self._say(t_s, fault.step, fault.device, f"On purpose, {where}: {word}", f"fault_{word}")
                if fault.kind == "obstacle":
                    until = None if fault.for_s == inf else round(t_s + fault.for_s, 2)
                    place = {"x": fault.x, "y": fault.y, "size_m": fault.size_m}
                    self._obstacles.append({"t": t_s, "until": until, **place})
            case Ack(command=command, status=status, why=why):
                if command in self._commands and status not in {"ACCEPTED", "RUNNING"}:
                    self._note_answer(t_s, *self._commands[command], status, why)

    def _is_going_on(self, t_s: float, a: str, b: str) -> bool:
        pairs = ({a, b} == {c["a"], c["b"]} and t_s - c["t"] < 2.0 for c in reversed(self.collisions))
        return any(pairs)

    def note_run(self, t_s: float, action: r.Action) -> None:
        """Take down what the run machine does."""
        match action:
            case r.StepEntered(step=step):
                self._counts[step] = self._counts.get(step, 0) + 1
                entry = {"step": step, "count": self._counts[step], "robot": "", "device": "",
                         "started_s": round(t_s, 2), "ended_s": None, "status": "running"}  # fmt: skip
                self._open_steps.append(entry)
                self.steps.append(entry)
            case r.AskPeople(step=step, text=text):
                self._say(t_s, step, "", f"Asked: {text}", "asked", text=text)
            case r.Tell(step=step, text=text):
                self._say(t_s, step, "", f"Told: {text}", "told", text=text)
            case r.StepLeft(step=step):
                self._close_step(t_s, step, "done")
            case r.StepFailed(step=step, kind=kind, why=why):
                self._close_step(t_s, step, "skipped" if kind == "cancelled" else "failed")
                said = any(e["message"] == why and e["t"] == round(t_s, 2) for e in self.errors)
                if kind != "cancelled" and not said:
                    self.error(t_s, step, kind, why, f"step_{kind}", why=why)

    def _close_step(self, t_s: float, step: str, status: str) -> None:
        """Note how a step ended; of one that several branches are in, the one that was begun first."""
        entry = next((each for each in self._open_steps if each["step"] == step), None)
        if entry is not None:
            self._open_steps.remove(entry)
            entry.update(ended_s=round(t_s, 2), status=status)

    def error(self, t_s: float, step: str, kind: str, message: str, code: str, **args: Scalar) -> None:
        """Take down something that the real run would have met too, with what other languages say it from."""
        said = {"code": code, "args": args}
        self.errors.append({"t": round(t_s, 2), "step": step, "kind": kind, "message": message, **said})
        self._say(t_s, step, "", message, code, **args)

    def step_now(self) -> str:
        """Return the step that was begun last of those under way; between two the one before."""
        last = (self._open_steps or self.steps)[-1:]
        return str(last[0]["step"]) if last else ""

    def note_answer(self, t_s: float, step: str, answer: Scalar) -> None:
        """Take down what the rehearsal has answered in people's stead."""
        shown = in_words(answer) or "nothing"
        self._say(t_s, step, "", f"The rehearsal answers by itself: {shown}", "answered_itself", value=answer)

    def note_admission(self, t_s: float, robot: str, zone: str) -> None:
        """Take down that a robot was let into a zone in people's stead."""
        name = self._layout.name(robot)
        self._say(t_s, "", robot, f"The rehearsal lets {name} into {zone} by itself", "let_in_itself", zone=zone)

    def note_floor(self, t_s: float, action: m.Action) -> None:
        """Take down what traffic does."""
        match action:
            case m.SendCommand(id=command, device=device, step=step, piece=piece):
                self._note_command(t_s, action)
                if not piece and step:
                    self._commands[command] = (step, device, action.method)
            case m.PathPlanned(robot=robot, path=path):
                self._routes.append({"t": round(t_s, 2), "robot": robot, "path": [list(point) for point in path]})
                far_m = round(length_m(path), 1)
                self._say(t_s, "", robot, f"{self._layout.name(robot)} sets out, {far_m:.1f} m.", "way", length_m=far_m)
            case m.WaitChanged():
                self._note_wait(t_s, action)
            case m.TaskTold(step=step, robot=robot, reason=said):
                self._say(t_s, step, robot, said.text, said.code, **said.args)
            case m.RoleBound(role=role, robot=robot):
                text = f"{self._layout.name(robot)} takes the role “{role}”."
                self._say(t_s, "", robot, text, "role_bound", role=role)
            case m.RoleReleased(role=role, robot=robot):
                text = f"{self._layout.name(robot)} is released from the role “{role}”."
                self._say(t_s, "", robot, text, "role_released", role=role)

    def _note_command(self, t_s: float, action: m.SendCommand) -> None:
        device = self._layout.devices.get(action.device)
        word = "robot" if device is not None and device.kind == "robot" else "device"
        entry = self._entry_of(action, word)
        if entry is not None and device is not None:
            entry[word] = action.device
            entry["device"] = entry["device"] or str(action.arguments.get("device", ""))
        if not action.piece:
            values = ", ".join(f"{name} {value}" for name, value in action.arguments.items())
            text = f"{self._layout.name(action.device)}: {action.method} {values}"
            named = ", ".join(self._layout.name(str(value)) for value in action.arguments.values())
            self._say(t_s, action.step, action.device, text, "command", method=action.method, values=named)

    def _entry_of(self, action: m.SendCommand, word: str) -> dict[str, Any] | None:
        """Return the entry of the step that a command is of.

        Of a step that several branches are in, it is the one that the device has already, else the first that has none
        yet, else the one that was begun last.
        """
        entries = [each for each in self._open_steps if each["step"] == action.step]
        own = (each for device in (action.device, "") for each in entries if each[word] == device)
        return next(own, entries[-1] if entries else None)

    def _note_answer(self, t_s: float, step: str, device: str, method: str, status: str, why: str) -> None:
        text = f"{self._layout.name(device)}, {method}: {status.lower()}" + (f", {why}" if why else "")
        self._say(t_s, step, device, text, "answer", method=method, status=status, why=why)

    def _note_wait(self, t_s: float, action: m.WaitChanged) -> None:
        open_wait = self._open_waits.pop(action.task, None)
        if open_wait is not None:
            self._end_wait(t_s, open_wait)
        if action.reason is not None:
            why = {"code": action.reason.code, "args": dict(action.reason.args)}
            self._open_waits[action.task] = {"t": round(t_s, 2), "duration_s": 0.0, "robot": action.robot,
                                                "reason": action.reason.text, "why": why}  # fmt: skip

    def _end_wait(self, t_s: float, wait: dict[str, Any]) -> None:
        wait["duration_s"] = round(t_s - wait["t"], 2)
        if wait["duration_s"] > 0:
            self._waits.append(wait)
            if (zone := self._zone_waits.get(str(wait["why"]["args"].get("zone_key", "")))) is not None:
                zone["waited_s"] = round(zone["waited_s"] + wait["duration_s"], 2)
            if wait["robot"] in self._figures:
                self._figures[wait["robot"]]["wait_s"] += wait["duration_s"]

    def _say(self, t_s: float, step: str, device: str, line: str, code: str, **args: Scalar) -> None:
        """Add a line in English, with what other languages say it from."""
        self.log.append({"t": round(t_s, 2), "step": step, "device": device, "text": line, "code": code, "args": args})

    def result(self, t_s: float, *, ok: bool) -> dict[str, Any]:
        """Return the whole record."""
        for wait in self._open_waits.values():
            self._end_wait(t_s, wait)
        for entry in list(self._open_steps):
            self._close_step(t_s, entry["step"], "failed")
        touched = [e for e in self.monitor.encounters if e["distance_m"] <= 0]
        return {
            "ok": ok and not self.collisions and not touched,
            "duration_s": round(t_s, 2),
            "errors": self.errors,
            "robots": {n: {k: round(v, 2) for k, v in f.items()} for n, f in self._figures.items()},
            "machines": {name: {"busy_s": round(busy_s, 2)} for name, busy_s in self._machine_busy_s.items()},
            "near_misses": [e for e in self.monitor.encounters if e["distance_m"] > 0],
            "collisions": sorted(self.collisions + touched, key=lambda c: float(c["t"])),
            "waits": sorted(self._waits, key=lambda wait: float(wait["t"])),
            "steps": self.steps,
            "frames": {"dt_s": self._frame_s, "robots": self._frames},
            "carrying": self._carrying,
            "machine_states": self._states,
            "properties": self._properties,
            "routes": self._routes,
            "obstacles": self._obstacles,
            "zone_waits": {key.partition("/")[2]: waits for key, waits in self._zone_waits.items()},
            "log": self.log,
        }
