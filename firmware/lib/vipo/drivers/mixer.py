"""A paint mixer: stirs for some minutes, warms the paint a little, hands out cans."""

from vipo.declare import hand_over, number, timed
from vipo.drivers.timed import JOB, TimedMachine

DISPENSE_S = 2.0


class Driver(TimedMachine):
    """The paper's paintMixer: methods mixPaint and dispense."""

    device_class = "mixer"
    about = "Mixes a can of paint for the given time."
    gives = takes = ("can",)
    readings = (JOB, number("temperature", 0, 80, "DEG_C", "Temperature"))
    methods = {"mixPaint": timed("Mix paint", 30), "dispense": hand_over("Dispense", "can")}
    order = ("mixPaint", "dispense")
    words = ("Mixing Started", "Mixing Complete")
    works_at_c, warming_s, cooling_s = 36.0, 240.0, 600.0

    async def mixPaint(self, work, time):  # noqa: N802 - the method's name on the wire
        """Stir for `time` minutes."""
        await self.work_for(work, time)
        return {"temperature": self.properties["temperature"]}

    async def dispense(self, work, object, value):
        """Put cans out for a robot."""
        self.panel.show("Dispensing", "%s x %s" % (value, object))
        await work.spend(DISPENSE_S)
        self.panel.show("Ready")
        return {"object": object, "value": value}
