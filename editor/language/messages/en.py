"""The sentences of the checks, by code; `de.py` has them in German by the same codes and arguments."""

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
    "missing_own_method": ("error", "Choose what the robot does: {options}."),
    "missing_argument": ("error", "Enter {argument} for {method}{range}."),
    "missing_condition": ("error", "Enter the condition that decides."),
    "missing_seconds": ("error", "Enter how long to wait, in seconds, or what to wait for."),
    "missing_function": ("error", "Choose the function to call."),
    "missing_function_argument": ("error", "Enter {argument} for {function}."),
    "missing_times": ("error", "Enter how many times to repeat these steps."),
    "missing_items": ("error", "Enter what to go through, one after the other."),
    "missing_variable": ("error", "Give the variable a name."),
    "missing_value": ("error", "Enter the value."),
    "missing_question": ("error", "Enter what to ask."),
    "missing_options": ("error", "Enter at least two answers to choose from."),
    "missing_message": ("error", "Enter what to tell people."),
    "missing_limit": ("error", "Enter how long the steps in it may take, such as 5 min."),
    "missing_reason": ("error", "Enter why it fails here, such as \"The box is wet.\"."),
    "empty_program": ("error", "This program has no steps yet. Draw a Pick-and-Drop to begin."),
    # it speaks of something that does not exist
    "unknown_device": ("error", "There is no device {device} on this site. Choose another."),
    "unknown_place": ("error", "There is no place {place} on this map. Choose another."),
    "unknown_method": ("error", "{device} cannot {method}. It can: {options}."),
    "unknown_property": ("error", "{device} does not report {property}. It reports: {options}."),
    "unknown_argument": ("error", "{method} does not take {argument}. It takes: {options}."),
    "unknown_function": ("error", "This function no longer exists. Choose another."),
    "problem_outside_catch": ("error", "{parameter} is known only in the catch of a Try. Move the step there."),
    "unknown_parameter": ("error", "There is no value called {parameter} here. Choose or enter another."),
    "unknown_role": ("error", "This program has no robot called {role}. Choose another."),
    "unknown_kind": ("error", "This step is of a kind that this version of VIPO does not know. Delete it."),
    "odd_shape": ("error", "{part} has not its shape, so it is read without that. Enter it anew, or take it out."),
    "long_id": ("error", "The id of this step has more than {most} characters. Copy the step and delete this one."),
    "odd_position": ("warning", "The start has no position that can be read. Move it to where it belongs."),
    "newer_format": ("error", "This program was made with a newer VIPO. Update this one to run it."),
    # it cannot ever work
    "pending_device": ("error", "{device} waits for approval. An admin can approve it in the registry."),
    "retired_device": ("error", "{device} is no longer in use. Choose another."),
    "not_a_robot": ("error", "{device} is not a robot. Choose a robot for {role}."),
    "robot_as_place": ("error", "{device} is a robot and can neither give nor take objects. Choose a machine."),
    "robot_as_goal": ("error", "{device} is a robot and may be anywhere. Choose a machine, a place or a point."),
    "may_not_fit": ("warning", "On one of the ways to this step this is {device}, which does not fit here."),
    "cannot_do": ("error", "{device} cannot {method}. Choose a robot that can."),
    "too_few_robots": ("error", "{roles} need a robot each at the same time, and there are {count}. Let one do both."),
    "no_robot_can": ("error", "No robot on this site can {methods}."),
    "no_robot_offers": ("error", "No robot on this site can {method}. Robots here can: {options}."),
    "methods_differ": ("error", "{first} and {second} take different values for {method}. Choose one robot."),
    "no_robot_tells": ("error", "No robot that may be {role} reports {property}. Robots here report: {options}."),
    "readings_differ": (
        "error",
        "{first} and {second} report {property} in kinds or units that differ. Choose one robot.",
    ),
    "may_not_tell": (
        "warning",
        "{device} may be {role} and does not report {property}; then this fails. Choose one robot.",
    ),
    "choice_looks_elsewhere": (
        "error",
        "Who {role} is may depend only on what the robot itself reports. Take all else out of the condition.",
    ),
    "never_chosen": (
        "error",
        "No robot ever meets the condition for {role}, so the program would wait for ever. Change it.",
    ),
    "step_of_its_own": ("error", "{method} is a step of its own: it knows the way. Draw that step instead."),
    "not_given": ("error", "{device} does not give {object}. It gives: {options}."),
    "not_taken": ("error", "{device} does not take {object}. It takes: {options}."),
    "wrong_type": ("error", "{subject} needs {wanted}, and this is {given}."),
    "not_comparable": ("error", "{left} and {right} cannot be compared by {operator}."),
    "wrong_unit": ("error", "{subject} is in {wanted}, and this value is in {given}."),
    "temperature_or_difference": (
        "error",
        "This may be a temperature or a difference of two, and then {given} goes over into {wanted} in another way. "
        "Use one unit for both.",
    ),
    "difference_needs_kelvins": (
        "error",
        "{subject} is in {wanted}, where this difference would be taken for a temperature. Declare it in K.",
    ),
    "units_differ": (
        "error",
        "{first} counts {name} in {wanted}, {second} in {given}. Name one device, give each sort a "
        "step of its own, or have both described in one unit.",
    ),
    "plain_number": ("error", "{subject} is in {wanted}, and this is a plain number. Say its unit."),
    "unit_not_taken": ("error", "{subject} is a plain number, and this value is in {given}. Say what it counts in."),
    "no_such_product": ("error", "{left} {operator} {right} measures nothing. Use a plain number for one of them."),
    "divided_by_zero": ("error", "This divides by 0. Enter another number, or check it first."),
    "may_divide_by_zero": ("warning", "This divides by 0 on one of the ways to this step. Check the number first."),
    "no_such_item": ("error", "The list has no item with this number. Items are counted from 1."),
    "may_be_no_such_item": (
        "warning",
        "The list may have no item with this number here. Compare the number with len(…) first.",
    ),
    "not_in_a_list": ("error", "A list holds numbers, texts, yes or no, devices or places, but not {given}."),
    "mixed_list": ("error", "The items of a list are all of one type, and here are {left} and {right}."),
    "list_and_item": ("error", "{left} and {right} cannot be put together. Write square brackets around the item."),
    "list_too_long": ("error", "The list has {count} items, and at most 1000 are possible. Make several lists of it."),
    "may_be_out_of_range": ("warning", "{subject} must be {range}, and may lie outside here. Check it first."),
    "out_of_range": ("error", "{subject} must be {range}."),
    "not_an_option": ("error", "{subject} is one of: {options}."),
    "limit_not_positive": ("error", "A time limit must be longer than 0 s. Enter how long the steps in it may take."),
    "quantity_not_positive": ("error", "The quantity must be a whole number above 0."),
    "quantity_above_capacity": ("error", "{robot} carries {range} at a time. Enter less, or go twice."),
    "no_answer_fits": ("error", "No number is both at least {least} and at most {most}. Change the limits."),
    "carrying_too_much": ("error", "{robot} already carries {carried} here and holds {capacity} at most."),
    "may_carry_too_much": ("warning", "{robot} may already carry too much here. It holds {capacity} at most."),
    "drops_nothing": ("error", "{robot} carries {carried} {object} here and cannot drop {quantity}."),
    "may_drop_nothing": ("warning", "{robot} carries less than {quantity} {object} on one of the ways to this step."),
    "ends_carrying": ("warning", "{robot} still carries {quantity} {object} when the program ends here. Drop it."),
    "releases_carrying": (
        "error",
        "{robot} still carries {quantity} {object} here. Drop it before you release the robot.",
    ),
    "may_release_carrying": (
        "warning",
        "{robot} still carries {object} on one of the ways to this step. Drop it before you release the robot.",
    ),
    "releases_nothing": (
        "warning",
        "{role} has no robot yet on one of the ways to this step. Move it behind the steps of the robot, or delete it.",
    ),
    "released_beside": (
        "error",
        "Branch {first} releases {robot}, which branch {second} uses. Release it behind the Parallel.",
    ),
    "place_outside": ("error", "This place is outside the map. Move it inside."),
    "place_blocked": ("error", "{robot} does not fit here: a wall or a machine is too near."),
    "place_unreachable": ("error", "{robot} finds no way to this place."),
    "calls_itself": ("error", "{function} calls itself on every way through it and would never end."),
    "times_not_whole": ("error", "How many times must be a whole number, 0 or more."),
    "return_outside_function": ("error", "Only a function can give something back. End the program instead."),
    "break_outside_loop": ("error", "There is no loop around this step that could be left."),
    "same_name": ("error", "The number of the round needs another name than the item, {variable}."),
    "continue_outside_loop": (
        "error",
        "There is no loop around this step that could go on with its next round. Put it into one, or delete it.",
    ),
    "leaves_parallel": ("error", "This step would leave a branch of a Parallel. Let the branch come to its end."),
    "leaves_finally": ("error", "This step would leave a Finally, which is always carried out whole."),
    "gives_nothing": ("error", "{function} gives nothing back. Take no value from it, or give it a result."),
    "returns_unasked": ("error", "{function} has no result. Give it one, or remove this value."),
    "needed_out_of_range": ("error", "Enter how many branches end it: a whole number from 1 to {count}."),
    "too_few_end": (
        "error",
        "This needs {needed} of its branches to end, and not so many ever do, so it goes on for ever. Let more of them "
        "end.",
    ),
    "shared_robot": ("error", "Branches {first} and {second} both drive {robot}. Give one of them another robot."),
    # it works, but perhaps not as it is meant
    "offline_device": ("warning", "{device} is offline. The program can run when it is back."),
    "no_robot_online": ("warning", "No robot that can {methods} is online. The program can run when one is back."),
    "may_never_end": ("warning", "Nothing measured decides here, so these steps may repeat without end."),
    "never_runs": ("warning", "This condition is never true, so these steps never run."),
    "always_true": ("warning", "This condition is always true, so the other branch never runs."),
    "catch_never_reached": (
        "warning",
        "The catches before this one take all of its problems, so it never runs. Choose others for it, or remove it.",
    ),
    "caught_before": (
        "warning",
        "A catch before this one takes some of its problems. Choose each of them in one catch only.",
    ),
    "empty_branch": ("warning", "This holds no steps, so it does nothing. Draw steps into it, or delete it."),
    "over_at_once": (
        "warning",
        "This is over at once and calls the other branches off, for some take no time: {branches}. Draw steps into "
        "them that do.",
    ),
    "busy_circle": ("warning", "This waits by going round and round. Use a Wait until for what it waits for."),
    "draft": ("warning", "This step is joined to nothing and will not run. Join it or delete it."),
    "too_deep": ("warning", "This step lies too deep inside others and will not run. Make a function of some of them."),
    # the ways through a program
    "never_reached": (
        "warning",
        "This step is never reached: what comes before it always ends here or goes on for "
        "ever.",
    ),
    "past_limit": (
        "warning",
        "The time limit around this is always over before this is done. Give the limit more time, or shorten this.",
    ),
    "never_ends": ("error", "These steps repeat for ever: the condition is always true and no step leaves the loop."),
    "no_value_on_some_way": (
        "error",
        "{function} gives a value, but not on every way. End this way with a Return that has "
        "one.",
    ),
    "unused_result": ("warning", "What {function} gives is not kept. Choose a variable for it."),
    "unused_function": ("warning", "Nothing calls {function}, so its steps never run."),
    "unused_variable": ("warning", "{variable} is set here and never used."),
    "unused_parameter": ("warning", "{parameter} is asked for and never used."),
    "unset_variable": ("error", "{variable} has no value yet here. Set it before."),
    "may_be_unset": ("warning", "{variable} has no value yet on one of the ways to this step. Set it before."),
    "no_robot_yet": ("error", "The role {role} has no robot yet here. Let it do a step before, or choose a robot."),
    "perhaps_no_robot_yet": (
        "warning",
        "The role {role} has no robot yet on one of the ways to this step. Let it do a step before.",
    ),
    "starts_unasked": (
        "warning",
        "This starts by itself, when nobody is asked for {parameters}. Give a default, or it cannot be armed.",
    ),
    "event_shares_robot": (
        "warning",
        "This runs beside the program, and both drive {robot}. Give one of them another "
        "robot.",
    ),
    "branches_set_it": (
        "warning",
        "Branches {first} and {second} both set {variable}, and nobody knows which of them is the last. Let each set "
        "its own.",
    ),
    "loses_update": (
        "warning",
        "This sets {variable} from what it was before. What is set beside it meanwhile is lost; read it anew.",
    ),
    "branches_wait": (
        "error",
        "Branches {first} and {second} wait for each other, for {variable} and {other}. Set "
        "one of them before waiting.",
    ),
    # functions of the library
    "version_gone": (
        "warning",
        "Version {version} of {function} is no longer in the library. The copy in this "
        "program still works.",
    ),
    "newer_version": (
        "warning",
        "The library has version {newest} of {function}; this program uses version "
        "{version}.",
    ),
    "signature_changed": (
        "warning",
        "Version {newest} of {function} in the library does not fit as it is: it takes other values, gives back "
        "another, or needs other devices. It takes: {parameters}. Look at it in the library before you bring it in.",
    ),
    # values: units, zones and ranges
    "unknown_unit": ("error", "{unit} is not a unit that VIPO knows. Choose another."),
    "unknown_zone": ("error", "There is no zone {zone} in this program. Draw it, or choose another."),
    "never_true_in_range": ("warning", "{property} of {device} is always {range}, so this is never true."),
    "always_true_in_range": ("warning", "{property} of {device} is always {range}, so this is always true."),
    "contradiction": ("warning", "These conditions exclude each other, so this is never true."),
    "waits_for_ever": ("error", "This never comes true, so the program waits for ever. Change it, or enter a limit."),
    # machines on the floor, and zones
    "station_unreachable": (
        "error",
        "{robot} finds no way to {device}, or no room to stand beside it. The map's floor check says why.",
    ),
    "place_in_keep_out": (
        "error",
        "This place lies in {zone}, which robots keep out of. Choose another, or change the "
        "zone.",
    ),
    "route_too_long": ("error", "This way has {count} points, and {most} are the most. Take some of them out."),
    "missing_zone": ("error", "Choose the zone that {robot} is to cover."),
    "cover_in_keep_out": ("error", "{zone} is a zone that robots keep out of. Choose another, or change its rule."),
    "cover_outside": ("error", "{zone} is off the map. Draw it on the map."),
    "cover_nothing": (
        "error",
        "{robot} cannot stand anywhere in {zone}, or finds no way there. Draw it where there is free floor.",
    ),
    "too_many_lanes": ("error", "{zone} is too large for such narrow lanes. Make them wider, or the zone smaller."),
    "lane_wider_than_zone": (
        "warning",
        "{zone} is narrower than a lane, so {robot} drives once through its middle. Make the zone wider.",
    ),
    "route_blocked": (
        "error",
        "{robot} cannot drive over point {number} of this way: it is too near to a wall or a machine, off the map, or "
        "no way leads there. Move the point.",
    ),
    "route_in_keep_out": (
        "error",
        "Point {number} of this way lies in {zone}, which robots keep out of. Move the point, or change the zone.",
    ),
    "zone_too_small": ("warning", "{zone} is smaller than {robot}, so it has no effect. Make it larger."),
    "missing_door": ("error", "Choose the door that opens for robots at {zone}."),
    "door_cannot_open": (
        "error",
        "{device} cannot be told to open, which {zone} needs: a method named so, without values to enter. It can: "
        "{options}.",
    ),
    "passage_nowhere": ("warning", "No robot drives through {zone}, so its door never opens. Move it to the doorway."),
    "door_left_open": (
        "warning",
        "No step closes {device} again, so it stays open. Close it, or leave this out: it opens for robots by itself.",
    ),
    # a script that was written by hand
    "not_python": ("error", "Line {line}, column {column}: this cannot be read. {detail}"),
    "not_in_language": ("error", "Line {line}, column {column}: {found} is not part of the language. {instead}"),
    "more_mistakes": ("error", "There is more to mend from line {line} on: {count}. Begin with the first ones."),
}  # fmt: skip

FIX_TEXTS: Final[Mapping[str, str]] = {
    "set_to": "Set to {value}",
    "take_in": "Take it in {value}",
    "number_of": "Take the number of {value}",
    "choose": "Choose {value}",
    "remove": "Remove {value}",
    "join_at_end": "Join it at the end of the program",
    "delete_step": "Delete the step",
    "all_branches": "Wait for all branches",
    "own_robot": "Give branch {value} a robot of its own",
    "use_version": "Use version {value}",
    "take_out": "Take out what cannot be read",
    "make_end": "End the program instead",
}

NOT_NOW: Final = frozenset({"pending_device", "offline_device", "no_robot_online"})
"""What keeps a program from running only as the site is now; everything else holds for ever."""
