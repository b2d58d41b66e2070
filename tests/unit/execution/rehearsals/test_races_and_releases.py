"""A Parallel that ends with the first branch, and roles that give their robots back, with simulated robots."""

from editor.language import compile_document, parse_script, tree_to_document
from execution.machine.messages import StepEntered, StepLeft
from execution.rehearsals.recorder import Recorder
from execution.rehearsals.rehearsal import Conditions, rehearse
from execution.traffic.messages import SendCommand
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


def recorded(*actions):
    """Return how the recorder tells the steps of what a run and its floor do, at these times."""
    recorder = Recorder(demo_floor.layout(), {})
    for t_s, action in actions:
        recorder.note_floor(t_s, action) if isinstance(action, SendCommand) else recorder.note_run(t_s, action)
    return recorder


def test_of_a_step_that_two_branches_are_in_the_one_that_was_begun_first_ends_first():
    began, left = StepEntered("f1"), StepLeft("f1")
    recorder = recorded((0, began), (0.5, began), (10, left))
    assert recorder.step_now() == "f1"
    recorder.note_run(20, left)
    steps = recorder.result(30.0, ok=True)["steps"]
    told = [(each["count"], each["started_s"], each["ended_s"], each["status"]) for each in steps]
    assert told == [(1, 0, 10, "done"), (2, 0.5, 20, "done")]


def test_what_is_still_open_at_the_end_has_failed_though_two_branches_were_in_it():
    began = StepEntered("f1")
    steps = recorded((0, began), (0.5, began), (10, StepLeft("f1"))).result(30.0, ok=False)["steps"]
    assert [(each["ended_s"], each["status"]) for each in steps] == [(10, "done"), (30, "failed")]


def test_the_step_that_is_told_as_going_on_is_the_one_that_was_begun_last():
    recorder = recorded((0, StepEntered("f1")), (1, StepEntered("f2")), (2, StepEntered("f1")))
    assert recorder.step_now() == "f1"
    recorder.note_run(3, StepLeft("f2"))
    recorder.note_run(4, StepLeft("f1"))
    assert recorder.step_now() == "f1"


def test_each_entry_of_a_step_that_two_branches_are_in_has_its_own_robot():
    began, left = StepEntered("f1"), StepLeft("f1")
    first, second = (SendCommand(f"c{n}", f"robot0{n}", "move", {}, step="f1") for n in (1, 2))
    steps = recorded((0, began), (0, began), (1, first), (2, second), (3, first), (10, left), (20, left)).steps
    assert [(each["robot"], each["ended_s"]) for each in steps] == [("robot01", 10), ("robot02", 20)]


def test_two_branches_that_call_one_function_leave_no_step_that_runs_for_ever():
    result = rehearsed("""class Task(object):
    def new_task(self):
        self.parallel(self.branch_1a, self.branch_1b)

    def branch_1a(self):
        self.rest()

    def branch_1b(self):
        self.wait(5)
        self.rest()

    def rest(self):
        self.wait(20)

    def run(self, ctx):
        self.new_task()
""")
    assert (result["ok"], {each["status"] for each in result["steps"]}) == (True, {"done"})
    rests = [each for each in result["steps"] if each["count"] == 2]
    assert len(rests) == 1
    assert [round(each["ended_s"]) for each in result["steps"] if each["step"] == rests[0]["step"]] == [20, 25]


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
