"""How tasks are carried out: roles find robots, robots find machines, devices get commands, and how long they may take
to answer (`limit_of`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import scipy

from editor.language.expressions.names import ROBOT_METHODS
from editor.language.plan.json_form import expression_from_json
from execution.machine.evaluation import EvaluationError, is_true
from execution.machine.places import ROLE
from execution.traffic.conflicts import make_room_for
from execution.traffic.covering import cover, distance_to_zone
from execution.traffic.doors import is_kept_open
from execution.traffic.floor_state import FloorTask, Robot, Sent
from execution.traffic.layout import NoSuchSpot, Spot
from execution.traffic.messages import RoleBound, RoleReleased
from execution.traffic.path_planner import plan_path
from execution.traffic.path_release import cut_path, set_path, why_stranded
from execution.traffic.precedence import Waiting, in_groups, note_behind
from execution.traffic.route_points import leads_along, path_along, points_ahead, set_points
from execution.traffic.turn import Turn
from execution.traffic.zones import path_outside
from vipo_device.protocol.arguments import lasting_s
from vipo_device.protocol.description import Description
from vipo_device.protocol.messages import EXPLORE

ABSENCE_S = 30.0
"""How long a device may be away before what needs it fails as offline; a restart of the demo is shorter."""
HANDLING_LIMIT_S = 60.0
CALL_LIMIT_S = 900.0
IDLE_GRACE_S = 1.0
"""How long an idle robot is left where it stands, for its run may be about to ask it for more."""
UNABLE = 1e6


def release_roles(turn: Turn) -> None:
    """Give back the robots of roles that are released, so that others may have them at once.

    What stands before in the same run is done first: a robot is not taken from a task or from what it handles.
    """
    for task in turn.in_order():
        if task.order.kind != "release" or turn.stopped or task.run in turn.paused:
            continue
        key = f"{task.run}/{task.order.role}"
        robot = turn.robots.get(turn.roles.get(key, ""))
        if robot is None:
            if not _has_earlier(turn, task):
                turn.finish(task)
            continue
        if _has_earlier(turn, task) or turn.task_of(robot) is not None or turn.is_acting(robot):
            turn.wait(task, "robot_busy", f"{turn.name(robot.id)} has something else to do first.", robot=robot.id)
            continue
        del turn.roles[key]
        if not any(robot.id == other and kept.rpartition("/")[0] == task.run for kept, other in turn.roles.items()):
            turn.put(robot, run="", yields_to="", idle_since=turn.now)
        turn.actions.append(RoleReleased(task.run, task.order.role, robot.id, bool(task.wants)))
        turn.finish(task)


def _has_earlier(turn: Turn, task: FloorTask) -> bool:
    """Tell whether the role has been asked for something before that is still to be done."""
    whose = task.run, task.order.role
    return any((each.run, each.order.role) == whose and each.seq < task.seq for each in turn.tasks.values())


def bind_roles(turn: Turn) -> None:
    """Find robots for the roles that wait for one: for those that go first, over all of them at once, by the length
    of the path there; then for the next. Those of paused runs look for none.
    """
    waiting: list[Waiting] = []
    seen: set[str] = set()
    for task in turn.in_order():
        if task.run in turn.paused:
            continue
        key = f"{task.run}/{task.order.role}"
        if task.order.role and task.order.kind != "release" and key not in turn.roles and key not in seen:
            waiting.append((key, task))
            if not task.wants:
                seen.add(key)
    for group in in_groups(turn, waiting):
        for key, task in group:
            if task.wants and key not in turn.roles:
                _bind_given(turn, key, task)
        if anybody := {key: task for key, task in group if not task.wants}:
            _bind_any(turn, anybody)
    note_behind(turn, waiting)


def _bind_given(turn: Turn, key: str, task: FloorTask) -> None:
    robot = turn.robots.get(task.wants)
    if robot is None or not robot.path:
        _await_device(turn, task, task.wants)
    elif robot.run in {"", task.run}:
        _bind(turn, key, task, robot)
    else:
        holder = turn.names.get(robot.run, "another run")
        turn.wait(task, "role_held", f"{turn.name(robot.id)} is held by {holder}.", robot=robot.id, run=holder)


def _bind_any(turn: Turn, waiting: Mapping[str, FloorTask]) -> None:
    asked = [(key, task) for key, task in waiting.items() if _has_able_robot(turn, task)]
    robots = [r for r in turn.robots.values() if r.run == "" and r.path and r.online]
    if asked and robots:
        costs = np.array([[_cost(turn, task, robot) for robot in robots] for _, task in asked])
        for i, j in zip(*scipy.optimize.linear_sum_assignment(costs), strict=True):
            key, task = asked[i]
            if costs[i, j] < UNABLE / 2 or (costs[i, j] < UNABLE and not _is_awaited(turn, task)):
                _bind(turn, key, task, robots[j])
    for key, task in asked:
        if key not in turn.roles:
            _await_robot(turn, task)


def _is_awaited(turn: Turn, task: FloorTask) -> bool:
    """Tell whether a robot that another run holds could do what those who are free cannot get to."""
    held = (r for r in turn.robots.values() if r.run not in {"", task.run} and r.path and r.online)
    return any(_cost(turn, task, robot) < UNABLE / 2 for robot in held)


def _await_robot(turn: Turn, task: FloorTask) -> None:
    if task.said:
        why = f"It waits for a robot that can do this to be free and online, with {task.said}."
        turn.wait(task, "no_fitting_robot", why, condition=task.said)
    else:
        turn.wait(task, "no_free_robot", "It waits for a robot that can do this to be free and online.")


def _has_able_robot(turn: Turn, task: FloorTask) -> bool:
    if any(_is_able(turn.layout.devices.get(robot), task) for robot in turn.robots):
        return True
    needed = " and ".join(task.can) or "drive"
    needed += f" and hold {task.holds} objects at once" if task.holds else ""
    turn.finish(task, "refused", f"No robot of this site can {needed}. Approve one that can, or change the role.")
    return False


def _is_able(device: Description | None, task: FloorTask) -> bool:
    """Tell whether a robot can do all that its role asks; one that does not say how much it holds may hold enough."""
    if device is None or 0 < device.capacity < task.holds:
        return False
    return all(device.method(name) for name in task.can)


def _cost(turn: Turn, task: FloorTask, robot: Robot) -> float:
    if not _is_able(turn.layout.devices.get(robot.id), task) or not _fits(turn, task, robot):
        return UNABLE
    if task.order.kind != "perform" and why_stranded(turn, robot):
        return UNABLE / 2
    try:
        if task.order.kind == "cover":
            cells = distance_to_zone(turn, task, robot)
            return UNABLE / 2 if cells is None else cells
        goal = turn.layout.spot_for(task.order.target, task.run).cell
    except NoSuchSpot:
        return 0.0
    reach = turn.layout.lattice.distances(goal, closed_links=turn.layout.against_backwards)
    return float(reach.get(turn.layout.cell(turn.node(robot)), UNABLE / 2))


def _fits(turn: Turn, task: FloorTask, robot: Robot) -> bool:
    """Tell whether what a robot reports now is what it is chosen by; one that does not report it does not fit."""
    if not task.where:
        return True
    told = {(robot.id, name): value for name, value in turn.readings.get(robot.id, {}).items()}
    try:
        return is_true(expression_from_json(task.where), {}, {**told, (ROLE, task.order.role): robot.id})
    except EvaluationError:
        return False


def _bind(turn: Turn, key: str, task: FloorTask, robot: Robot) -> None:
    turn.roles[key] = robot.id
    robot = turn.put(robot, run=task.run)
    turn.actions.append(RoleBound(task.run, task.order.role, robot.id))
    if robot.evading == "home":
        cut_path(turn, robot)


def dispatch(turn: Turn) -> None:
    """Bring every task on as far as it goes now."""
    for task in turn.in_order():
        if task.command:
            continue
        if turn.stopped:
            turn.wait(task, "stopped", "All devices of the site are stopped.")
        elif task.run in turn.paused:
            turn.wait(task, "paused", "The run is paused.")
        elif task.order.kind == "release":
            continue  # it waits for what its robot does
        elif not task.order.role:
            _call(turn, task)
        elif robot_id := turn.roles.get(f"{task.run}/{task.order.role}"):
            _dispatch_with(turn, turn.put_task(task, robot=robot_id), turn.robots[robot_id])


def _dispatch_with(turn: Turn, task: FloorTask, robot: Robot) -> None:
    """Bring on a task that a robot takes part in: it goes there, then it acts."""
    first = turn.task_of(robot)
    if first is not None and first.seq < task.seq:
        turn.wait(task, "robot_busy", f"{turn.name(robot.id)} has something else to do first.", robot=robot.id)
        return
    if not robot.online:
        _await_device(turn, task, robot.id)
        return
    if task.order.kind == "perform":
        _perform(turn, task, robot)
        return
    if why := why_stranded(turn, robot):
        turn.finish(task, "blocked", why)
        return
    if task.order.kind == "cover":
        cover(turn, task, robot)
        return
    try:
        spot = turn.layout.spot_for(task.order.target, task.run)
    except NoSuchSpot as error:
        turn.finish(task, "blocked", str(error))
        return
    if robot.path == (spot.id,) and not turn.is_driving(robot) and not points_ahead(task):
        if turn.is_acting(robot):  # for a person, or for a run that is over: it may be moved by it
            turn.wait(task, "robot_busy", f"{turn.name(robot.id)} has something else to do first.", robot=robot.id)
        else:
            _act(turn, task, robot, spot)
    else:
        _take_machine(turn, task, robot, spot.id)
        _go(turn, task, robot, spot)


def _take_machine(turn: Turn, task: FloorTask, robot: Robot, machine: str) -> None:
    """Take the machine that the robot goes to, or say who has it; without it the robot drives up to before it."""
    holder = turn.stations.get(machine)
    caller = turn.calls.get(machine)
    if machine not in turn.layout.stations or holder == robot.id:
        return
    if holder is None and caller in {None, task.run}:
        turn.stations[machine] = robot.id
    elif holder is None:
        run = turn.names.get(caller or "", "another run")
        turn.wait(task, "machine_busy", f"{turn.name(machine)} is busy for {run}.", device=machine, run=run)
    else:
        turn.wait(
            task, "machine_held", f"{turn.name(machine)} serves {turn.name(holder)}.", device=machine, robot=holder
        )
        _ask_to_leave(turn, turn.robots[holder], robot)


def _ask_to_leave(turn: Turn, holder: Robot, robot: Robot) -> None:
    rested = turn.now - holder.idle_since >= IDLE_GRACE_S
    if turn.is_idle(holder) and holder.online and rested and holder.run not in turn.paused:
        make_room_for(turn, holder, robot)


def _go(turn: Turn, task: FloorTask, robot: Robot, spot: Spot) -> None:
    """See to it that the robot is on its path there."""
    if robot.evading or robot.yields_to or turn.is_acting(robot):
        return
    if robot.path[-1] == spot.id and leads_along(robot, task):
        return
    if turn.is_driving(robot):
        cut_path(turn, robot)
        return
    standing = {c for r in turn.robots.values() if r.id != robot.id and not turn.is_driving(r) for c in r.held}
    try:
        path = path_along(turn, robot, points_ahead(task), spot.id, extra=dict.fromkeys(standing, 6.0))
    except NoSuchSpot as error:
        turn.finish(task, "blocked", str(error))
        return
    if path is None:
        point = task.order.target.point
        where = turn.name(task.order.target.id) if point is None else f"({point[0]:.2f}, {point[1]:.2f})"
        turn.finish(task, "blocked", _why_no_way(turn, robot, spot, where))
        return
    set_points(turn, set_path(turn, robot, path[0]), task, path[1])


def _why_no_way(turn: Turn, robot: Robot, spot: Spot, where: str) -> str:
    """Say what is in the way: the body of a real robot that is simulated, zones, or the place itself."""
    name, layout = turn.name(robot.id), turn.layout
    bodies = [body for body in layout.bodies if body.key != f"body/{robot.id}"]
    for body in bodies:
        others = tuple(each for each in (*layout.zones, *bodies) if each is not body)
        if path_outside(layout, others, (turn.node(robot), spot.id)) is not None:
            return (
                f"The real {body.name} stands where {name} has to pass to {where}. Let it be moved, or use the real "
                "one again."
            )
    if plan_path(replace(layout, zones=()), turn.node(robot), spot.id) is not None:
        return f"Zones leave no way for {name} to {where}. Change a zone on the map, or choose another place."
    return f"There is no way for {name} to {where}."


def _act(turn: Turn, task: FloorTask, robot: Robot, spot: Spot) -> None:
    """Do at the target what the task asks."""
    order = task.order
    if spot.id in turn.layout.stations:
        turn.stations[spot.id] = robot.id
    if order.kind == "move":
        turn.finish(task)
    elif order.kind == "call":
        _call(turn, task)
    elif spot.id not in turn.layout.devices:
        where = turn.name(order.target.id or spot.id)
        turn.finish(task, "refused", f"Nothing can be handed over at {where}; choose a device.")
    elif spot.id in turn.calls:
        turn.wait(task, "machine_busy", f"{turn.name(spot.id)} is busy.", device=spot.id)
    else:
        quantity = int(order.quantity) if float(order.quantity).is_integer() else order.quantity
        arguments = {"device": spot.id, "object": order.object, "value": quantity}
        sent = Sent("", robot.id, task.run, task.number, limit_s=HANDLING_LIMIT_S)
        turn.put_task(task, command=turn.send(sent, order.kind, arguments, order.step), absent_since=None)


def _perform(turn: Turn, task: FloorTask, robot: Robot) -> None:
    """Let a robot carry out a method of its own where it stands, when it has come to rest."""
    device, method = turn.layout.devices.get(robot.id), task.order.method
    if device is None or device.method(method) is None:
        turn.finish(task, "refused", f"{turn.name(robot.id)} cannot {method}; it offers no such method.")
    elif method in ROBOT_METHODS:
        turn.finish(task, "refused", f"{turn.name(robot.id)} does {method} only as a step of its own.")
    elif method == EXPLORE:
        turn.finish(task, "refused", f"{turn.name(robot.id)} does {method} only by hand, while no run is open.")
    elif turn.is_driving(robot) or turn.is_acting(robot) or robot.evading:
        turn.wait(task, "robot_busy", f"{turn.name(robot.id)} has something else to do first.", robot=robot.id)
    else:
        if len(robot.path) > robot.passed + 1:
            cut_path(turn, robot)
        arguments = dict(task.order.arguments)
        sent = Sent("", robot.id, task.run, task.number, limit_s=limit_of(device, method, arguments))
        turn.put_task(task, command=turn.send(sent, method, arguments, task.order.step), absent_since=None)


def _call(turn: Turn, task: FloorTask) -> None:
    """Let a device carry out a method, when it is free."""
    device = turn.layout.devices.get(task.order.target.id)
    if device is None:
        turn.finish(task, "refused", f"There is no approved device called “{task.order.target.id}” on this site.")
        return
    if device.method(task.order.method) is None:
        turn.finish(task, "refused", f"{device.name} cannot {task.order.method}; it offers no such method.")
        return
    holder = turn.robots.get(turn.stations.get(device.id, ""))
    robot = turn.robots.get(device.id)
    if device.id in turn.offline:
        _await_device(turn, task, device.id)
    elif robot is not None:
        _call_robot(turn, task, robot)
    elif door := is_kept_open(turn, device.id, task.order.method):
        passing = " and ".join(turn.name(each) for each in door.robots) or "robots"
        others = ",".join(door.robots)
        turn.wait(task, "door_in_use", f"{device.name} is held open for {passing}.", device=device.id, others=others)
    elif device.id in turn.calls:
        run = turn.names.get(turn.calls[device.id], "another run")
        turn.wait(task, "machine_busy", f"{device.name} is busy for {run}.", device=device.id, run=run)
    elif holder is not None and holder.run not in {"", task.run}:
        turn.wait(
            task, "machine_held", f"{device.name} serves {turn.name(holder.id)}.", device=device.id, robot=holder.id
        )
        if task.robot == "":
            _ask_to_leave(turn, holder, holder)
    else:
        turn.calls[device.id] = task.run
        method, arguments = task.order.method, dict(task.order.arguments)
        sent = Sent("", device.id, task.run, task.number, limit_s=limit_of(device, method, arguments))
        sent = replace(sent, told=method if device.id in turn.doors else "")
        command = turn.send(sent, method, arguments, task.order.step)
        turn.put_task(task, command=command, absent_since=None)


def _call_robot(turn: Turn, task: FloorTask, robot: Robot) -> None:
    """Let a robot that no role names, but a value of the run, carry out a method of its own, when no run holds it."""
    if robot.run not in {"", task.run}:
        holder = turn.names.get(robot.run, "another run")
        turn.wait(task, "role_held", f"{turn.name(robot.id)} is held by {holder}.", robot=robot.id, run=holder)
    else:
        _perform(turn, turn.put_task(task, robot=robot.id), robot)


def limit_of(device: Description, name: str, arguments: Mapping[str, object]) -> float:
    """Return how many seconds a call may take: half as long again as its durations say, and a minute."""
    method = device.method(name)
    parameters = method.parameters if method else ()
    total = sum(lasting_s(spec, arguments.get(spec.name)) or 0.0 for spec in parameters)
    return 1.5 * total + 60.0 if total else CALL_LIMIT_S


def _await_device(turn: Turn, task: FloorTask, device: str) -> None:
    """Wait for a device that is away, but not for ever; its time begins anew when anything else was waited for last."""
    waited = task.wait is not None and (task.wait.code, task.wait.args.get("device")) == ("offline", device)
    since = task.absent_since if waited and task.absent_since is not None else turn.now
    if turn.now - since >= ABSENCE_S:
        turn.finish(task, "offline", f"{turn.name(device)} is offline.")
        return
    turn.put_task(task, absent_since=since)
    turn.wait(task, "offline", f"{turn.name(device)} is offline.", device=device)
