"""How long robots waited before zones: in one rehearsal, and what that comes to in many."""

from editor.language.expressions.nodes import PlaceRef
from editor.language.plan.instructions import End, Fork, Instruction, Move, Plan, RoleBinding
from editor.language.site.surroundings import ZoneFacts
from execution.rehearsals.rehearsal import Conditions, rehearse
from execution.rehearsals.zone_waits import ZoneCost, costs_of, mark_of
from tests.kit import demo_floor

SHELF, CANS = PlaceRef(device="itemInventory01"), PlaceRef(device="paintInventory01")
BOTH = Plan(
    (
        Instruction(Fork((1, 3), 0)),
        Instruction(Move("one", SHELF), "s1"),
        Instruction(End()),
        Instruction(Move("other", CANS), "s2"),
        Instruction(End()),
    ),
    {name: RoleBinding(name, f"robot0{n}", ("move",)) for n, name in enumerate(("one", "other"), 1)},
)
CORRIDOR = ((8.0, -10.0), (14.0, -10.0), (14.0, -6.0), (8.0, -6.0))


def rehearsed(robots):
    zone = ZoneFacts("corridor", "Corridor", "one_at_a_time", CORRIDOR, robots=robots)
    slow = ZoneFacts("slow", "Slow", "slow", CORRIDOR, 0.3)
    conditions = Conditions("kinematic")
    return rehearse(BOTH, demo_floor.scene(), places=demo_floor.places(), zones=(zone, slow), conditions=conditions)


def test_a_rehearsal_counts_how_long_robots_waited_before_a_full_zone_and_before_no_other():
    one, two = rehearsed(1)["zone_waits"], rehearsed(2)["zone_waits"]
    assert one.keys() == two.keys() == {"corridor"}
    assert one["corridor"]["waited_s"] > 3
    assert two["corridor"]["waited_s"] == 0
    assert one["corridor"]["mark"] == mark_of(CORRIDOR, 1) != mark_of(CORRIDOR, 2)


def test_the_cost_of_a_zone_is_that_of_the_rehearsals_that_knew_it_as_it_is():
    now, then = mark_of(CORRIDOR, 1), mark_of(CORRIDOR, 2)
    waits = [
        {"a": {"mark": now, "waited_s": 12.5}}, {"a": {"mark": now, "waited_s": 0.0}}, {},
        {"a": {"mark": then, "waited_s": 99.0}}, {"gone": {"mark": now, "waited_s": 7.0}},
    ]  # fmt: skip
    assert costs_of({"a": now, "b": now}, waits) == [ZoneCost("a", 2, 6.2, 12.5, 1), ZoneCost("b", 0, 0.0, 0.0, 0)]
    assert costs_of({}, waits) == []
