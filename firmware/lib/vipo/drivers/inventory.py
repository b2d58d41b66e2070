"""An inventory: a shelf that knows how much is on it, hands objects to robots, and is filled by people."""

from vipo.declare import count, hand_over, method, number
from vipo.drivers.counting import Count
from vipo.drivers.machine import Machine
from vipo.work import Failure

HAND_S = 2.0
SLOTS = 24


class Driver(Machine):
    """Methods dispense and refill; `object` and `slots` in the configuration say of what and how much at most."""

    device_class = "shelf"
    about = "Keeps objects and hands them to robots."
    size = (1.2, 0.6, 1.8)
    order = ("dispense", "refill")

    def __init__(self, panel, options):
        super().__init__(panel)
        slots = int(options.get("slots") or SLOTS)
        self.gives = (options.get("object") or "box",)
        self.readings = (number("stock", 0, slots, "", "In stock"),)
        self.methods = {
            "dispense": hand_over("Dispense", self.gives[0], slots),
            "refill": method("Refill", "", count("value", 0, slots)),
        }
        self._count = Count(options.get("count_file"), slots, slots)
        self.properties["stock"] = self._count.value

    async def dispense(self, work, object, value):
        """Hand out `value` objects, or say that there are too few."""
        if self._count.value < value:
            raise Failure("there are %d %s, not %d" % (self._count.value, object, value))
        self.panel.show("Dispensing", "%d x %s" % (value, object))
        await work.spend(HAND_S)
        self._count.change(-value)
        return self._tell("Dispensed")

    async def refill(self, work, value):
        """Note that there are `value` objects now."""
        self._count.set(value)
        return self._tell("Refilled")

    def _tell(self, word):
        self.properties["stock"] = self._count.value
        self.panel.show(word, "%d left" % self._count.value)
        return {"stock": self._count.value}
