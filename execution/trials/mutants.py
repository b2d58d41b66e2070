"""A program with one check, catch, condition or limit taken out or turned: whether its tests notice is worth asking."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from editor.language.expressions.nodes import Constant, Operation
from editor.language.plan import instructions as p

NEVER = ("taken out",)
"""A catch of this kind of failure takes none, for there is none of the kind."""
ENDLESS_S = 1e9


WHAT: Mapping[str, str] = {
    "event_out": "the event is taken out",
    "role_out": "the condition by which {name} is chosen is taken out",
    "loop_out": "the loop is taken out",
    "turned": "the condition is turned round",
    "always": "the check is taken out, as if it always held",
    "never": "the check is taken out, as if it never held",
    "catch_out": "the catch is taken out",
    "limit_out": "the time limit is taken out",
    "wait_out": "the wait is taken out",
    "time_out_out": "the time out is taken out",
    "failure_out": "the failure is taken out",
}
"""What can be changed, by its code, in words."""


@dataclass(frozen=True, slots=True)
class Mutant:
    """A changed plan: at which step (its id, "" for a role) and line of the script, and what was changed.

    `code` is one of `WHAT`; `name` is that of the role, where it is one.
    """

    step: str
    line: int
    code: str
    plan: p.Plan
    name: str = ""

    @property
    def what(self) -> str:
        """What was changed, in English words."""
        return WHAT[self.code].format(name=self.name)


def mutants(plan: p.Plan) -> Iterator[Mutant]:
    """Go through all mutants of a plan, in the order of its instructions."""
    for at, instruction in enumerate(plan.instructions):
        if instruction.step:
            for code, do in _changes(plan, at, instruction.do):
                changed = (*plan.instructions[:at], replace(instruction, do=do), *plan.instructions[at + 1 :])
                yield Mutant(instruction.step, instruction.line, code, replace(plan, instructions=changed))
    for index, event in enumerate(plan.events):
        events = (*plan.events[:index], *plan.events[index + 1 :])
        line = plan.instructions[event.entry].line
        yield Mutant(event.step, line, "event_out", replace(plan, events=events))
    for name, role in plan.roles.items():
        if role.where is not None:
            roles = {**plan.roles, name: replace(role, where=None, said="")}
            yield Mutant("", 0, "role_out", replace(plan, roles=roles), name)


def _changes(plan: p.Plan, at: int, do: p.Action) -> Sequence[tuple[str, p.Action]]:
    """Return what can be changed at an instruction, by its code, and the instruction then."""
    match do:
        case p.Branch(condition=condition):
            if any(i.do == p.Jump(at) for i in plan.instructions[at + 1 :]):
                return [("loop_out", replace(do, condition=Constant(False)))]
            return [
                ("turned", replace(do, condition=Operation("not", (condition,)))),
                ("always", replace(do, condition=Constant(True))),
                ("never", replace(do, condition=Constant(False))),
            ]
        case p.TryBegin(final=False):
            return [("catch_out", replace(do, kinds=NEVER))]
        case p.LimitBegin():
            return [("limit_out", p.LimitBegin(Constant(ENDLESS_S)))]
        case p.WaitUntil(timeout_s=timeout):
            out: list[tuple[str, p.Action]] = [("wait_out", p.Jump(at + 1))]
            return out if timeout is None else [*out, ("time_out_out", replace(do, timeout_s=None))]
        case p.AskPerson(timeout_s=timeout) if timeout is not None:
            return [("time_out_out", replace(do, timeout_s=None))]
        case p.Fail():
            return [("failure_out", p.Jump(at + 1))]
    return []
