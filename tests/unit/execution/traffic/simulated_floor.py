"""The smallest world that answers the floor: points that drive exactly along what was released."""

from math import hypot

from execution.traffic import floor
from execution.traffic import messages as m

SPEED_M_S = 0.5
NAMESPACE = "00000000-0000-4000-8000-000000000001"


class PretendFloor:
    """A floor with its devices; checks at every step that no two robots hold a cell."""

    def __init__(self, layout, poses=None, deaf=()):
        self.layout = layout
        self.state = floor.start(layout, NAMESPACE)
        docks = [layout.places[d] for d in layout.docks]
        homes = [(dock.x, dock.y) for dock in docks] + [(1.0, -8.0)] * len(self.state.robots)
        self.at = dict(zip(sorted(self.state.robots), homes, strict=False))
        self.at.update(poses or {})
        self.queue = {name: [] for name in self.at}
        self.works = []
        self.halted = set()
        self.deaf = set(deaf)
        self.now = 0.0
        self.over = {}
        self.sent = []
        self.waits = []
        self.nearest = 9.0
        self.tell(*(m.RobotMoved(name, *at) for name, at in self.at.items()))

    def tell(self, *events):
        self.state, actions = floor.step(self.layout, self.state, events, self.now)
        self.check_cells()
        for action in actions:
            if isinstance(action, m.SendCommand):
                self.take(action)
            elif isinstance(action, m.TaskOver):
                self.over[action.run, action.task] = (action.kind, action.why)
            elif isinstance(action, m.WaitChanged):
                self.waits.append(action)
        return actions

    def take(self, command):
        self.sent.append(command)
        if command.device in self.deaf:
            return
        if command.method == "move":
            self.queue[command.device].append((command.id, [tuple(p) for p in command.arguments["path"]]))
        elif command.method == "pause":
            self.halted.add(command.device)
        elif command.method == "resume":
            self.halted.discard(command.device)
        elif command.method == "cancel":
            pieces = self.queue.get(command.device, [])
            pieces[:] = [piece for piece in pieces if piece[0] != command.arguments["command"]]
        else:
            self.works.append((self.now + 2.0, command.id))

    def check_cells(self):
        held = [cell for robot in self.state.robots.values() for cell in robot.held]
        assert len(held) == len(set(held)), "two robots hold a cell"

    def pass_time(self, dt_s=0.1):
        self.now = round(self.now + dt_s, 6)
        events = []
        for name in self.at:
            if name not in self.deaf | self.halted:
                events.extend(self.drive(name, SPEED_M_S * dt_s))
                events.append(m.RobotMoved(name, *self.at[name]))
        done = [work for work in self.works if work[0] <= self.now]
        self.works = [work for work in self.works if work[0] > self.now]
        events.extend(m.CommandAnswered(command, "DONE") for _, command in done)
        self.measure()
        return self.tell(*events, m.Tick())

    def drive(self, name, left_m):
        while self.queue[name] and left_m > 1e-9:
            command, points = self.queue[name][0]
            (x, y), (px, py) = self.at[name], points[0]
            gap = hypot(px - x, py - y)
            if gap > left_m:
                self.at[name] = (x + (px - x) * left_m / gap, y + (py - y) * left_m / gap)
                return
            self.at[name] = (px, py)
            left_m -= gap
            points.pop(0)
            if not points:
                self.queue[name].pop(0)
                yield m.CommandAnswered(command, "DONE")

    def measure(self):
        names = sorted(self.at)
        for i, a in enumerate(names):
            for b in names[i + 1 :]:
                gap = hypot(self.at[a][0] - self.at[b][0], self.at[a][1] - self.at[b][1])
                self.nearest = min(self.nearest, gap)

    def run_until(self, settled, limit_s=600.0):
        end = self.now + limit_s
        while not settled() and self.now < end:
            self.pass_time()
        assert settled(), f"not settled by {self.now} s: {self.describe()}"

    def describe(self):
        robots = [
            (r.id, r.path[r.passed :][:3], r.evading, r.yields_to, r.blocked_since) for r in self.state.robots.values()
        ]
        return robots, [(j.run, j.number, j.robot, j.wait) for j in self.state.tasks], dict(self.state.stations)
