"""A site as traffic sees it: the lattice, its zones, and the spots where robots stop.

Spots are stations, docks, named places and points.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import sqrt

from editor.language.site.surroundings import PlaceFacts
from execution.machine.floor_task import Target
from execution.traffic.directions import Edge, edges_against, preferred_cells
from execution.traffic.messages import FloorZone
from registry.floorplan.lattice import SIDE_M, STANDING_MARGIN_M, Ground, Lattice, Point, attach, make_lattice
from registry.floorplan.plan import FloorPlan, Grid, stations
from vipo_device.protocol.description import Description

BODY_M, APART_M = 0.6, 0.1
"""A robot off the lattice keeps others off all cells that near, larger ones off more: two that share none stand so far
apart at least, from body to body. docs/execution.md has the sum."""
CLEAR_M, LEFT_M = 0.44, 0.08
"""A cell is given back when the robot's middle is that far from the cell's, larger ones' farther: two radii and that
margin."""
MOST_POINTS = 50_000
"""So many points are kept at a time; more are worked out anew."""
DEFAULT_RADIUS_M = 0.18
Node = int | str
"""A cell by its number, or a spot by its id."""


class NoSuchSpot(Exception):
    """A target cannot be stood at; the message says why, in a sentence for a person."""


@dataclass(frozen=True, slots=True)
class Spot:
    """A place to stop: reached straight from the middle of `cell`; whoever stands there holds all cells of `body`."""

    id: str
    x: float
    y: float
    theta: float | None
    cell: int
    body: frozenset[int]


@dataclass(frozen=True)
class Layout:
    """All that does not change while robots drive. `stations` and `places` are by device and place id."""

    ground: Ground
    lattice: Lattice
    devices: Mapping[str, Description]
    stations: Mapping[str, Spot]
    places: Mapping[str, Spot]
    docks: tuple[str, ...]
    names: Mapping[str, str]
    zones: tuple[FloorZone, ...] = ()
    """What holds on this floor for every robot, besides the zones of its run's program."""
    bodies: tuple[FloorZone, ...] = ()
    """Where real robots stand that are simulated for a while, with the key `body/<id>`: all other robots keep out."""
    kept: Mapping[tuple[str, str], str] = field(default_factory=dict)
    """By run and place: the point where a place was when the run began, if it is elsewhere by now or gone."""
    points: dict[str, Spot] = field(default_factory=dict)
    zone_cells: dict[tuple[tuple[Point, ...], bool], frozenset[int]] = field(default_factory=dict)

    @property
    def clear_of_m(self) -> float:
        """How far a robot's middle is from that of a cell, in metres, when the cell is free for others."""
        return max(CLEAR_M, 2 * self.ground.radius_m + LEFT_M)

    @cached_property
    def numbering(self) -> str:
        """What tells by which lattice cells are numbered: nothing where its lines are half a metre apart from the map's
        corner on, as those of most floors are, so that the version before reads what is kept of these.
        """
        grid, lattice = self.ground.grid, self.lattice
        is_usual = all(
            abs(line - begin - (number + 0.5) * SIDE_M) < 1e-6
            for begin, lines in ((grid.origin_x_m, lattice.xs), (grid.origin_y_m, lattice.ys))
            for number, line in enumerate(lines)
        )
        return "" if is_usual else lattice.mark

    @cached_property
    def against(self) -> frozenset[Edge]:
        """The edges from cell to cell that no robot drives, since they lead against a one-way zone of the floor."""
        return edges_against(self.lattice, self.zones)

    @cached_property
    def against_backwards(self) -> frozenset[Edge]:
        """The same edges from their ends: for who looks from a goal for those who can come to it."""
        return frozenset((end, start) for start, end in self.against)

    @cached_property
    def preferred(self) -> frozenset[int]:
        """The cells where robots drive rather than elsewhere; none where the floor says nothing of that."""
        return preferred_cells(self.lattice, self.zones)

    def is_against(self, start: Node, end: Node) -> bool:
        """Tell whether an edge leads against a one-way zone; the last step between a cell and a spot is not judged."""
        return isinstance(start, int) and isinstance(end, int) and (start, end) in self.against

    def name(self, thing: str) -> str:
        """Return what people call a device or a place."""
        return self.names.get(thing, thing)

    def has_node(self, node: Node) -> bool:
        """Tell whether a node is there: a machine's goes when it is taken out, a point when one stands there."""
        if isinstance(node, int) or node in self.stations or node in self.places:
            return True
        try:
            return node.startswith("@") and bool(self.spot(node))
        except NoSuchSpot:
            return False

    def spot(self, spot: str) -> Spot:
        """Return a spot by its id: a device's, a place's, or `@x,y` for a point, `@x,y,theta` where robots face."""
        if spot in self.stations:
            return self.stations[spot]
        if spot in self.places:
            return self.places[spot]
        if spot not in self.points:
            if len(self.points) >= MOST_POINTS:
                self.points.clear()
            x, y, *theta = (float(part) for part in spot.removeprefix("@").split(","))
            self.points[spot] = _attach(self.ground, self.lattice, spot, (x, y), theta[0] if theta else None)
        return self.points[spot]

    def spot_for(self, target: Target, run: str = "") -> Spot:
        """Return the spot where a robot stands for a target, or for that of a run.

        Raises:
            NoSuchSpot: the target is unknown or nothing can stand there.
        """
        if target.point is not None:
            return self.spot(f"@{target.point[0]:.3f},{target.point[1]:.3f}")
        if (run, target.id) in self.kept:
            return self.spot(self.kept[run, target.id])
        if target.id in self.stations or target.id in self.places:
            return self.spot(target.id)
        if target.id in self.devices:
            raise NoSuchSpot(
                f"No robot can stand at {self.name(target.id)}; there is no free side that it can reach. "
                "The map's floor check says why."
            )
        raise NoSuchSpot(f"There is no device or place called “{target.id}” on this site.")

    def with_place(self, place: PlaceFacts) -> Layout:
        """Return the same floor with a place put elsewhere, on which robots drive as before."""
        places = {name: spot for name, spot in self.places.items() if name != place.id}
        theta = place.theta if place.kind == "dock" else None
        _put(places, self.ground, self.lattice, place.id, (place.x, place.y), theta)
        return replace(self, places=places)

    def point(self, node: Node) -> Point:
        """Return where a node is, in metres."""
        if isinstance(node, int):
            return self.lattice.centre(node)
        spot = self.spot(node)
        return (spot.x, spot.y)

    def cell(self, node: Node) -> int:
        """Return the cell of a node, or from which it is reached."""
        return node if isinstance(node, int) else self.spot(node).cell

    def needed(self, node: Node) -> frozenset[int]:
        """Return the cells that whoever stands at the node must hold."""
        return frozenset((node,)) if isinstance(node, int) else self.spot(node).body


def make_layout(
    grid: Grid, devices: Iterable[Description], places: Iterable[PlaceFacts] = (), zones: Iterable[FloorZone] = ()
) -> Layout:
    """Work out the layout of a site from its map, its approved devices, its named places and its zones."""
    devices = list(devices)
    radius_m = max((d.radius_m for d in devices if d.kind == "robot"), default=0.0) or DEFAULT_RADIUS_M
    ground = Ground(grid, FloorPlan(grid, devices).clearance_m, radius_m)
    lattice = make_lattice(ground)
    names = {d.id: d.name for d in devices} | {p.id: p.name for p in places}
    found: dict[str, Spot] = {}
    for device, pose in stations(grid, devices, radius_m).items():
        _put(found, ground, lattice, device, (pose.x, pose.y), pose.theta)
    named: dict[str, Spot] = {}
    for place in places:
        _put(named, ground, lattice, place.id, (place.x, place.y), place.theta if place.kind == "dock" else None)
    docks = tuple(p.id for p in places if p.kind == "dock" and p.id in named)
    by_id = {d.id: d for d in devices}
    return Layout(ground, lattice, by_id, found, named, docks, names, tuple(zones))


def _put(
    spots: dict[str, Spot], ground: Ground, lattice: Lattice, name: str, point: Point, theta: float | None
) -> None:
    """Add a spot if a robot can stand there; one that cannot be reached is found out when it is asked for."""
    try:
        spots[name] = _attach(ground, lattice, name, point, theta)
    except NoSuchSpot:
        return


def _attach(ground: Ground, lattice: Lattice, name: str, point: Point, theta: float | None) -> Spot:
    """Join a point to the lattice by the nearest cell from which one can drive straight to it."""
    if ground.room_m(point) < ground.radius_m + STANDING_MARGIN_M:
        raise NoSuchSpot(f"A robot cannot stand at ({point[0]:.2f}, {point[1]:.2f}); choose a place with more room.")
    cell = attach(ground, lattice, point)
    if cell is None:
        raise NoSuchSpot(f"No robot can reach ({point[0]:.2f}, {point[1]:.2f}).")
    body_m = max(BODY_M, lattice.gap_m / sqrt(2) + ground.radius_m + APART_M / 2)
    body = frozenset((cell, *lattice.cells_within(point, body_m)))
    return Spot(name, point[0], point[1], theta, cell, body)
