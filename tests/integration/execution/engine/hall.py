"""Runs in the hall of the measurements: an oven that is told to heat, one step after the other."""

from datetime import UTC, datetime
from uuid import uuid4

from bench.hall import OVEN, SITE
from editor.language import plan_to_json
from editor.language.expressions.nodes import Constant, PlaceRef
from editor.language.plan.instructions import Call, End, Instruction, LimitBegin, Move, Plan, RoleBinding, TryEnd, Wait
from execution import database, services
from execution.models import Command, Run

WAITS = Plan((Instruction(Wait(Constant(3600)), "w", 1), Instruction(End())))


def heating(steps=3, oven=OVEN):
    call = Call(PlaceRef(device=oven), "heat", {"value": Constant(1)})
    return Plan((*(Instruction(call, f"s{n}", n) for n in range(steps)), Instruction(End())))


def driving(place, oven=OVEN):
    """Return a program in which the oven heats, then a robot drives to a place."""
    heat = Instruction(Call(PlaceRef(device=oven), "heat", {"value": Constant(1)}), "s0", 1)
    move = Instruction(Move("robot", PlaceRef(place=place)), "way", 2)
    return Plan((heat, move, Instruction(End())), {"robot": RoleBinding("robot", "robot001", ("move",))})


def limited(oven=OVEN):
    """Return a program of two steps of which the first has a limit, so that its timer is dropped when it is done."""
    call = Call(PlaceRef(device=oven), "heat", {"value": Constant(1)})
    first = (Instruction(LimitBegin(Constant(3600)), "l", 1, ("l",)), Instruction(call, "s0", 2))
    return Plan((*first, Instruction(TryEnd(), "l", 1, (), ("l",)), Instruction(call, "s1", 3), Instruction(End())))


def start(plan):
    prepared = services.Prepared(uuid4(), SITE, "Heating", 1, {}, {}, plan_to_json(plan), {})
    return str(services.start_run(prepared=prepared, by="Ada").id)


def told(run):
    """Return the commands of a run in their order."""
    return list(Command.objects.filter(run=run).order_by("position"))


def answer(command, status="DONE"):
    services.mark_sent(sent={str(command.id): database.now()})
    at = datetime.now(UTC)
    return services.record_ack(
        device=command.device, command_id=str(command.id), status=status, why="", result={}, at=at
    )


def answer_open(run):
    """Let the device answer whatever it has been told; return whether there was anything."""
    answered = [answer(command) for command in told(run) if command.status in Command.OPEN]
    return any(answered)


def row(run):
    return Run.objects.get(id=run)
