"""A curing oven: heats a painted part for some minutes."""

from vipo.declare import number, timed
from vipo.drivers.timed import JOB, TimedMachine


class Driver(TimedMachine):
    """Method curePaint; the LCD shows the paper's words."""

    device_class = "oven"
    about = "Cures the paint on a box for the given time."
    gives = takes = ("box",)
    readings = (JOB, number("temperature", 15, 250, "DEG_C", "Temperature"))
    methods = {"curePaint": timed("Cure paint", 60)}
    order = ("curePaint",)
    words = ("Curing Started", "Curing Complete")
    works_at_c, warming_s, cooling_s = 80.0, 60.0, 120.0

    async def curePaint(self, work, time):  # noqa: N802 - the method's name on the wire
        """Keep warm for `time` minutes."""
        await self.work_for(work, time)
        return {"temperature": self.properties["temperature"]}
