"""The face of a device: an LCD of two lines of 16 characters and a status light, behind one small port."""

WIDTH = 16
OFF, GREEN, AMBER, RED, BLUE = "off", "green", "amber", "red", "blue"


class Panel:
    """A panel without hardware; others override `_draw` and `_light`."""

    def __init__(self):
        self.lines = (" " * WIDTH, " " * WIDTH)
        self.colour = OFF

    def show(self, first, second=""):
        """Put two lines on the LCD, each cut or filled to its width."""
        lines = (fit(first), fit(second))
        if lines != self.lines:
            self.lines = lines
            self._draw()

    def light(self, colour):
        """Switch the status light."""
        if colour != self.colour:
            self.colour = colour
            self._light()

    def _draw(self):
        pass

    def _light(self):
        pass


class ConsolePanel(Panel):
    """Writes what the LCD and the light show, one line for each change, to a stream such as standard output."""

    def __init__(self, stream):
        super().__init__()
        self.stream = stream

    def _draw(self):
        self._say("LCD |%s|%s|" % self.lines)

    def _light(self):
        self._say("light %s" % self.colour)

    def _say(self, line):
        self.stream.write(line + "\n")
        if hasattr(self.stream, "flush"):
            self.stream.flush()


def fit(line):
    """Return a line of exactly the LCD's width."""
    return (line + " " * WIDTH)[:WIDTH]
