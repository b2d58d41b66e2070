"""What each check means, in a sentence for its page, and the order in which the page shows them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

_ENTERED: Final = {
    "missing_quantity": "A Pick, a Drop or a Pick-and-Drop does not say how many.",
    "missing_object": "It does not say what is carried; the machine's own objects are offered.",
    "missing_source": "It does not say at which machine the robot picks up.",
    "missing_target": "It does not say at which machine the robot drops.",
    "missing_destination": "A Move does not say where to.",
    "missing_zone": "A Cover does not say which zone.",
    "missing_machine": "An Operate names no machine.",
    "missing_method": "An Operate does not say what the machine does.",
    "missing_own_method": "An Operate of a robot does not say which of its own methods is meant.",
    "missing_argument": "A method needs a value that is not there.",
    "missing_condition": "An If, a While, a Wait or an event has no whole condition.",
    "missing_seconds": "A Wait says neither how long nor for what.",
    "missing_function": "A Call names no function.",
    "missing_function_argument": "A Call leaves out a parameter that has no default.",
    "missing_times": "A Repeat does not say how often.",
    "missing_items": "A For-each has nothing to go through.",
    "missing_variable": "A Set names no variable.",
    "missing_value": "A Set has no value.",
    "missing_question": "An Ask has no question.",
    "missing_options": "An Ask for a choice offers fewer than two answers.",
    "missing_message": "A Notify says nothing.",
    "missing_limit": "A Time limit does not say how long its steps may take.",
    "missing_reason": "A Fail does not say why.",
    "empty_program": "Nothing is joined to the beginning.",
}
_UNKNOWN: Final = {
    "unknown_device": "A step or a value names a device that the site does not have.",
    "unknown_place": "A step names a place that the map does not have.",
    "unknown_method": "The device's description does not list this method.",
    "unknown_property": "The device's description does not list this property.",
    "unknown_argument": "The method or the function has no parameter of this name.",
    "unknown_function": "The function that is called was deleted.",
    "problem_outside_catch": "A step asks why something failed where nothing was caught.",
    "unknown_parameter": "A value names a variable or a parameter that nothing sets and nobody gives.",
    "unknown_role": "The step's robot was deleted from the program; it is read as the robot that every program has.",
    "unknown_kind": "A newer version of VIPO, or another program, has drawn this step.",
    "odd_shape": "Another program wrote a function, role, parameter or zone into the document that has not its shape.",
    "long_id": "Another program drew this step under an id that no line of a run has room for.",
    "odd_position": "Another program wrote something else than two numbers in metres.",
    "newer_format": "The document was written by a newer version; nothing in it is changed.",
}
_DEVICES: Final = {
    "pending_device": "The device has announced itself, and nobody has approved it yet.",
    "retired_device": "The device was taken out of use.",
    "not_a_robot": "A role is bound to a device that is no robot.",
    "robot_as_place": "A pick or a drop happens at machines only.",
    "robot_as_goal": "A robot stands beside machines and at places; where another robot is, nobody can say.",
    "may_not_fit": "A variable may hold several devices or places here, and one of them cannot be meant.",
    "cannot_do": "The robot of this role lacks a method that its steps need.",
    "too_few_robots": "A role keeps its robot until the program ends or releases it: each role of a path needs one.",
    "no_robot_can": "No approved robot has all the methods that the role needs.",
    "not_given": "The machine does not list this object among those that it gives.",
    "not_taken": "The machine does not list this object among those that it takes.",
    "offline_device": "No message has come from the device lately; everything else about it is right.",
    "no_robot_offers": "No approved robot describes this method.",
    "no_robot_tells": "No robot that may take the role describes this property.",
    "readings_differ": "Robots that may take the role describe one property in different types or units.",
    "may_not_tell": "Some of the robots that may take the role do not describe this property.",
    "choice_looks_elsewhere": "The condition by which a robot is chosen reads variables, other devices, or places.",
    "never_chosen": "In the ranges that robots declare the condition by which one is chosen never holds.",
    "methods_differ": "Robots that may take the role describe one method with different parameters.",
    "step_of_its_own": "Move, Pick and Drop are steps: VIPO sees to the way and to what is carried.",
    "no_robot_online": "There are robots that could take this role, and all of them are offline.",
}
_VALUES: Final = {
    "wrong_type": "A text stands where a number is needed, or the like.",
    "not_comparable": "The two sides are of different types, or have no order.",
    "wrong_unit": "The two units measure different things, so neither can be converted into the other.",
    "temperature_or_difference": 'A program does not say whether `t - quantity(20, "°C")` lowers a temperature or '
    "takes one from another. Where a device reports what is taken away, it is a difference.",
    "difference_needs_kelvins": "What a function takes or gives in °C or °F is a temperature to whoever meets it "
    "there; in K temperatures and differences are counted alike.",
    "units_differ": "A variable may hold devices that count the same thing in different units. Which devices those are "
    "is what any step puts into it, or any call gives a parameter; if nothing says so, every device of the site that "
    "has the method, or, for a parameter of the program, reports this and has all else that the program uses of it.",
    "plain_number": "A number without a unit takes that of what it meets only where it is written out, as in "
    "`wait(30)`; a variable, a parameter and what is worked out say their unit.",
    "unit_not_taken": "How often, how many, and what a device takes without a unit are plain numbers; minutes "
    "divided by minutes are one, too.",
    "no_such_product": "Speed times time is a length, and a share of anything is one of its kind; minutes times "
    "minutes are nothing.",
    "divided_by_zero": "The divisor is 0, or a variable that is never anything else.",
    "may_divide_by_zero": "As far as variables are known here, the divisor may be 0.",
    "no_such_item": "The number is below 1, broken, or above the length of the list, however long that may be here.",
    "may_be_no_such_item": "As far as variables are known here, the list may be shorter than the number.",
    "not_in_a_list": "A list stands in a list, or a point or a zone does.",
    "mixed_list": "Items of one list are of different types.",
    "list_and_item": "A list and something that is none stand on the two sides of a plus.",
    "list_too_long": "A list that is written out has more than 1,000 items.",
    "may_be_out_of_range": "As far as variables are known here, the number may lie outside of what is declared.",
    "out_of_range": "The number is below or above what the description declares.",
    "not_an_option": "The description lists the values that are allowed.",
    "limit_not_positive": "With no time at all the limit strikes before the first step has done anything.",
    "quantity_not_positive": "Nobody can carry none, or half an object.",
    "quantity_above_capacity": "The largest robot that can take the role holds fewer.",
    "no_answer_fits": "The lowest number that an Ask takes is above the highest.",
    "times_not_whole": "A Repeat counts whole rounds.",
    "unknown_unit": "The unit is none of the list, so values in it cannot be converted.",
    "unknown_zone": "A value asks for a zone that was removed, or whose corners are not at least three.",
    "never_true_in_range": "The device declares a range, or options, in which the condition does not hold.",
    "always_true_in_range": "The device declares a range, or options, in all of which the condition holds.",
    "contradiction": "Each condition can hold alone, and all of them together cannot.",
    "waits_for_ever": "A Wait has no limit, and what it waits for cannot happen in the declared ranges.",
}
_CARRYING: Final = {
    "carrying_too_much": "Followed along all ways to this step, the robot is full on each of them.",
    "may_carry_too_much": "On one of the ways to this step the robot is full already.",
    "drops_nothing": "On every way to this step the robot carries less.",
    "may_drop_nothing": "On one of the ways to this step the robot carries less.",
    "releases_carrying": "A Release gives a robot back that carries something, which its next steps would not know.",
    "may_release_carrying": "On one of the ways to a Release its robot carries something.",
    "releases_nothing": "No step on one of the ways to a Release has given the role a robot.",
    "ends_carrying": "On every way to this end the robot carries something; the next program would find it full.",
}
_FLOOR: Final = {
    "place_outside": "The point lies off the map.",
    "place_blocked": "The clearance at the point is smaller than the robot's radius.",
    "place_unreachable": "No robot of the role finds a way from where it stands.",
    "station_unreachable": "No side of the machine has room for a robot of the role, or no way leads there.",
    "place_in_keep_out": "The goal, or the place beside the machine, lies in a zone that robots keep out of.",
    "route_blocked": "A robot drives over the points of a route one after the other. At this one no robot of the role "
    "fits, or no path leads there.",
    "route_in_keep_out": "A point of the route lies in a zone that robots keep out of.",
    "route_too_long": "A route has more points than a way may lead over.",
    "cover_in_keep_out": "The zone of a Cover is one that robots keep out of.",
    "cover_outside": "The zone of a Cover lies beside the map.",
    "cover_nothing": "The zone of a Cover holds no place where a robot can stand and to which a way leads.",
    "too_many_lanes": "A zone is covered in at most 1,000 lanes that are at most 10 km long together.",
    "lane_wider_than_zone": "The zone of a Cover is narrower than one lane; the robot drives once through its middle.",
    "zone_too_small": "The zone's area is smaller than that of the smallest robot.",
    "missing_door": "A zone with the rule for a passage has no door yet.",
    "door_cannot_open": "The device of a passage offers no method that opens it: one whose name says so (`open`, "
    "`openDoor`, `raise`) and that needs no values. The class of the device does not matter.",
    "passage_nowhere": "No robot of the site has room in the passage, or none finds a way there.",
    "door_left_open": "A step opens the door of a passage, and no step of the program closes it. What a step opens "
    "stays open for good: robots that pass close only what was opened for them.",
}
_WAYS: Final = {
    "never_reached": "The first step behind a Return, a Break, an End, an endless loop or an endless call.",
    "past_limit": "The waits up to here take at least as long as the Time limit around them allows, or what is waited "
    "for can never come true. So what follows in it is never come to, and it always fails as timed out.",
    "too_few_end": "Of a Parallel that ends with some of its branches fewer ever come to their end.",
    "never_ends": "The condition of a While is constantly true, and neither Break, Return nor End stands in it.",
    "may_never_end": "What the condition of a While looks at is neither measured nor set while it repeats.",
    "never_runs": "The condition is constantly false.",
    "always_true": "The condition is constantly true.",
    "calls_itself": "Every way through the function calls it again; a call that only some ways make is allowed.",
    "return_outside_function": "A Return stands in the program's own body.",
    "break_outside_loop": "A Break stands in no loop of its own function or branch.",
    "same_name": "In a For-each the item and the number of the round have one name; the number is not set then.",
    "continue_outside_loop": "A Next round stands in no loop of its own function or branch.",
    "leaves_parallel": "A Return, a Break or a Next round would leave one branch while the others go on.",
    "leaves_finally": "A Return, a Break or a Next round would leave the branch that is carried out whatever happens.",
    "catch_never_reached": "The catches before it take every kind of problem that this one takes.",
    "caught_before": "Two catches of a Try name one kind of problem; the first of them takes it.",
    "empty_branch": "An If with two empty branches, or a Repeat, a For-each or a Time limit without a step in it.",
    "over_at_once": "A Parallel that ends with some of its branches has so many that begin nothing that takes time.",
    "busy_circle": "A While waits for what is measured, and no step in it takes time or changes what it looks at.",
    "starts_unasked": "A parameter has no default, and an event starts the program without anybody who enters a value.",
    "draft": "The step is drawn and not joined.",
    "too_deep": "More than 30 levels lie above the step.",
}
_FUNCTIONS: Final = {
    "gives_nothing": "A Call takes a value, and the function has no result.",
    "returns_unasked": "A Return has a value, and its function has no result.",
    "no_value_on_some_way": "The function has a result, and a way through it ends without one.",
    "unused_result": "The function has a result, and the Call does not take it.",
    "unused_function": "Neither the program, an event nor a function that they call calls it.",
    "unused_variable": "A Set, an Ask or a Call sets it, and no value reads it.",
    "unused_parameter": "A parameter of the program or of a function that no value reads.",
    "unset_variable": "No way to this step sets the variable.",
    "no_robot_yet": "A role that any robot may have gets its robot with its first step; before, it has no place.",
    "perhaps_no_robot_yet": "Some ways to this step let the role do something before, and others do not.",
    "may_be_unset": "Some ways to this step set the variable and others do not.",
    "version_gone": "The function was copied from a version that the library no longer has.",
    "newer_version": "The library has a newer version that is compatible: what calls this one may call it.",
    "signature_changed": "The library has a newer version that is breaking: calls and devices have to be looked at.",
}
_AT_ONCE: Final = {
    "needed_out_of_range": "A Parallel is to end with more branches than it has, or with none.",
    "released_beside": "One branch of a Parallel releases a role that another uses, or releases, too.",
    "shared_robot": "Two branches of a Parallel, with the functions that they call, drive one robot.",
    "event_shares_robot": "An event that runs beside the program drives a robot that the program drives, too.",
    "branches_set_it": "Two branches run at once and set one variable; the slower one wins, whichever that is.",
    "loses_update": "A variable is worked out from its value of some time ago, and something beside sets it.",
    "branches_wait": "Each of two branches waits for a variable that only the other one sets, after its own waiting.",
}
_SCRIPTS: Final = {
    "not_python": "The text of a script is not Python, or not whole.",
    "not_in_language": "It is Python outside the closed part that VIPO reads; nothing of it is ever run.",
    "more_mistakes": "A script has more than 20 mistakes; the others are only counted.",
}
_SECTIONS: Final = (
    ("Still to be entered", _ENTERED),
    ("Does not exist", _UNKNOWN),
    ("Devices and robots", _DEVICES),
    ("Values", _VALUES),
    ("What is carried", _CARRYING),
    ("The floor", _FLOOR),
    ("Ways through the program", _WAYS),
    ("Functions and variables", _FUNCTIONS),
    ("Things that happen at once", _AT_ONCE),
    ("Scripts written by hand", _SCRIPTS),
)
EXPLANATIONS: Final[Mapping[str, str]] = {code: text for _, section in _SECTIONS for code, text in section.items()}
GROUPS: Final = tuple((title, tuple(section)) for title, section in _SECTIONS)
