"""A script with nearly every construct, from text to the end of its rehearsal."""

from editor.language import compile_document, parse_script, plan_from_json, plan_to_json, tree_to_document
from editor.language.site.surroundings import DeviceFacts, Surroundings
from execution.rehearsals.rehearsal import Conditions, rehearse
from registry.floorplan.plan import FloorPlan
from simulation.world import Scene
from tests.kit import demo_floor

SCRIPT = """class Task(object):
    def new_task(self):
        self.count = 0
        for _ in range(2):
            self.count = self.count + 1
        self.stations = [self.shelf] + [self.booth]
        for number, station in enumerate(self.stations, 1):
            if number > 5:
                continue
            self.robot.move(station.location)
            if distance(self.robot, self.shelf) < 3:
                self.notify(f"At the shelf, {self.count}", level="info")
        self.dry = self.ask("Is it dry?", type="boolean", timeout=600)
        try:
            self.total = self.mix(minutes=quantity(3, "min"))
            while self.dry:
                try:
                    break
                finally:
                    self.wait(1)
        except (Blocked, TimedOut) as problem:
            self.end()
        finally:
            self.robot.move(self.dock.location)
        if self.booth in self.stations and len(self.stations) == 2:
            self.first = nth(self.stations, 1)
            self.robot.move(self.first.location)
        self.notify(f"Total {self.total}", level="warning")
        self.end()

    def mix(self, minutes: Number("min") = 3) -> Number("min"):
        try:
            return minutes * 2
        finally:
            self.wait(2)

    def when_e1(self):
        self.notify("It is late", level="info")

    def run(self, ctx):
        self.robot = ctx.any("move")
        self.shelf = ctx.get("itemInventory01")
        self.booth = ctx.get("paintMachine01")
        self.dock = ctx.place("dock1")
        ctx.when(now() > 28820, self.when_e1)
        self.new_task()
"""


def test_a_script_with_all_of_the_language_is_compiled_and_rehearsed():
    devices = demo_floor.devices()
    facts = {device.id: DeviceFacts(device) for device in devices}
    places = {place.id: place for place in demo_floor.places()}
    around = Surroundings(facts, places, FloorPlan(demo_floor.grid(), devices))
    tree = parse_script(SCRIPT, around).tree
    assert tree is not None
    plan = compile_document(tree_to_document(tree, around, None), around).plan
    assert plan is not None
    scene = Scene(demo_floor.grid(), devices, seed=1)
    plan = plan_from_json(plan_to_json(plan))
    result = rehearse(plan, scene, places=demo_floor.places(), conditions=Conditions("kinematic"))
    assert (result["ok"], result["errors"]) == (True, [])
    told = [line["text"] for line in result["log"] if line["text"].startswith(("Told", "Asked", "The rehearsal"))]
    assert told == [
        "Told: It is late",
        "Told: At the shelf, 2",
        "Asked: Is it dry?",
        "The rehearsal answers by itself: yes",
        "Told: Total 6",
    ]
