"""Doors that robots pass: opened when one comes, held open while any is in or soon in, closed when nobody is.

A zone with the rule `door` is the passage of a door. What one run has said of a passage holds for every robot of the
site as long as anything moves there, whatever it drives for: a door does not ask whose program it is.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from execution.traffic.floor_state import Door, FloorState, Robot, Sent
from execution.traffic.messages import DoorStuck, FloorZone
from execution.traffic.outlines import touches
from execution.traffic.turn import Turn
from execution.traffic.zones import cells_of, is_in
from vipo_device.protocol.doors import DoorMethods, door_methods

AHEAD_NODES = 8
"""So many nodes before the passage its door is asked to open, so that a robot need not stop."""
HOLD_S = 5.0
"""How long a door stays open for the next robot."""
ANSWER_LIMIT_S = 30.0
RETRY_S = 5.0
CLOSE_AGAIN_S = 60.0
"""How long after it has failed to close a door is told so again."""
WAIT_LIMIT_S = 60.0
"""How long a door may take to open before the tasks fail that wait for it."""
SETTLE_S = 1.0
"""For so long after a door has moved its reading may still tell how it stood before."""
REST_S = 20.0


def learn_passages(turn: Turn, run: str, zones: tuple[FloorZone, ...]) -> None:
    """Take in what a run says of passages, in the place of what its program said before.

    What another open run tells of stays: its program may be another version of the same, and its robots are under way.
    """
    programs = {_program(zone) for zone in zones}
    new = [zone for zone in zones if zone.rule == "door" and zone.door]
    kept = [
        zone
        for zone in turn.passages
        if zone not in new and (_program(zone) not in programs or _is_told(turn, zone, but_by=run))
    ]
    turn.passages = (*kept, *new)


def _is_told(turn: Turn, zone: FloorZone, but_by: str) -> bool:
    """Tell whether another open run tells of a zone."""
    return any(zone in zones for run, zones in turn.zones.items() if run != but_by)


def _program(zone: FloorZone) -> str:
    return zone.key.partition("/")[0]


def keep_doors(turn: Turn) -> None:
    """Look at every door: who needs it, how it stands, and what it is to be told."""
    _forget_passages(turn)
    for device in dict.fromkeys([*(zone.door for zone in turn.passages), *turn.doors]):
        methods = methods_of(turn, device)
        if methods is None:
            turn.doors.pop(device, None)
            continue
        door = turn.doors.get(device, Door(device))
        door = _look(turn, replace(door, robots=_users(turn, device)), methods)
        turn.doors[device] = door
        if not turn.stopped and device not in turn.offline and device not in turn.calls and not door.command:
            _tell(turn, door, methods)


def doors_of(state: FloorState, zones: Iterable[FloorZone] = ()) -> frozenset[str]:
    """Return the devices whose reading the floor must know, with these zones beside those that it knows."""
    return frozenset(zone.door for zone in (*state.passages, *zones) if zone.door).union(state.doors)


def methods_of(turn: Turn, device: str) -> DoorMethods | None:
    """Return how a device is opened; None: it is not approved, or cannot be."""
    description = turn.layout.devices.get(device)
    return door_methods(description) if description is not None else None


def _forget_passages(turn: Turn) -> None:
    """Forget the passages of runs that are over, once the floor rests and their doors are as they were."""
    rests = not turn.tasks and all(
        turn.is_idle(robot) and turn.now - robot.idle_since > REST_S for robot in turn.robots.values() if robot.path
    )
    if rests:
        told = {zone.key for zones in turn.zones.values() for zone in zones}
        held = {door.id for door in turn.doors.values() if door.ours or door.command}
        turn.passages = tuple(zone for zone in turn.passages if zone.key in told or zone.door in held)
    named = {zone.door for zone in turn.passages}
    turn.doors = {key: door for key, door in turn.doors.items() if key in named or door.ours or door.command}


def _users(turn: Turn, device: str) -> tuple[str, ...]:
    """Return the robots that are in the passage of a door, or will be soon."""
    zones = [zone for zone in turn.passages if zone.door == device]
    return tuple(
        robot.id
        for robot in turn.robots.values()
        if robot.path and any(_is_inside(turn, robot, zone) or _comes(turn, robot, zone) for zone in zones)
    )


def _is_inside(turn: Turn, robot: Robot, zone: FloorZone) -> bool:
    """Tell whether a robot has cells of the passage, or stands in it; one that has died there does."""
    reach_m = turn.layout.ground.radius_m
    return bool(cells_of(turn.layout, zone) & set(robot.held)) or touches(zone.points, (robot.x, robot.y), reach_m)


def _comes(turn: Turn, robot: Robot, zone: FloorZone) -> bool:
    if not robot.online or (robot.run in turn.paused and not robot.evading):
        return False
    known = turn.doors.get(zone.door)
    if robot.evading and known is not None and known.why:
        return False  # a broken door is not tried again and again for who only goes home
    ahead = robot.path[robot.passed : robot.passed + 1 + AHEAD_NODES]
    return any(is_in(turn.layout, node, zone) for node in ahead)


def _look(turn: Turn, door: Door, methods: DoorMethods) -> Door:
    """Take in how a door stands, and since when it has been waited for; one that is away lets in nobody else."""
    told = methods.is_open(turn.readings.get(door.id, {}).get(methods.reading))
    if told is not None and not door.command and turn.now >= door.moved_at + SETTLE_S:
        door = replace(door, is_open=told)
    if door.robots:
        door = replace(door, needed_at=turn.now)
    if not door.robots or (door.is_open and door.id not in turn.offline):
        return replace(door, shut_since=None)
    is_new = door.shut_since is None or turn.stopped
    return replace(door, shut_since=turn.now) if is_new else door


def _tell(turn: Turn, door: Door, methods: DoorMethods) -> None:
    """Tell a door to open or to close, if it should; one that cannot be told to close does so by itself."""
    if door.robots:
        if not door.is_open and turn.now >= door.retry_at:
            _send(turn, door, methods.opens)
    elif turn.now - door.needed_at >= HOLD_S:
        if not methods.closes:
            turn.doors[door.id] = replace(door, ours=False, is_open=False)
        elif door.ours and turn.now >= door.retry_at:
            _send(turn, replace(door, is_open=False), methods.closes)


def _send(turn: Turn, door: Door, method: str) -> None:
    sent = Sent("", door.id, limit_s=ANSWER_LIMIT_S, told=method)
    turn.doors[door.id] = replace(door, command=turn.send(sent, method, {}))


def take_door_answer(turn: Turn, sent: Sent, kind: str, why: str) -> bool:
    """A door has done what it was told, by whomever, or has not; tell whether it was told so for robots that pass.

    Who opens a door by hand or by a step keeps it open: it is closed here only if it was opened here last.
    """
    door, methods = turn.doors.get(sent.device), methods_of(turn, sent.device)
    if door is None or not sent.told:
        return False
    is_own = sent.id == door.command
    door = replace(door, command="" if is_own else door.command, moved_at=turn.now)
    opens = methods is not None and sent.told == methods.opens
    if kind:
        door = replace(door, why=why, retry_at=turn.now + (RETRY_S if opens else CLOSE_AGAIN_S))
    elif opens:
        is_open = methods is not None and not methods.reading
        door = replace(door, is_open=is_open, ours=is_own, why="", retry_at=turn.now + RETRY_S)
    else:
        door = replace(door, is_open=False, ours=False, why="", retry_at=turn.now)
    turn.doors[sent.device] = door
    return is_own


def shut_door(turn: Turn, robot: Robot, index: int) -> Door | None:
    """Return the first door that a robot may not go through at a node of its path.

    Who is in the passage already goes on as long as the door was open last, although it is away now.
    """
    for zone in turn.passages:
        if is_in(turn.layout, robot.path[index], zone):
            door = turn.doors.get(zone.door, Door(zone.door))
            is_away = zone.door in turn.offline and not _is_inside(turn, robot, zone)
            if not door.is_open or door.command or door.id in turn.calls or is_away:
                return door
    return None


def is_kept_open(turn: Turn, device: str, method: str) -> Door | None:
    """Return the door that may not be told this now, since robots pass it or it moves for them."""
    door, methods = turn.doors.get(device), methods_of(turn, device)
    if door is None or methods is None:
        return None
    return door if door.command or (door.robots and method != methods.opens) else None


def note_users(turn: Turn) -> None:
    """Note at the end of a step who is in the passages or will be soon: what people may tell a door depends on it."""
    turn.doors = {key: replace(door, robots=_users(turn, key)) for key, door in turn.doors.items()}


def why_not_waited_for(turn: Turn, door: Door) -> str:
    """Return why a robot cannot wait for a door any longer; an empty text: it still can."""
    name = turn.name(door.id)
    if methods_of(turn, door.id) is None:
        return f"{name} is no approved device that can be told to open."
    late = door.shut_since is not None and turn.now - door.shut_since >= WAIT_LIMIT_S
    return f"{name} did not open in time." if late else ""


def report_stuck(turn: Turn, door: Door) -> None:
    """Have people told of a door that somebody has waited for in vain; one that is away has an alert of its own."""
    methods = methods_of(turn, door.id)
    if methods is not None and door.id not in turn.offline:
        turn.actions.append(DoorStuck(door.id, methods.opens, door.why))
