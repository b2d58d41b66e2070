"""Why runs and calls end, wait for people or fail: which sentence it is, for screens in other languages; pure.

Reasons go through the machine, the floor and the database as English sentences, beside the words of devices, which are
kept as they are. Each of VIPO's own has a code and a pattern here, and is taken apart by it, in old rows, too. It ends
with a full stop; those that say why a run was paused or cancelled stand behind a colon and have none.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from editor.language.messages.sentences import Sentences

SAID = "said"
SENTENCES: Mapping[str, str] = {
    "paused_by": "{by} paused it",
    "cancelled_by": "{by} cancelled it",
    "stopped_by": "{by} stopped all devices of the site",
    "approval_gone": "When its time came, approvals that the site demands were missing",
    "set_aside": "Something could not be taken in and was set aside for an admin: {error}",
    "branch_failed": "Another branch failed.",
    "enough_ended": "Enough other branches have ended.",
    "program_over": "The program was over.",
    "condition_late": "The condition did not come true in time.",
    "limit_over": "The time limit of {seconds} s was over.",
    "negative_limit": "The time limit is {seconds} s; it cannot be less than nothing.",
    "unanswered": "Nobody answered in time.",
    "too_many_branches": "More than {count} branches would run at once.",
    "too_deep": "“{function}” calls itself more than {count} times deep.",
    "negative_wait": "It is told to wait {seconds} s; a wait cannot be less than nothing.",
    "no_lanes": "The lanes are {width} m wide; they must be wider than nothing.",
    "zone_gone": "The zone is not there any more; choose another one.",
    "not_covered": "{robot} cannot cover {zone}. {why}",
    "nothing_covered": "{robot} has found no way to any part of {zone}.",
    "no_quantity": "The quantity is {quantity}; it must be more than nothing.",
    "blocked_too_long": "{robot} has been blocked by {others} for too long.",
    "not_done": "{device} did not do it.",
    "went_offline": "{device} went offline and did not come back.",
    "took_too_long": "{device} took too long.",
    "no_answer": "The device did not answer in time. Look whether it is switched on and connected.",
    "late": "The device took longer than it may. Look what it is doing.",
    "no_able_robot": "No robot of this site can {methods}. Approve one that can, or change the role.",
    "door_shut": "{door} did not open in time.",
    "no_door": "{door} is no approved device that can be told to open.",
    "no_way": "There is no way for {robot} to {target}.",
    "zones_shut": "Zones leave no way for {robot} to {target}. Change a zone on the map, or choose another place.",
    "body_stands": (
        "The real {body} stands where {robot} has to pass to {target}. Let it be moved, or use the real one again."
    ),
    "no_turning": (
        "{robot} stands where it has no room to turn: it needs {room} m to all sides. "
        "Drive it by hand to about ({point})."
    ),
    "cut_off": "No way leads to where {robot} stands. Drive it by hand to about ({point}).",
    "no_standing": (
        "No robot can stand at {place}; there is no free side that it can reach. The map's floor check says why."
    ),
    "no_room": "A robot cannot stand at ({point}); choose a place with more room.",
    "not_reached": "No robot can reach ({point}).",
    "no_spot": "There is no device or place called “{name}” on this site.",
    "nothing_handed": "Nothing can be handed over at {place}; choose a device.",
    "no_device": "There is no approved device called “{device}” on this site.",
    "no_method": "{device} cannot {method}; it offers no such method.",
    "own_step": "{device} does {method} only as a step of its own.",
    "by_hand": "{device} does {method} only by hand, while no run is open.",
    "offline": "{device} is offline.",
    "undone": "The step was not done.",
    "unsaid": "The program failed here and does not say why.",
    "no_map": "This site has no map yet. Upload one, or take one from a robot.",
    "map_too_large": "The map is {width} x {height} m with {floor} m² of floor; {most_floor} m² of floor and {most} m² "
    "in all are the most. Check its resolution (metres a cell), or cut it.",
    "no_place": "That is not a place: give a device, a place or a point [x, y].",
    "list_for_value": "A list stands where one value is needed.",
    "nested": "An expression is nested too deeply.",
    "no_value": "There is no value called “{name}” here.",
    "unit_left": "A number still has its unit. Compile the program again.",
    "no_truth": "The condition gives {value} where yes or no is needed.",
    "not_reported": "{device} has not reported its {property} yet.",
    "no_robot_yet": "No robot has the role {role} yet.",
    "point_for_value": "A point or a zone stands where one value is needed.",
    "no_thing": "{value} stands where a device or a place is needed.",
    "where_unknown": "It is not known yet where {thing} is.",
    "wrong_arguments": "“{name}” cannot be worked out from {count} value(s).",
    "no_clock": "The time of day is not known yet.",
    "text_too_long": "A text has more than {count} characters.",
    "no_zone": "There is no zone {zone}.",
    "unfit_value": "“{name}” is not something that can be worked out from one value.",
    "no_operator": "“{name}” is not an operator of this language.",
    "in_needs_list": "“in” needs a list or a text on its right.",
    "no_item": "There is no item {number}: the list has {count}.",
    "list_too_long": "A list has more than {most} items.",
    "needs_list": "{value} stands where a list is needed.",
    "zero_divisor": "A number is divided by zero.",
    "no_number": "{value} stands where a number is needed.",
    "too_large": "A number has grown beyond all measure.",
    "rehearsal_cancelled": "{by} cancelled the rehearsal.",
    "rehearsal_died": "The process that rehearsed it has died. Start it again.",
    "rehearsal_frozen": "The process that rehearsed it gave no sign for {seconds} s and was ended. Start it again.",
    "rehearsal_late": "It was ended after {minutes} min, at {reached} s of simulated time; it may never end.",
    "rehearsal_memory": "It needs more than {megabytes} MB of memory. Rehearse a smaller part of the program.",
    "rehearsal_broke_off": "The rehearsal broke off: {words}",
}


_sentences = Sentences(SENTENCES)


def cause_of(reason: str) -> dict[str, Any] | None:
    """Return `{code, args}` of a reason; other words, such as a device's own, have the code `said`. None for none."""
    if not reason:
        return None
    if found := _sentences.find(reason):
        return {"code": found[0], "args": found[1]}
    return {"code": SAID, "args": {"words": reason}}
