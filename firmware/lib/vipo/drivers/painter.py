"""A painting booth: sprays a part for some minutes."""

from vipo.declare import number, timed
from vipo.drivers.timed import JOB, TimedMachine

AT_WORK_BAR = 2.5


class Driver(TimedMachine):
    """Method paint; the air pressure stands only while it works."""

    device_class = "booth"
    about = "Paints a box with the paint from a can for the given time."
    gives, takes = ("box",), ("box", "can")
    readings = (JOB, number("pressure", 0, 10, "BAR", "Air pressure"))
    methods = {"paint": timed("Paint", 30)}
    order = ("paint",)
    words = ("Paint Started", "Paint Complete")

    def __init__(self, panel, options):
        super().__init__(panel, options)
        self.properties["pressure"] = 0.0

    async def paint(self, work, time):
        """Spray for `time` minutes."""
        await self.work_for(work, time)

    def switched(self, on):
        """Let the air in or out."""
        self.properties["pressure"] = AT_WORK_BAR if on else 0.0
