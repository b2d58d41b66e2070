"""A dispenser: drives its output once for each object that it hands out; it does not count what is left."""

from vipo.declare import hand_over, number
from vipo.drivers.machine import Machine

PUSH_S, BACK_S = 1.5, 0.5


class Driver(Machine):
    """Method dispense; `object` in the configuration says of what, a box unless told."""

    device_class = "cans"
    about = "Hands objects to robots, one after the other."
    size = (0.6, 0.6, 1.2)
    readings = (number("dispensed", 0, None, "", "Handed out"),)
    order = ("dispense",)

    def __init__(self, panel, options):
        super().__init__(panel)
        self.gives = (options.get("object") or "box",)
        self.methods = {"dispense": hand_over("Dispense", self.gives[0])}
        self.properties["dispensed"] = 0

    async def dispense(self, work, object, value):
        """Push out `value` objects."""
        for count in range(int(value)):
            if count:
                await work.rest(BACK_S)  # else the pushes would be one long one
            self.panel.show("Dispensing", "%d of %d %s" % (count + 1, value, object))
            await work.spend(PUSH_S)
            self.properties["dispensed"] += 1
        self.panel.show("Dispensed", "%d x %s" % (value, object))
        return {"object": object, "value": int(value)}
