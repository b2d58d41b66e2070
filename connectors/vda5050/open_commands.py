"""The commands of one vehicle that are open, in their order, and the last word about each."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict
from typing import Any

from connectors.vda5050.tasks import Task, task_from_json, task_to_json
from vipo_device.kit.answers import AnswerLedger
from vipo_device.protocol.messages import AckMessage, AckStatus

BEFORE = "The way before it failed."


class OpenTasks:
    """Every answer is remembered and given to `tell`; a final one ends the task."""

    def __init__(self, tell: Callable[[AckMessage], None]) -> None:
        self._tell = tell
        self._tasks: list[Task] = []
        self._answers = AnswerLedger()

    def __iter__(self) -> Iterator[Task]:
        return iter(tuple(self._tasks))

    def __len__(self) -> int:
        return len(self._tasks)

    @property
    def head(self) -> Task | None:
        """The command that is first in turn."""
        return self._tasks[0] if self._tasks else None

    @property
    def tail(self) -> Task | None:
        """The command that is last in turn."""
        return self._tasks[-1] if self._tasks else None

    @property
    def commands(self) -> list[str]:
        """The ids of the open commands."""
        return [task.command for task in self._tasks]

    @property
    def handed_over(self) -> list[Task]:
        """Those that are part of an order."""
        return [task for task in self._tasks if task.is_handed_over]

    @property
    def waiting(self) -> list[Task]:
        """Those that the vehicle does not know of yet."""
        return [task for task in self._tasks if not task.is_handed_over]

    def add(self, task: Task) -> None:
        """Take a command on, behind all others."""
        self._tasks.append(task)

    def end(self, task: Task, status: AckStatus, why: str = "") -> None:
        """Give a command its final answer."""
        self._tasks.remove(task)
        self.say(task.command, status, why)

    def end_refused(self, task: Task, why: str) -> None:
        """End a command that the vehicle does not take: it has failed if it was accepted before."""
        self.end(task, "FAILED" if self.find(task.command) else "REJECTED", why)

    def drop_drives(self) -> None:
        """End the moves that wait, because the way before them failed."""
        for task in [t for t in self.waiting if t.way]:
            self.end(task, "CANCELED", BEFORE)

    def find(self, command: str) -> AckMessage | None:
        """Return the last word about a command, open or over; None when nothing was said."""
        return self._answers.find(command)

    def is_over(self, command: str) -> bool:
        """Tell whether a command has had its final answer."""
        return self._answers.is_over(command)

    def say(self, command: str, status: AckStatus, why: str = "") -> None:
        """Answer a command, whether it is one of these or not."""
        ack = AckMessage(command, status, why[:256])
        self._answers.note(ack)
        self._tell(ack)

    def to_json(self) -> dict[str, Any]:
        """Return what recall reads."""
        return {
            "tasks": [task_to_json(task) for task in self._tasks],
            "over": [asdict(ack) for ack in self._answers.over()],
            "under_way": [asdict(ack) for ack in self._answers.under_way()],
        }

    def recall(self, body: Mapping[str, Any]) -> None:
        """Take up what to_json wrote."""
        self._tasks = [task_from_json(task) for task in body["tasks"]]
        over, under_way = (tuple(AckMessage(**ack) for ack in body[name]) for name in ("over", "under_way"))
        self._answers = AnswerLedger(over, under_way)
