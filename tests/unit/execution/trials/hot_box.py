"""A small program with a check, a catch, a loop and a time limit, for tests of what its tests notice."""

from editor.language.expressions.nodes import Constant, Operation, PlaceRef, Reading, Variable
from editor.language.plan import instructions as p
from execution.trials.trial import Expectation, Trial
from execution.trials.trial_run import Subject
from simulation.world import Fault
from tests.kit import demo_floor

MIXER = PlaceRef(device="paintMixer02")
MIX = p.Call(MIXER, "mixPaint", {"time": Constant(1)})
TEMPERATURE = Reading(Constant("paintMixer02"), "temperature")
PLAN = p.Plan(
    (
        p.Instruction(p.TryBegin(3, ("failed",)), "try", 1, enters=("try",)),
        p.Instruction(MIX, "mix", 2),
        p.Instruction(p.TryEnd()),
        p.Instruction(p.Branch(Operation(">", (TEMPERATURE, Constant(25))), 6), "cool", 3, enters=("cool",)),
        p.Instruction(p.Wait(Constant(10)), "wait", 4),
        p.Instruction(p.Jump(3)),
        p.Instruction(p.Branch(Operation("<", (TEMPERATURE, Constant(99))), 8), "if", 5, enters=("if",)),
        p.Instruction(p.Notify(Constant("cold")), "told", 6),
        p.Instruction(p.Assign("left", Constant(2)), "repeat", 7, enters=("repeat",)),
        p.Instruction(p.Branch(Operation(">=", (Variable("left"), Constant(1))), 13), "repeat", 7),
        p.Instruction(p.Wait(Constant(1)), "rest", 8),
        p.Instruction(p.Assign("left", Operation("-", (Variable("left"), Constant(1))))),
        p.Instruction(p.Jump(9)),
        p.Instruction(p.LimitBegin(Constant(30)), "limit", 9, enters=("limit",)),
        p.Instruction(p.Wait(Constant(5)), "short", 10),
        p.Instruction(p.TryEnd(), "limit", 9, leaves=("limit",)),
        p.Instruction(p.End()),
    )
)
NUMBERS = {"try": "1", "mix": "1a", "cool": "2", "wait": "2a", "if": "3", "told": "3a", "limit": "5"}
SUBJECT = Subject(PLAN, demo_floor.scene(), (), NUMBERS, tuple(f"line {n}" for n in range(1, 11)))
WELL = Trial("Well", 1, (Expectation("ends", 2, "well"), Expectation("within_s", 3, 400.0)))
BROKEN = Trial(
    "The mixer fails", 5, (Expectation("ends", 6, "well"),), faults=(Fault("paintMixer02", "fail_next"),)
)  # fmt: skip
