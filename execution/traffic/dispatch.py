"""How missions are carried out: roles find robots, robots find machines, devices get commands."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from scipy.optimize import linear_sum_assignment

from execution.traffic.conflicts import make_way_for
from execution.traffic.floor_state import Job, Robot, Sent
from execution.traffic.layout import NoSuchSpot, Spot
from execution.traffic.messages import RoleBound
from execution.traffic.path_release import cut_way, set_way
from execution.traffic.turn import Turn
from execution.traffic.zones import way_for
from vipo_device.protocol.description import Description

ABSENCE_S = 30.0
"""How long a device may be away before what needs it fails as offline; a restart of the demo is shorter."""
HANDLING_LIMIT_S = 60.0
CALL_LIMIT_S = 900.0
IDLE_GRACE_S = 1.0
"""How long an idle robot is left where it stands, for its run may be about to ask it for more."""
UNABLE = 1e6
UNIT_S: Mapping[str, float] = {"SEC": 1.0, "MIN": 60.0, "HR": 3600.0}


def bind_roles(turn: Turn) -> None:
    """Find robots for the roles that wait for one, over all of them at once, by the length of the way there."""
    waiting: dict[str, Job] = {}
    for job in turn.in_order():
        key = f"{job.run}/{job.order.role}"
        if job.order.role and key not in turn.roles and key not in waiting:
            if job.wants:
                _bind_given(turn, key, job)
            else:
                waiting[key] = job
    if waiting:
        _bind_any(turn, waiting)


def _bind_given(turn: Turn, key: str, job: Job) -> None:
    robot = turn.robots.get(job.wants)
    if robot is None or not robot.way:
        _await_device(turn, job, job.wants)
    elif robot.run in {"", job.run}:
        _bind(turn, key, job, robot)
    else:
        holder = turn.names.get(robot.run, "another run")
        turn.wait(job, "role_held", f"{turn.name(robot.id)} is held by {holder}.", robot=robot.id, run=holder)


def _bind_any(turn: Turn, waiting: Mapping[str, Job]) -> None:
    requests = {key: job for key, job in waiting.items() if _has_able_robot(turn, job)}
    robots = [r for r in turn.robots.values() if r.run == "" and r.way and r.online]
    if requests and robots:
        costs = np.array([[_cost(turn, job, robot) for robot in robots] for job in requests.values()])
        keys = list(requests)
        for i, j in zip(*linear_sum_assignment(costs), strict=True):
            if costs[i, j] < UNABLE:
                _bind(turn, keys[i], requests[keys[i]], robots[j])
    for key, job in requests.items():
        if key not in turn.roles:
            turn.wait(job, "no_free_robot", "It waits for a robot that can do this to be free and online.")


def _has_able_robot(turn: Turn, job: Job) -> bool:
    if any(_is_able(turn.layout.devices.get(robot), job.can) for robot in turn.robots):
        return True
    needed = " and ".join(job.can) or "drive"
    turn.finish(job, "refused", f"No robot of this site can {needed}. Approve one that can, or change the role.")
    return False


def _is_able(device: Description | None, can: tuple[str, ...]) -> bool:
    return device is not None and all(device.method(name) for name in can)


def _cost(turn: Turn, job: Job, robot: Robot) -> float:
    if not _is_able(turn.layout.devices.get(robot.id), job.can):
        return UNABLE
    try:
        goal = turn.layout.spot_for(job.order.target).cell
    except NoSuchSpot:
        return 0.0
    return float(turn.layout.lattice.distances(goal).get(turn.layout.cell(turn.node(robot)), UNABLE / 2))


def _bind(turn: Turn, key: str, job: Job, robot: Robot) -> None:
    turn.roles[key] = robot.id
    robot = turn.put(robot, run=job.run)
    turn.actions.append(RoleBound(job.run, job.order.role, robot.id))
    if robot.evading == "home":
        cut_way(turn, robot)


def serve(turn: Turn) -> None:
    """Bring every mission on as far as it goes now."""
    for job in turn.in_order():
        if job.command:
            continue
        if turn.stopped:
            turn.wait(job, "stopped", "All devices of the site are stopped.")
        elif job.run in turn.paused:
            turn.wait(job, "paused", "The run is paused.")
        elif not job.order.role:
            _call(turn, job)
        elif robot_id := turn.roles.get(f"{job.run}/{job.order.role}"):
            _serve_with(turn, turn.put_job(job, robot=robot_id), turn.robots[robot_id])


def _serve_with(turn: Turn, job: Job, robot: Robot) -> None:
    """Bring on a mission that a robot takes part in: it goes there, then it acts."""
    first = turn.job_of(robot)
    if first is not None and first.seq < job.seq:
        turn.wait(job, "robot_busy", f"{turn.name(robot.id)} has something else to do first.", robot=robot.id)
        return
    if not robot.online:
        _await_device(turn, job, robot.id)
        return
    try:
        spot = turn.layout.spot_for(job.order.target)
    except NoSuchSpot as error:
        turn.finish(job, "blocked", str(error))
        return
    if robot.way == (spot.id,) and not turn.is_driving(robot):
        _act(turn, job, robot, spot)
    else:
        _take_machine(turn, job, robot, spot.id)
        _go(turn, job, robot, spot)


def _take_machine(turn: Turn, job: Job, robot: Robot, machine: str) -> None:
    """Take the machine that the robot goes to, or say who has it; without it the robot drives up to before it."""
    holder = turn.stations.get(machine)
    caller = turn.calls.get(machine)
    if machine not in turn.layout.stations or holder == robot.id:
        return
    if holder is None and caller in {None, job.run}:
        turn.stations[machine] = robot.id
    elif holder is None:
        run = turn.names.get(caller or "", "another run")
        turn.wait(job, "machine_busy", f"{turn.name(machine)} is busy for {run}.", device=machine, run=run)
    else:
        turn.wait(
            job, "machine_held", f"{turn.name(machine)} serves {turn.name(holder)}.", device=machine, robot=holder
        )
        _ask_to_leave(turn, turn.robots[holder], robot)


def _ask_to_leave(turn: Turn, holder: Robot, robot: Robot) -> None:
    rested = turn.now - holder.idle_since >= IDLE_GRACE_S
    if turn.is_idle(holder) and holder.online and rested and holder.run not in turn.paused:
        make_way_for(turn, holder, robot)


def _go(turn: Turn, job: Job, robot: Robot, spot: Spot) -> None:
    """See to it that the robot is on its way."""
    if robot.evading or robot.yields_to or turn.is_acting(robot) or robot.way[-1] == spot.id:
        return
    if turn.is_driving(robot):
        cut_way(turn, robot)
        return
    standing = {c for r in turn.robots.values() if r.id != robot.id and not turn.is_driving(r) for c in r.held}
    way = way_for(turn, robot, spot.id, extra=dict.fromkeys(standing, 6.0))
    if way is None:
        turn.finish(job, "blocked", f"There is no way for {turn.name(robot.id)} to {turn.name(job.order.target.id)}.")
        return
    set_way(turn, robot, way)


def _act(turn: Turn, job: Job, robot: Robot, spot: Spot) -> None:
    """Do at the target what the mission asks."""
    order = job.order
    if spot.id in turn.layout.stations:
        turn.stations[spot.id] = robot.id
    if order.kind == "move":
        turn.finish(job)
    elif order.kind == "call":
        _call(turn, job)
    elif spot.id not in turn.layout.devices:
        turn.finish(job, "refused", f"Nothing can be handed over at {turn.name(spot.id)}; choose a device.")
    elif spot.id in turn.calls:
        turn.wait(job, "machine_busy", f"{turn.name(spot.id)} is busy.", device=spot.id)
    elif not turn.is_acting(robot):
        quantity = int(order.quantity) if float(order.quantity).is_integer() else order.quantity
        arguments = {"device": spot.id, "object": order.object, "value": quantity}
        sent = Sent("", robot.id, job.run, job.mission, limit_s=HANDLING_LIMIT_S)
        turn.put_job(job, command=turn.send(sent, order.kind, arguments, order.step), absent_since=None)


def _call(turn: Turn, job: Job) -> None:
    """Let a device carry out a method, when it is free."""
    device = turn.layout.devices.get(job.order.target.id)
    if device is None:
        turn.finish(job, "refused", f"There is no approved device called “{job.order.target.id}” on this site.")
        return
    if device.method(job.order.method) is None:
        turn.finish(job, "refused", f"{device.name} cannot {job.order.method}; it offers no such method.")
        return
    holder = turn.robots.get(turn.stations.get(device.id, ""))
    if device.id in turn.offline:
        _await_device(turn, job, device.id)
    elif device.id in turn.calls:
        run = turn.names.get(turn.calls[device.id], "another run")
        turn.wait(job, "machine_busy", f"{device.name} is busy for {run}.", device=device.id, run=run)
    elif holder is not None and holder.run not in {"", job.run}:
        turn.wait(
            job, "machine_held", f"{device.name} serves {turn.name(holder.id)}.", device=device.id, robot=holder.id
        )
        if job.robot == "":
            _ask_to_leave(turn, holder, holder)
    else:
        turn.calls[device.id] = job.run
        method, arguments = job.order.method, dict(job.order.arguments)
        sent = Sent("", device.id, job.run, job.mission, limit_s=limit_of(device, method, arguments))
        command = turn.send(sent, method, arguments, job.order.step)
        turn.put_job(job, command=command, absent_since=None)


def limit_of(device: Description, name: str, arguments: Mapping[str, object]) -> float:
    """Return how many seconds a call may take: half as long again as its durations say, and a minute."""
    method = device.method(name)
    total = 0.0
    for parameter in method.parameters if method else ():
        value = arguments.get(parameter.name)
        if parameter.unit in UNIT_S and isinstance(value, int | float):
            total += value * UNIT_S[parameter.unit]
    return 1.5 * total + 60.0 if total else CALL_LIMIT_S


def _await_device(turn: Turn, job: Job, device: str) -> None:
    """Wait for a device that is away, but not for ever."""
    since = turn.now if job.absent_since is None else job.absent_since
    if turn.now - since >= ABSENCE_S:
        turn.finish(job, "offline", f"{turn.name(device)} is offline.")
        return
    turn.put_job(job, absent_since=since)
    turn.wait(job, "offline", f"{turn.name(device)} is offline.", device=device)
