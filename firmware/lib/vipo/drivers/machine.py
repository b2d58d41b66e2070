"""What every machine is until its driver says otherwise."""


class Machine:
    """A machine that does nothing by itself."""

    gives = takes = ()

    def __init__(self, panel):
        self.panel = panel
        self.properties = {}

    def idle(self, seconds):
        """Let time pass without work."""

    def switched(self, on):
        """Learn that the output was switched: it is on while work is under way and not held."""
