"""A relay: something that is switched on for some minutes: a lamp, a fan, a conveyor."""

from vipo.declare import boolean, timed
from vipo.drivers.timed import JOB, TimedMachine


class Driver(TimedMachine):
    """Method run: the output is on for `time` minutes, and off when they are over, held or cancelled."""

    device_class = "relay"
    about = "Switches something on for the given time."
    size = (0.3, 0.3, 0.3)
    readings = (JOB, boolean("on", "On"))
    methods = {"run": timed("Run", 600)}
    order = ("run",)
    words = ("Switched on", "Switched off")

    def __init__(self, panel, options):
        super().__init__(panel, options)
        self.properties["on"] = False

    async def run(self, work, time):
        """Keep the output on for `time` minutes."""
        await self.work_for(work, time)

    def switched(self, on):
        """Tell whether the output is on."""
        self.properties["on"] = on
