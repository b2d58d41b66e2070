"""What machines share that work for some minutes: a job in percent, and a warmth that rises and falls."""

from vipo.declare import number
from vipo.drivers.machine import Machine

ROOM_C = 22.0
JOB = number("jobStatus", 0, 100, "PERCENT", "Job")


class TimedMachine(Machine):
    """A machine with one long job; `words` are what its LCD says at the start and at the end of it."""

    size = (0.8, 0.8, 1.2)
    words = ("Started", "Complete")
    works_at_c, warming_s, cooling_s = ROOM_C, 60.0, 120.0

    def __init__(self, panel, options):
        super().__init__(panel)
        self.properties["jobStatus"] = 0
        self._celsius = ROOM_C
        self._read_warmth()

    async def work_for(self, work, minutes):
        """Do the job for some minutes; the LCD says when it starts and when it is complete."""
        self.properties["jobStatus"] = 0
        self.panel.show(self.words[0], "%s min" % minutes)

        def progress(fraction, step_s):
            self.properties["jobStatus"] = int(fraction * 100)
            self._drift(self.works_at_c, self.warming_s, step_s)

        await work.spend(minutes * 60, progress)
        self.panel.show(self.words[1], "%s min" % minutes)

    def idle(self, seconds):
        """Cool down towards the room."""
        self._drift(ROOM_C, self.cooling_s, seconds)

    def _drift(self, target_c, time_constant_s, seconds):
        """First-order approach to a temperature, in one explicit step."""
        self._celsius += (target_c - self._celsius) * min(1.0, seconds / time_constant_s)
        self._read_warmth()

    def _read_warmth(self):
        if any(value["name"] == "temperature" for value in self.readings):
            self.properties["temperature"] = round(self._celsius, 1)
