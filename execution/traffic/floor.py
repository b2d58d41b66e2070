"""The floor of a site: its state and what happened in, the new state and what is to be done out; pure.

Rules, in docs/execution.md at length: each cell has one robot, a robot drives only over cells that it holds, a machine
serves one robot and carries out one call at a time, a role keeps its robot until the run ends or releases it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import assert_never

from execution.traffic import messages as m
from execution.traffic.admissions import keep_admissions, let_in
from execution.traffic.conflicts import resolve, send_home
from execution.traffic.dispatch import ABSENCE_S, CALL_LIMIT_S, bind_roles, dispatch, limit_of, release_roles
from execution.traffic.doors import keep_doors, learn_passages, note_users, take_door_answer
from execution.traffic.floor_state import FloorState, FloorTask, Robot, Sent, from_json, to_json
from execution.traffic.layout import Layout
from execution.traffic.path_release import (
    cut_path,
    drop_pieces,
    end_piece,
    heed_zones,
    keep_stations,
    leave_gone,
    leave_other_lattice,
    place,
    release_next,
    take_pose,
)
from execution.traffic.turn import Turn
from execution.traffic.zones import keep_zones

__all__ = ["from_json", "start", "step", "to_json"]

GAP_S = 5.0
"""A floor with something under way is looked at every half second; a longer gap means that the server was away."""
STUCK_S = 60.0
"""How long a robot may take for a piece of path without getting on."""
MOST_REFUSALS = 2
"""A robot that refuses its path so often gets another one; then its task fails."""
KINDS = {"FAILED": "failed", "REJECTED": "refused", "CANCELED": "cancelled"}


def start(layout: Layout, namespace: str) -> FloorState:
    """Return the floor before anything is known of it; `namespace` is a UUID from which command ids are made."""
    robots = {
        device.id: Robot(device.id, device.pose.x, device.pose.y, device.pose.theta)
        for device in layout.devices.values()
        if device.kind == "robot"
    }
    return FloorState(namespace=namespace, robots=robots)


def step(
    layout: Layout, state: FloorState, events: Sequence[m.Event], now: float
) -> tuple[FloorState, tuple[m.Action, ...]]:
    """Take in what happened, in order, at the time `now` (s), and decide once."""
    turn = Turn(layout, _without_gap(state, now), now)
    _know_robots(turn)
    leave_other_lattice(turn)
    leave_gone(turn)
    heed_zones(turn)
    for event in events:
        _take(turn, event)
    _resume(turn)
    _check_limits(turn)
    keep_stations(turn)
    keep_zones(turn)
    keep_admissions(turn)
    release_roles(turn)
    bind_roles(turn)
    dispatch(turn)
    keep_doors(turn)
    _release_all(turn)
    resolve(turn)
    send_home(turn)
    _release_all(turn)
    dispatch(turn)
    note_users(turn)
    turn.announce_waits()
    return turn.close()


def _without_gap(state: FloorState, now: float) -> FloorState:
    """Return the state as if the time had not passed in which nobody looked at the floor.

    When the server was away nothing could be heard of devices either: no grace or limit runs out meanwhile. So is
    a clock that was put back, beside which what else has a time would lie ahead.
    """
    gap = now - state.now
    if abs(gap) < GAP_S or not state.now:
        return state
    back = min(gap, 0.0)
    robots = {
        robot.id: replace(
            robot,
            yields_since=robot.yields_since + gap,
            idle_since=robot.idle_since + gap,
            progress_at=robot.progress_at + gap,
            blocked_since=None if robot.blocked_since is None else robot.blocked_since + gap,
        )
        for robot in state.robots.values()
    }
    sent = {key: replace(item, at=item.at + gap) for key, item in state.sent.items()}
    tasks = tuple(
        replace(
            task,
            absent_since=None if task.absent_since is None else task.absent_since + gap,
            behind_since=None if task.behind_since is None else task.behind_since + gap,
        )
        for task in state.tasks
    )
    offline = {device: since + gap for device, since in state.offline.items()}
    doors = {
        key: replace(
            door,
            shut_since=None if door.shut_since is None else door.shut_since + gap,
            needed_at=door.needed_at + gap,
            moved_at=door.moved_at + back,
            retry_at=door.retry_at + back,
        )
        for key, door in state.doors.items()
    }
    admissions = tuple(replace(each, at=each.at + back) for each in state.admissions)
    return replace(state, robots=robots, sent=sent, tasks=tasks, offline=offline, doors=doors, admissions=admissions)


def _release_all(turn: Turn) -> None:
    for robot in list(turn.robots.values()):
        if robot.path:
            release_next(turn, turn.robots[robot.id])


def _know_robots(turn: Turn) -> None:
    """Take in robots that were approved since."""
    for device in turn.layout.devices.values():
        if device.kind == "robot" and device.id not in turn.robots:
            turn.robots[device.id] = Robot(device.id, device.pose.x, device.pose.y, online=False)


def _take(turn: Turn, event: m.Event) -> None:
    match event:
        case m.TaskAsked():
            _take_task(turn, event)
        case m.TaskCancelled(run=run, task=number):
            if task := turn.tasks.get((run, number)):
                _drop(turn, task)
        case m.CallSent():
            _take_call(turn, event)
        case m.CallCancelled():
            _end_call(turn, event)
        case m.RunPaused() | m.RunResumed() | m.RunOver() | m.StopPressed() | m.StopReset() | m.RobotLetIn():
            _take_order(turn, event)
        case m.RobotsReport(readings=readings):
            turn.readings = readings
        case m.RobotMoved() | m.CommandAnswered() | m.DeviceOnline() | m.DeviceOffline():
            _take_report(turn, event)
        case m.Tick():
            pass  # that time has passed is seen by all that follows
        case _:
            assert_never(event)


def _take_report(turn: Turn, event: m.RobotMoved | m.CommandAnswered | m.DeviceOnline | m.DeviceOffline) -> None:
    """Take in what devices say."""
    match event:
        case m.RobotMoved(robot=robot, x=x, y=y, theta=theta):
            if robot in turn.robots:
                take_pose(turn, turn.robots[robot], x, y, theta)
        case m.CommandAnswered():
            _take_answer(turn, event)
        case m.DeviceOnline(device=device):
            _take_online(turn, device)
        case m.DeviceOffline(device=device):
            turn.offline.setdefault(device, turn.now)
            if robot_state := turn.robots.get(device):
                turn.put(robot_state, online=False)


Order = m.RunPaused | m.RunResumed | m.RunOver | m.StopPressed | m.StopReset | m.RobotLetIn


def _take_order(turn: Turn, event: Order) -> None:
    """Take in what people want of runs, of robots that wait and of the whole site."""
    match event:
        case m.RobotLetIn(zone=zone, robot=robot):
            let_in(turn, zone, robot)
        case m.RunPaused(run=run):
            turn.paused.add(run)
        case m.RunResumed(run=run):
            turn.paused.discard(run)
        case m.RunOver(run=run):
            _end_run(turn, run)
        case m.StopPressed():
            turn.stopped = True
            for sent in turn.sent.values():
                turn.tell(sent, "pause")
            turn.sent = {key: replace(sent, held_up=True) for key, sent in turn.sent.items()}
        case m.StopReset():
            turn.stopped = False


def _take_task(turn: Turn, event: m.TaskAsked) -> None:
    if (event.run, event.task) in turn.tasks:
        return
    turn.next_seq += 1
    task = FloorTask(event.run, event.task, turn.next_seq, event.order, event.wants, event.can, event.run_name)
    turn.tasks[event.run, event.task] = replace(
        task, where=event.where, said=event.said, holds=event.holds, priority=event.priority, due=event.due
    )
    turn.names[event.run] = event.run_name
    if event.zones:
        turn.zones[event.run] = event.zones
        learn_passages(turn, event.run, event.zones)


def _take_call(turn: Turn, event: m.CallSent) -> None:
    """A person uses a device by hand: runs wait until it is done, a stop holds it, it has its time limit."""
    device = turn.layout.devices.get(event.device)
    limit_s = limit_of(device, event.method, event.arguments) if device else CALL_LIMIT_S
    sent = Sent(event.command, event.device, at=turn.now, limit_s=limit_s, held_up=turn.stopped)
    sent = replace(sent, told=event.method if event.device in turn.doors else "")
    turn.sent[event.command] = sent
    if event.device not in turn.robots:
        turn.calls[event.device] = event.command
        turn.names[event.command] = event.name


def _end_call(turn: Turn, event: m.CallCancelled) -> None:
    sent = turn.sent.get(event.command)
    if sent is not None and event.given_up:
        _give_up(turn, sent, "timed_out", "")
    elif sent is not None:
        _call_off(turn, sent)


def _take_online(turn: Turn, device: str) -> None:
    turn.offline.pop(device, None)
    robot = turn.robots.get(device)
    if robot is not None and not robot.online:
        robot = turn.put(robot, online=True, progress_at=turn.now)
        if robot.path and not turn.is_driving(robot):
            place(turn, robot)


def _take_answer(turn: Turn, event: m.CommandAnswered) -> None:
    sent = turn.sent.get(event.command)
    if sent is None or event.status not in {"DONE", *KINDS}:
        return
    del turn.sent[sent.id]
    kind = KINDS.get(event.status, "")
    why = event.why or (f"{turn.name(sent.device)} did not do it." if kind else "")
    if sent.upto < 0:
        _end_act(turn, sent, kind, why, event)
    else:
        _take_answer_of_robot(turn, turn.robots[sent.device], sent, kind, why)


def _take_answer_of_robot(turn: Turn, robot: Robot, sent: Sent, kind: str, why: str) -> None:
    """A piece of path is driven, or not; one that was started anew on its path stands where no piece of it begins."""
    if kind == "refused" and robot.refusals < MOST_REFUSALS:
        _halt(turn, turn.put(robot, refusals=robot.refusals + 1))
    elif kind:
        _fail_drive(turn, robot, kind, why)
    else:
        end_piece(turn, robot, sent)


def _end_act(turn: Turn, sent: Sent, kind: str, why: str, event: m.CommandAnswered | None) -> None:
    """A device is done with a task's command, or will not be."""
    if take_door_answer(turn, sent, kind, why):
        return
    if sent.device not in turn.robots:
        caller = turn.calls.pop(sent.device, "")
        if not sent.run:
            turn.names.pop(caller, None)
    rested = turn.robots.get(turn.stations.get(sent.device, sent.device))
    if rested is not None:
        turn.put(rested, idle_since=turn.now)
    _place_mover(turn, sent.device)
    if task := turn.tasks.get((sent.run, sent.task)):
        turn.finish(task, kind, why, event.result if event else None)


def _place_mover(turn: Turn, device: str) -> None:
    """Place a robot where its act has brought it: one that rests by then tells its pose no more."""
    mover = turn.robots.get(device)
    if mover is not None and mover.path and mover.online:
        take_pose(turn, mover, mover.x, mover.y, mover.theta)


def _fail_drive(turn: Turn, robot: Robot, kind: str, why: str) -> None:
    """A robot does not drive on: it stays where it is, and its task fails."""
    task = None if robot.evading else turn.task_of(robot)
    _halt(turn, turn.put(robot, refusals=0, idle_since=turn.now))
    if task is not None:
        turn.finish(task, kind, why)


def _halt(turn: Turn, robot: Robot) -> None:
    """Take a robot's path from it; it stands where it is."""
    drop_pieces(turn, robot, cancel=True)
    robot = turn.put(robot, evading="", yields_to="", blocked_since=None)
    if robot.online:
        place(turn, robot)
    else:
        turn.put(robot, path=(turn.node(robot),), passed=0, released=0)


def _drop(turn: Turn, task: FloorTask) -> None:
    """Forget a task; what a device does for it is called off, but for a pick or a drop, which is brought to its end.

    A robot settles at the end of what it may drive.
    """
    del turn.tasks[task.run, task.number]
    sent = turn.sent.get(task.command)
    if sent is not None and task.order.kind not in {"pick", "drop"}:
        _call_off(turn, sent)
    robot = turn.robots.get(task.robot)
    if robot is not None and robot.path and not robot.evading and turn.task_of(robot) is None:
        cut_path(turn, robot)


def _resume(turn: Turn) -> None:
    """Let the commands go on that a stop has held up: all but those of runs that are paused.

    Looked at when all events are taken in, since a run may say only behind the reset that the stop has paused it.
    """
    for sent in list(turn.sent.values()):
        if sent.held_up and not turn.stopped and sent.run not in turn.paused:
            _end_hold(turn, sent, "resume")


def _call_off(turn: Turn, sent: Sent) -> None:
    """Have a command ended; one that a stop has held up is held up no more, since nothing is left to go on with."""
    if sent.held_up:
        _end_hold(turn, sent, "cancel")
    else:
        turn.tell(sent, "cancel")


def _end_hold(turn: Turn, sent: Sent, method: str) -> None:
    """Tell a command that a stop has held up to go on or to end; its time begins anew."""
    turn.tell(sent, method)
    turn.sent[sent.id] = replace(sent, held_up=False, at=turn.now)
    if robot := turn.robots.get(sent.device):
        turn.put(robot, progress_at=turn.now)


def _end_run(turn: Turn, run: str) -> None:
    for task in [each for each in turn.tasks.values() if each.run == run]:
        _drop(turn, task)
    for sent in [sent for sent in turn.sent.values() if sent.run == run and sent.held_up]:
        _call_off(turn, sent)
    turn.roles = {key: robot for key, robot in turn.roles.items() if key.rpartition("/")[0] != run}
    for robot in [robot for robot in turn.robots.values() if robot.run == run]:
        turn.put(robot, run="", yields_to="", idle_since=turn.now)
    turn.names.pop(run, None)
    turn.zones.pop(run, None)
    turn.paused.discard(run)


def _check_limits(turn: Turn) -> None:
    """Give up commands whose device has gone or does not get on."""
    for sent in list(turn.sent.values()):
        if sent.id not in turn.sent or sent.held_up:
            continue
        away = turn.now - turn.offline.get(sent.device, turn.now) >= ABSENCE_S
        robot = turn.robots.get(sent.device)
        since = robot.progress_at if robot is not None and sent.upto >= 0 else sent.at
        late = turn.now - since >= (STUCK_S if sent.upto >= 0 else sent.limit_s)
        if away:
            _give_up(turn, sent, "offline", f"{turn.name(sent.device)} went offline and did not come back.")
        elif late:
            _give_up(turn, sent, "timed_out", f"{turn.name(sent.device)} took too long.")


def _give_up(turn: Turn, sent: Sent, kind: str, why: str) -> None:
    if sent.upto >= 0:
        _fail_drive(turn, turn.robots[sent.device], kind, why)
        return
    turn.tell(sent, "cancel")
    del turn.sent[sent.id]
    _end_act(turn, sent, kind, why, None)
