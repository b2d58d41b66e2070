"""A paint mixer: stirs for a time in minutes, warms the paint a little, hands out cans."""

ROOM_C = 22.0
WARM_C = 36.0
WARMING_S = 240.0
COOLING_S = 600.0
DISPENSE_S = 2.0


class Mixer:
    """The paper's paintMixer: methods mixPaint and dispense."""

    methods = {
        "mixPaint": {"time": (1, 30)},
        "dispense": {"object": ("can",), "value": (1, 2)},
    }

    def __init__(self, panel):
        self.panel = panel
        self.properties = {"jobStatus": 0, "temperature": ROOM_C}
        self._temperature = ROOM_C

    async def mixPaint(self, work, time):  # noqa: N802 - the method's name on the wire
        """Stir for `time` minutes."""
        self.properties["jobStatus"] = 0
        self.panel.show("Mixing Started", "%s min" % time)

        def progress(fraction, step_s):
            self.properties["jobStatus"] = int(fraction * 100)
            self._drift(WARM_C, WARMING_S, step_s)

        await work.spend(time * 60, progress)
        self.panel.show("Mixing Complete", "%s min" % time)
        return {"temperature": self.properties["temperature"]}

    async def dispense(self, work, object, value):
        """Put cans out for a robot."""
        self.panel.show("Dispensing", "%s x %s" % (value, object))
        await work.spend(DISPENSE_S)
        self.panel.show("Ready")
        return {"object": object, "value": value}

    def idle(self, seconds):
        """Cool down towards the room."""
        self._drift(ROOM_C, COOLING_S, seconds)

    def _drift(self, target_c, time_constant_s, seconds):
        """First-order approach to a temperature, in one explicit step."""
        self._temperature += (target_c - self._temperature) * min(1.0, seconds / time_constant_s)
        self.properties["temperature"] = round(self._temperature, 1)
