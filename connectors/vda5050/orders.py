"""Orders and instant actions as VDA 5050 writes them. Positions are in the vehicle's own frame."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any, Literal

from connectors.vda5050.coordinates import Point

Body = Mapping[str, Any]
OrderKind = Literal["drive", "act"]
OURS = "vipo-"
"""How the ids of VIPO's orders begin, and of the actions in them."""


@dataclass(frozen=True, slots=True)
class Waypoint:
    """A point to drive to (m), how to face there (rad), and how fast to come (m/s); None leaves it to the vehicle."""

    point: Point
    theta: float | None = None
    speed_m_s: float | None = None


@dataclass(frozen=True, slots=True)
class Order:
    """An order that a vehicle was given: its newest message, and what of it the vehicle has said to have taken.

    `end` is the last node of the base. `taken` is the newest update that the vehicle has taken, -1 for none, and
    `taken_end` the end that it has since then. `given_up` is the oldest update that was taken back since, -1 for none.
    """

    id: str
    kind: OrderKind
    map_id: str
    body: Body
    update: int
    end: Body
    taken: int = -1
    taken_end: Body | None = None
    given_up: int = -1

    @property
    def is_taken(self) -> bool:
        """True when the vehicle has taken the newest update."""
        return self.taken == self.update

    @property
    def takes_horizon_away(self) -> bool:
        """True when its newest update is about nothing else."""
        return self.kind == "drive" and len(self.body["nodes"]) == 1

    @property
    def end_sequence(self) -> int:
        """The sequence id of the last node."""
        return int(self.end["sequenceId"])

    @property
    def end_point(self) -> Point:
        """Where the last node is."""
        position = self.end["nodePosition"]
        return float(position["x"]), float(position["y"])

    def with_taken(self) -> Order:
        """Return the order as it is when the vehicle has taken the newest update."""
        return replace(self, taken=self.update, taken_end=self.end, given_up=-1)

    def without_newest(self) -> Order:
        """Return the order as it is when the newest update was refused or given up; the number is not used again."""
        assert self.taken_end is not None
        given_up = self.update if self.given_up < 0 else self.given_up
        return replace(self, taken=self.update, end=self.taken_end, given_up=given_up)

    def has_given_up(self, update: int) -> bool:
        """Tell whether an update was given up; one that was held up on its way may be taken all the same."""
        return 0 <= self.given_up <= update and (self.is_taken or update < self.update)


def begin_drive(order_id: str, map_id: str, here: Point, way: Sequence[Waypoint], ahead: Sequence[Point]) -> Order:
    """Return a new order: from where the vehicle stands along a way, with the horizon `ahead` of it."""
    return _drive(Order(order_id, "drive", map_id, {}, 0, _node(map_id, 0, Waypoint(here))), way, ahead)


def extend_drive(order: Order, way: Sequence[Waypoint], ahead: Sequence[Point]) -> Order:
    """Return the order with more base and another horizon; the update begins with the last node of the base so far.

    With neither it takes the horizon away: only then does a vehicle take an order of another kind.
    """
    return _drive(replace(order, update=order.update + 1), way, ahead)


def _drive(order: Order, way: Sequence[Waypoint], ahead: Sequence[Point]) -> Order:
    nodes, edges = [dict(order.end)], []
    for count, waypoint in enumerate([*way, *map(Waypoint, ahead)], 1):
        sequence, released = order.end_sequence + 2 * count, count <= len(way)
        nodes.append({**_node(order.map_id, sequence, waypoint), "released": released})
        edges.append({**_edge(sequence - 1, nodes[-2], nodes[-1], waypoint), "released": released})
    return replace(order, body=_body(order, nodes, edges), end=nodes[len(way)])


def begin_actions(order_id: str, map_id: str, here: Point, actions: Sequence[Body]) -> Order:
    """Return a new order that has the vehicle act where it stands."""
    node = {**_node(map_id, 0, Waypoint(here)), "actions": list(actions)}
    order = Order(order_id, "act", map_id, {}, 0, node)
    return replace(order, body=_body(order, [node], []))


def action(action_id: str, action_type: str, parameters: Mapping[str, object]) -> Body:
    """Return an action that nothing else may be done beside."""
    written = [{"key": key, "value": value} for key, value in parameters.items()]
    return {"actionType": action_type, "actionId": action_id, "blockingType": "HARD", "actionParameters": written}


def instant_actions(actions: Sequence[Body], version: str) -> Body:
    """Return the message; 2.0 came with two names for its list, and vehicles read either."""
    return {"actions": list(actions), **({"instantActions": list(actions)} if version.startswith("2.0") else {})}


def order_to_json(order: Order) -> dict[str, Any]:
    """Return what order_from_json reads; it is asked for with each message, and so shares the order's body."""
    return {field.name: getattr(order, field.name) for field in fields(order)}


def order_from_json(body: Mapping[str, Any]) -> Order:
    """Return an order that was kept."""
    return Order(**body)


def _body(order: Order, nodes: list[dict[str, Any]], edges: list[dict[str, Any]]) -> Body:
    return {"orderId": order.id, "orderUpdateId": order.update, "nodes": nodes, "edges": edges}


def _node(map_id: str, sequence: int, waypoint: Waypoint) -> dict[str, Any]:
    x, y = waypoint.point
    position: dict[str, Any] = {"x": x, "y": y, "mapId": map_id}
    if waypoint.theta is not None:
        position["theta"] = waypoint.theta
    name = f"{x:.3f}:{y:.3f}"
    return {"nodeId": name, "sequenceId": sequence, "released": True, "nodePosition": position, "actions": []}


def _edge(sequence: int, start: Mapping[str, Any], end: Mapping[str, Any], waypoint: Waypoint) -> dict[str, Any]:
    names = (start["nodeId"], end["nodeId"])
    edge: dict[str, Any] = {
        "edgeId": "--".join(names),
        "sequenceId": sequence,
        "released": True,
        "startNodeId": names[0],
        "endNodeId": names[1],
        "actions": [],
    }
    if waypoint.speed_m_s is not None:
        edge["maxSpeed"] = waypoint.speed_m_s
    return edge
