"""A Parallel that ends with the first branch, and roles that give their robots back, with simulated robots."""

from editor.language import compile_document, parse_script, tree_to_document
from execution.rehearsals.rehearsal import Conditions, rehearse
from simulation.world import Scene
from tests.kit import demo_floor
from tests.kit.demo_site import factory

SITE = factory()


def rehearsed(script):
    """Rehearse a script in the factory, where nothing is to be mended in it."""
    tree = parse_script(script, SITE).tree
    assert tree is not None
    compiled = compile_document(tree_to_document(tree, SITE), SITE)
    assert [d.code for d in compiled.diagnostics] == []
    scene = Scene(demo_floor.grid(), demo_floor.devices(), seed=1)
    return rehearse(compiled.plan, scene, places=demo_floor.places(), conditions=Conditions("kinematic"))


def texts(result):
    return [line["text"] for line in result["log"]]


def test_a_drive_that_is_called_off_stops_and_the_robot_does_what_follows():
    result = rehearsed("""class Task(object):
    def new_task(self):
        self.parallel(self.branch_1a, self.branch_1b, needed=1)
        self.robot.move(self.item_inventory.location)

    def branch_1a(self):
        self.robot.move(self.drop_off.location)

    def branch_1b(self):
        self.wait(2)

    def run(self, ctx):
        self.robot = ctx.get("robot01")
        self.drop_off = ctx.get("dropOff01")
        self.item_inventory = ctx.get("itemInventory01")
        self.new_task()
""")
    assert (result["ok"], result["errors"]) == (True, [])
    parallel, drive, wait, last = (dict(entry) for entry in result["steps"])
    assert [entry["status"] for entry in (parallel, drive, wait, last)] == ["done", "skipped", "done", "done"]
    assert 1.9 <= wait["ended_s"] <= 3
    assert parallel["ended_s"] == drive["ended_s"] == last["started_s"] == wait["ended_s"]
    assert last["robot"] == "robot01"


def test_a_released_robot_serves_another_role_and_the_log_tells_it():
    result = rehearsed("""class Task(object):
    def new_task(self):
        self.first.move(self.item_inventory.location)
        self.first.release()
        self.second.move(self.drop_off.location)
        self.second.release()
        self.first.move(self.item_inventory.location)

    def run(self, ctx):
        self.first = ctx.get("robot02")
        self.second = ctx.any("move")
        self.item_inventory = ctx.get("itemInventory01")
        self.drop_off = ctx.get("dropOff01")
        self.new_task()
""")
    assert (result["ok"], result["errors"]) == (True, [])
    released = [text for text in texts(result) if "is released from the role" in text]
    assert len(released) == 2
    assert released[0] == "TurtleBot 2 is released from the role “first”."
    assert sum("takes the role “first”" in text for text in texts(result)) == 2
