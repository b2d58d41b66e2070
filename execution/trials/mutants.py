"""A program with one check, catch, condition or limit taken out or turned: whether its tests notice is worth asking."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from editor.language.expressions.nodes import Constant, Operation
from editor.language.plan import instructions as p

NEVER = ("taken out",)
"""A catch of this kind of failure takes none, for there is none of the kind."""
ENDLESS_S = 1e9


@dataclass(frozen=True, slots=True)
class Mutant:
    """A changed plan: at which step (its id, "" for a role) and line of the script, and what was changed."""

    step: str
    line: int
    what: str
    plan: p.Plan


def mutants(plan: p.Plan) -> Iterator[Mutant]:
    """Go through all mutants of a plan, in the order of its instructions."""
    for at, instruction in enumerate(plan.instructions):
        if instruction.step:
            for what, do in _changes(plan, at, instruction.do):
                changed = (*plan.instructions[:at], replace(instruction, do=do), *plan.instructions[at + 1 :])
                yield Mutant(instruction.step, instruction.line, what, replace(plan, instructions=changed))
    for index, event in enumerate(plan.events):
        events = (*plan.events[:index], *plan.events[index + 1 :])
        line = plan.instructions[event.entry].line
        yield Mutant(event.step, line, "the event is taken out", replace(plan, events=events))
    for name, role in plan.roles.items():
        if role.where is not None:
            roles = {**plan.roles, name: replace(role, where=None, said="")}
            what = f"the condition by which {name} is chosen is taken out"
            yield Mutant("", 0, what, replace(plan, roles=roles))


def _changes(plan: p.Plan, at: int, do: p.Action) -> Sequence[tuple[str, p.Action]]:
    """Return what can be changed at an instruction, in words, and the instruction then."""
    match do:
        case p.Branch(condition=condition):
            if any(i.do == p.Jump(at) for i in plan.instructions[at + 1 :]):
                return [("the loop is taken out", replace(do, condition=Constant(False)))]
            return [
                ("the condition is turned round", replace(do, condition=Operation("not", (condition,)))),
                ("the check is taken out, as if it always held", replace(do, condition=Constant(True))),
                ("the check is taken out, as if it never held", replace(do, condition=Constant(False))),
            ]
        case p.TryBegin(final=False):
            return [("the catch is taken out", replace(do, kinds=NEVER))]
        case p.LimitBegin():
            return [("the time limit is taken out", p.LimitBegin(Constant(ENDLESS_S)))]
        case p.WaitUntil(timeout_s=timeout):
            out: list[tuple[str, p.Action]] = [("the wait is taken out", p.Jump(at + 1))]
            return out if timeout is None else [*out, ("the time out is taken out", replace(do, timeout_s=None))]
        case p.AskPerson(timeout_s=timeout) if timeout is not None:
            return [("the time out is taken out", replace(do, timeout_s=None))]
        case p.Fail():
            return [("the failure is taken out", p.Jump(at + 1))]
    return []
