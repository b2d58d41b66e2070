"""The status light: a red, green and blue LED, or a single one that blinks in patterns."""

RED, GREEN, AMBER, BLUE = "red", "green", "amber", "blue"
MIXES = {RED: (1, 0, 0), GREEN: (0, 1, 0), AMBER: (1, 1, 0), BLUE: (0, 0, 1)}
# (milliseconds on, milliseconds off); ready is steady.
RHYTHMS = {RED: (150, 150), GREEN: (1, 0), AMBER: (100, 1900), BLUE: (1000, 1000)}


class ColourLight:
    """Three pins; `inverted` for LEDs that light when their pin is low."""

    def __init__(self, pins, inverted=False):
        self.pins, self.inverted = pins, inverted
        self.show("")

    def show(self, colour):
        """Light in a colour; an unknown one is dark."""
        for pin, on in zip(self.pins, MIXES.get(colour, (0, 0, 0))):
            pin.value(on ^ self.inverted)

    def beat(self, now_ms):
        """A colour does not blink."""


class SingleLight:
    """One pin: steady is ready, slow is at work, a short flash is waiting, quick is stopped or failed."""

    def __init__(self, pin, inverted=False):
        self.pin, self.inverted = pin, inverted
        self.colour = ""
        self.show("")

    def show(self, colour):
        """Blink in the rhythm of a colour; an unknown one is dark."""
        self.colour = colour
        self.beat(0)

    def beat(self, now_ms):
        """Switch the LED as its rhythm asks at this moment."""
        on_ms, off_ms = RHYTHMS.get(self.colour, (0, 1))
        self.pin.value((now_ms % (on_ms + off_ms) < on_ms) ^ self.inverted)
