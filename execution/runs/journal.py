"""A run's journal: what is written into its history, and what its steps look like."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import datetime
from typing import Any, assert_never

from execution.floor_protocol import (
    CommandEnded,
    CommandGiven,
    DeadlinePassed,
    QuestionAnswered,
    ResumeAsked,
    RobotSetsOut,
    RoleEmptied,
    RoleFilled,
    TaskEnded,
    TaskNoted,
    ToRun,
    WaitNoted,
)
from execution.machine import messages as r
from execution.machine.messages import CancelAsked, PauseAsked, TimerFired
from execution.models import Run, RunEvent
from execution.runs.questions import in_short
from execution.views import event_to_json, run_to_json, view_event, view_run
from registry import services as registry

TOLD_AT_LEAST = 100
AT_ONCE_S = 2.0
"""What fails sooner may fail again and again; it is told to its run a second later at most (`machine.at_once`)."""
WHAT_BECAME = {r.StepEntered: "begun", r.StepLeft: "done", r.StepFailed: "not_done"}
ANSWERS = {"DONE": "is done", "FAILED": "failed", "REJECTED": "refused", "CANCELED": "was called off"}
ENDS = {
    "finished": "The run is finished.",
    "failed": "The run failed",
    "cancelled": "The run was cancelled",
    "paused": "The run is paused",
    "running": "The run goes on.",
}


def describe(status: str, reason: str) -> str:
    """Return the sentence for what has become of a run."""
    sentence = ENDS[status]
    return f"{sentence}: {reason}" if reason and not sentence.endswith(".") else sentence.rstrip(".") + "."


class Journal:
    """Collects the events of one step of a run, and keeps the marks of its steps up to date."""

    def __init__(self, run: Run, now: datetime, names: Mapping[str, str]) -> None:
        self.run, self.now, self.seq = run, now, run.next_seq
        self.steps: dict[str, dict[str, Any]] = {key: dict(value) for key, value in run.steps.items()}
        self.roles: dict[str, str] = dict(run.roles)
        self._names = names
        self.live: list[Mapping[str, Any]] = []
        self._rows: list[RunEvent] = []

    def say(self, kind: str, text: str, *, step: str = "", code: str = "", **more: Any) -> None:
        """Add a line; `more` may name the device, the robot and arguments for translation."""
        started_at = self.run.started_at or self.now
        row = RunEvent(
            run=self.run,
            seq=self.seq,
            at=self.now,
            t_s=round((self.now - started_at).total_seconds(), 3),
            kind=kind,
            step=step,
            device=more.pop("device", ""),
            robot=more.pop("robot", ""),
            text=text[:500],
            code=code,
            args=more,
        )
        self.seq += 1
        self._rows.append(row)

    def mark(self, action: r.StepEntered | r.StepLeft | r.StepFailed, *, is_last: bool = False) -> None:
        """Mark a step as the machine says; a failure that ends the run (`is_last`) is always written down.

        Another is left out only in a long loop, where it comes at once, without anything that others have read of.
        """
        registry.count(name="run_steps", labels=(WHAT_BECAME[type(action)],))
        match action:
            case r.StepEntered(step=step):
                count = self.steps.get(step, {}).get("count", 0) + 1
                self.steps[step] = {"status": "running", "started_at": self.now.isoformat(), "ended_at": None,
                                    "robot": None, "wait": None, "why": None, "count": count}  # fmt: skip
                if self._is_told(step):
                    self.say("step", "The step begins.", step=step, code="step_entered", count=count)
            case r.StepLeft(step=step):
                self._end(step, "done")
                if self._is_told(step):
                    self.say("step", "The step is done.", step=step, code="step_done")
            case r.StepFailed(step=step, kind=kind, why=why):
                has_lasted = self._has_lasted(step)
                self._end(step, "skipped" if kind == "cancelled" else "failed")
                if is_last or has_lasted or self._is_told(step):
                    self.say("step", why or "The step was not done.", step=step, code=f"step_{kind}")

    def _is_told(self, step: str) -> bool:
        """Tell whether it is written that a step begins, is done or fails at once: in long loops each hundredth."""
        count = self.steps[step].get("count", 1)
        return bool(count <= TOLD_AT_LEAST or count % TOLD_AT_LEAST == 0)

    def _has_lasted(self, step: str) -> bool:
        """Tell whether there is more of a step than that it failed: it has waited, or taken longer than `AT_ONCE_S`."""
        mark = self.steps.get(step)
        if mark is None or mark.get("wait") is not None:
            return True
        return (self.now - datetime.fromisoformat(mark["started_at"])).total_seconds() > AT_ONCE_S

    def _end(self, step: str, status: str) -> None:
        mark = self.steps.setdefault(step, {"started_at": self.now.isoformat(), "robot": None, "count": 1})
        mark.update(status=status, ended_at=self.now.isoformat(), wait=None, why=None)

    def note(self, message: ToRun) -> None:
        """Write down what the run is told, as far as people want to read it."""
        match message:
            case RoleFilled(role=role, robot=robot):
                self.roles[role] = robot
                text = f"{self._name(robot)} takes the role “{role}”."
                self.say("role", text, code="role_bound", robot=robot, role=role)
            case RoleEmptied(role=role, robot=robot):
                self.roles.pop(role, None)
                text = f"{self._name(robot)} is released from the role “{role}”."
                self.say("role", text, code="role_released", robot=robot, role=role)
            case WaitNoted():
                self._note_wait(message)
            case TaskNoted(step=step, robot=robot, reason=said):
                self.say("step", said.text, step=step, code=said.code, robot=robot, device=robot, **said.args)
            case CommandGiven():
                self._note_command(message)
            case CommandEnded():
                self._note_answer(message)
            case RobotSetsOut(robot=robot, path=path):
                self.say("way", f"{self._name(robot)} sets out.", code="way", robot=robot, device=robot, path=path)
            case QuestionAnswered(value=value, by=by, step=step):
                text = f"{by} answered: {in_short(value)}."
                self.say("question", text, step=step, code="answered", by=by, value=value)
            case TaskEnded() | TimerFired() | PauseAsked() | ResumeAsked() | CancelAsked() | DeadlinePassed():
                pass  # what comes of it is written when it comes
            case _:
                assert_never(message)

    def _note_wait(self, wait: WaitNoted) -> None:
        reason, robot = wait.reason, wait.robot
        mark = self.steps.get(wait.step)
        if mark is not None and mark["status"] in {"running", "waiting"}:
            mark.update(status="waiting" if reason else "running", wait=reason.text if reason else None)
            mark["why"] = {"code": reason.code, "args": dict(reason.args)} if reason else None
            mark["robot"] = robot or mark.get("robot")
        if reason is None:
            self.say("wait", "It goes on.", step=wait.step, code="wait_over", robot=robot)
        else:
            more = {key: value for key, value in reason.args.items() if key not in {"robot", "device"}}
            device = reason.args.get("device", "")
            self.say("wait", reason.text, step=wait.step, code=reason.code, robot=robot, device=device, **more)

    def _note_command(self, given: CommandGiven) -> None:
        mark = self.steps.get(given.step)
        if mark is not None and given.device in self.roles.values():
            mark["robot"] = given.device
        values = ", ".join(str(self._names.get(str(value), value)) for value in given.arguments.values())
        text = f"{self._name(given.device)}: {given.method}({values})"
        self.say("command", text, step=given.step, code="command", device=given.device, method=given.method,
                 arguments=given.arguments)  # fmt: skip

    def _note_answer(self, ended: CommandEnded) -> None:
        what = f"{self._name(ended.device)} {ANSWERS[ended.status]}: {ended.method}"
        text = f"{what} ({ended.why})" if ended.why else f"{what}."
        more = {"method": ended.method, "status": ended.status, "why": ended.why}
        self.say("answer", text, step=ended.step, code="answer", device=ended.device, **more)

    def ask(self, step: str, text: str) -> None:
        """Write down a question; its step waits."""
        mark = self.steps.get(step)
        if mark is not None and mark["status"] == "running":
            mark.update(status="waiting", wait="It waits for an answer.", why={"code": "question", "args": {}})
        self.say("question", text, step=step, code="asked")

    def _name(self, device: str) -> str:
        return self._names.get(device, device)

    def show(self, message: Mapping[str, Any]) -> None:
        """Let people who watch the site see a message once the step is kept."""
        self.live.append(message)

    def close(self) -> list[RunEvent]:
        """Bring the run's row up to date and return the new lines, which are still to be kept."""
        self.run.steps, self.run.roles, self.run.next_seq = self.steps, self.roles, self.seq
        return self._rows


def shown(run: Run, lines: Sequence[RunEvent]) -> list[dict[str, Any]]:
    """Return what is shown of a run's new lines, and of the run as it is after them."""
    messages = [{"type": "run_event", "run": str(run.id), "event": event_to_json(view_event(row))} for row in lines]
    return [*messages, {"type": "run", "run": run_to_json(view_run(run))}]
