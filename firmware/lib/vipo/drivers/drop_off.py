"""A drop-off: rollers that take what robots bring until they are full, and are emptied by people."""

from vipo.declare import hand_over, method, number
from vipo.drivers.counting import Count
from vipo.drivers.machine import Machine
from vipo.work import Failure

HAND_S = 2.0
SLOTS = 9


class Driver(Machine):
    """Methods accept and empty; `object` and `slots` in the configuration say what and how much fits."""

    device_class = "rollers"
    about = "Takes finished objects for dispatch."
    size = (2.0, 0.8, 0.8)
    order = ("accept", "empty")

    def __init__(self, panel, options):
        super().__init__(panel)
        slots = int(options.get("slots") or SLOTS)
        self.takes = (options.get("object") or "box",)
        self.readings = (number("freeSlots", 0, slots, "", "Free slots"),)
        self.methods = {"accept": hand_over("Accept", self.takes[0], slots), "empty": method("Empty")}
        self._count = Count(options.get("count_file"), slots, slots)
        self.properties["freeSlots"] = self._count.value

    async def accept(self, work, object, value):
        """Take `value` objects in, or say that there is no room."""
        if self._count.value < value:
            raise Failure("there is room for %d %s, not %d" % (self._count.value, object, value))
        self.panel.show("Accepting", "%d x %s" % (value, object))
        await work.spend(HAND_S)
        self._count.change(-value)
        return self._tell("Accepted")

    async def empty(self, work):
        """Note that everything was taken away."""
        self._count.set(self._count.most)
        return self._tell("Emptied")

    def _tell(self, word):
        self.properties["freeSlots"] = self._count.value
        self.panel.show(word, "%d free" % self._count.value)
        return {"freeSlots": self._count.value}
