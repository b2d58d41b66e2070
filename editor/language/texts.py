"""The sentences of the checks, by code; `texts_de.py` has them in German by the same codes and arguments."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, Literal

Text = tuple[Literal["error", "warning"], str]

TEXTS: Final[Mapping[str, Text]] = {
    # something is still to be entered
    "missing_quantity": ("error", "Enter how many {things} to carry. {robot} carries {range} at a time."),
    "missing_object": ("error", "Choose what to carry: {options}."),
    "missing_source": ("error", "Choose where the robot picks up."),
    "missing_target": ("error", "Choose where the robot drops."),
    "missing_destination": ("error", "Choose where the robot goes."),
    "missing_machine": ("error", "Choose the machine that does this."),
    "missing_method": ("error", "Choose what {device} does: {options}."),
    "missing_argument": ("error", "Enter {argument} for {method}{range}."),
    "missing_condition": ("error", "Enter the condition that decides."),
    "missing_seconds": ("error", "Enter how long to wait, in seconds, or what to wait for."),
    "missing_function": ("error", "Choose the function to call."),
    "missing_function_argument": ("error", "Enter {argument} for {function}."),
    "empty_program": ("error", "This program has no steps yet. Draw a Pick-and-Drop to begin."),
    # it speaks of something that does not exist
    "unknown_device": ("error", "There is no device {device} on this site. Choose another."),
    "unknown_place": ("error", "There is no place {place} on this map. Choose another."),
    "unknown_method": ("error", "{device} cannot {method}. It can: {options}."),
    "unknown_property": ("error", "{device} does not report {property}. It reports: {options}."),
    "unknown_argument": ("error", "{method} does not take {argument}. It takes: {options}."),
    "unknown_function": ("error", "This function no longer exists. Choose another."),
    "unknown_parameter": ("error", "There is no value called {parameter} here. Choose or enter another."),
    "unknown_role": ("error", "This program has no robot called {role}. Choose another."),
    "unknown_kind": ("error", "This step is of a kind that this version of VIPO does not know. Delete it."),
    # it cannot ever work
    "pending_device": ("error", "{device} waits for approval. An admin can approve it in the registry."),
    "retired_device": ("error", "{device} is no longer in use. Choose another."),
    "not_a_robot": ("error", "{device} is not a robot. Choose a robot for {role}."),
    "robot_as_place": ("error", "{device} is a robot and can neither give nor take objects. Choose a machine."),
    "cannot_do": ("error", "{device} cannot {method}. Choose a robot that can."),
    "no_robot_can": ("error", "No robot on this site can {methods}."),
    "not_given": ("error", "{device} does not give {object}. It gives: {options}."),
    "not_taken": ("error", "{device} does not take {object}. It takes: {options}."),
    "wrong_type": ("error", "{subject} needs {wanted}, and this is {given}."),
    "not_comparable": ("error", "{left} and {right} cannot be compared by {operator}."),
    "wrong_unit": ("error", "{subject} is in {wanted}, and this value is in {given}."),
    "out_of_range": ("error", "{subject} must be {range}."),
    "not_an_option": ("error", "{subject} is one of: {options}."),
    "quantity_not_positive": ("error", "The quantity must be a whole number above 0."),
    "quantity_above_capacity": ("error", "{robot} carries {range} at a time. Enter less, or go twice."),
    "carrying_too_much": ("error", "{robot} already carries {carried} here and holds {capacity} at most."),
    "may_carry_too_much": ("warning", "{robot} may already carry too much here. It holds {capacity} at most."),
    "drops_nothing": ("error", "{robot} carries {carried} {object} here and cannot drop {quantity}."),
    "may_drop_nothing": ("warning", "{robot} carries less than {quantity} {object} on one of the ways to this step."),
    "place_outside": ("error", "This place is outside the map. Move it inside."),
    "place_blocked": ("error", "{robot} does not fit here: a wall or a machine is too near."),
    "place_unreachable": ("error", "{robot} finds no way to this place."),
    "calls_itself": ("error", "{function} calls itself on every way through it and would never end."),
    "shared_robot": ("error", "Branches {first} and {second} both drive {robot}. Give one of them another robot."),
    # it works, but perhaps not as it is meant
    "offline_device": ("warning", "{device} is offline. The program can run when it is back."),
    "no_robot_online": ("warning", "No robot that can {methods} is online. The program can run when one is back."),
    "may_never_end": ("warning", "Nothing measured decides here, so these steps may repeat without end."),
    "never_runs": ("warning", "This condition is never true, so these steps never run."),
    "always_true": ("warning", "This condition is always true, so the other branch never runs."),
    "draft": ("warning", "This step is joined to nothing and will not run. Join it or delete it."),
    "too_deep": ("warning", "This step lies too deep inside others and will not run. Make a function of some of them."),
    # a script that was written by hand
    "not_python": ("error", "Line {line}: this is not complete. {detail}"),
    "not_in_language": ("error", "Line {line}: {found} is not part of the language. {instead}"),
}  # fmt: skip

FIX_TEXTS: Final[Mapping[str, str]] = {
    "set_to": "Set to {value}",
    "choose": "Choose {value}",
    "remove": "Remove {value}",
    "join_at_end": "Join it at the end of the program",
    "delete_step": "Delete the step",
    "own_robot": "Give branch {value} a robot of its own",
    "use_version": "Use version {value}",
    "make_end": "End the program instead",
}

NOT_NOW: Final = frozenset({"pending_device", "offline_device", "no_robot_online"})
"""What keeps a program from running only as the site is now; everything else holds for ever."""
