"""How far a rehearsal is, as far as that can be known while it goes on; pure."""

from __future__ import annotations

from dataclasses import dataclass

from editor.language.plan.instructions import Branch, Invoke, Jump, Plan, TryBegin


@dataclass(frozen=True, slots=True)
class Progress:
    """How far a rehearsal is: the virtual time (s), the step it is at, and how many of the steps were done once.

    Where the program repeats something, or events interrupt it, done steps do not tell when it ends: `end_known` is
    False then, and the virtual time is what tells that it goes on.
    """

    virtual_s: float
    step: str
    steps_done: int
    steps: int
    end_known: bool

    @property
    def share(self) -> float:
        """The share of the steps that were done, from 0 to 0.99: it is 1 with the result only."""
        return round(0.99 * self.steps_done / max(1, self.steps), 3)


def has_known_end(plan: Plan) -> bool:
    """Tell whether a program goes through its steps once: nothing in its plan leads back, and no event comes between.

    Every cycle has an edge that leads to an earlier instruction, also one of functions that call each other.
    """
    if any(event.starts == "branch" for event in plan.events):
        return False
    return all(target > index for index, target in _edges(plan))


def _edges(plan: Plan) -> list[tuple[int, int]]:
    """Return from where to where control is handed otherwise than to the next instruction or to a new branch."""
    found = []
    for index, instruction in enumerate(plan.instructions):
        match instruction.do:
            case Jump(to=target) | Branch(otherwise=target) | TryBegin(handler=target) | Invoke(entry=target):
                found.append((index, target))
    return found
