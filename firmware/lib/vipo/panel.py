"""The face of a device: an LCD of two lines of 16 characters and a status light, behind one small port."""

import asyncio

from vipo.portable import ticks_ms

WIDTH = 16
OFF = ""
BEAT_S = 0.05


class Panel:
    """A panel without hardware; others override `_draw`, `_light` and `beat`."""

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

    async def run(self):
        """Let the light blink, for ever."""
        while True:
            await asyncio.sleep(BEAT_S)
            self.beat(ticks_ms())

    def beat(self, now_ms):
        """Do what the panel does by itself at this moment."""

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
        self._say("light %s" % (self.colour or "off"))

    def _say(self, line):
        self.stream.write(line + "\n")
        if hasattr(self.stream, "flush"):
            self.stream.flush()


class BoardPanel(ConsolePanel):
    """Writes to the console, and to a real LCD and a real light where there are any (None where not)."""

    def __init__(self, stream, lcd, light):
        super().__init__(stream)
        self.lcd, self.led = lcd, light
        self._on_lcd = None

    def beat(self, now_ms):
        """Let the light blink."""
        if self.led:
            self.led.beat(now_ms)

    def _light(self):
        super()._light()
        if self.led:
            self.led.show(self.colour)

    def _draw(self):
        super()._draw()
        if self.lcd:
            try:
                self._draw_lcd()
            except OSError as error:
                # An LCD that was unplugged must not stop the machine; the next text sets it up anew.
                self._on_lcd = None
                self._say("no LCD: %s" % error)

    def _draw_lcd(self):
        if self._on_lcd is None:
            self.lcd.begin()
            self._on_lcd = (" " * WIDTH, " " * WIDTH)
        for row, line in enumerate(self.lines):
            if line != self._on_lcd[row]:
                self.lcd.write(row, line)
        self._on_lcd = self.lines


def fit(line):
    """Return a line of exactly the LCD's width, without line breaks."""
    return (line.strip().replace("\n", " ") + " " * WIDTH)[:WIDTH]
