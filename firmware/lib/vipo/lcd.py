"""An LCD 1602 (HD44780) behind a PCF8574 on I2C: 4 bits, write only.

The PCF8574's pins are P0 RS, P1 R/W, P2 E, P3 backlight, P4-P7 D4-D7. Each byte on the bus takes 90 us at 100 kHz, so
E is high for longer than the 450 ns it needs, and an instruction's 37 us are over before the next one ends. Longer
waits are those of the HD44780U data sheet, figure 24.
"""

import time

COLUMNS = 16
ROWS = (0x00, 0x40)
RS, ENABLE, BACKLIGHT = 0x01, 0x04, 0x08
FIRST_WAIT_S, RESET_WAIT_S, CLEAR_WAIT_S = 0.05, 0.005, 0.002
SET_ADDRESS, CLEAR = 0x80, 0x01
# Four bits and two lines, display on without a cursor, writing to the right.
HABITS = (0x28, 0x0C, 0x06)
ADDRESSES = tuple(range(0x20, 0x28)) + tuple(range(0x38, 0x40))


class NoLcd(OSError):
    """Nothing on the bus looks like a PCF8574."""


class Lcd:
    """The display. Methods raise OSError when it does not answer; `begin()` then sets it up anew."""

    def __init__(self, i2c, address=None):
        self.i2c, self.address = i2c, address
        self._buffer = bytearray(6)

    def begin(self):
        """Set the display up, whatever it was doing before: in 8 bits, in 4, or half way through a byte."""
        if self.address is None:
            self.address = self._find()
        time.sleep(FIRST_WAIT_S)
        for _ in range(3):
            self._nibble(0x30)
            time.sleep(RESET_WAIT_S)
        self._nibble(0x20)
        time.sleep(RESET_WAIT_S)
        for command in HABITS:
            self._send(command, 0)
        self._send(CLEAR, 0)
        time.sleep(CLEAR_WAIT_S)

    def write(self, row, line):
        """Put a line of 16 characters on a row, 0 or 1."""
        self._send(SET_ADDRESS | ROWS[row], 0)
        for character in line[:COLUMNS]:
            self._send(glyph(character), RS)

    def _find(self):
        for address in self.i2c.scan():
            if address in ADDRESSES:
                return address
        raise NoLcd("there is no LCD on the I2C bus")

    def _nibble(self, high):
        data = high | BACKLIGHT
        self.i2c.writeto(self.address, bytes((data, data | ENABLE, data)))

    def _send(self, value, mode):
        """Send a byte in two nibbles: data at rest, E up, E down."""
        for index, nibble in ((0, value & 0xF0), (3, (value << 4) & 0xF0)):
            data = nibble | mode | BACKLIGHT
            self._buffer[index] = self._buffer[index + 2] = data
            self._buffer[index + 1] = data | ENABLE
        self.i2c.writeto(self.address, self._buffer)


def glyph(character):
    """Return the HD44780's code of a character; those that its European and Japanese tables differ in become '?'."""
    return ord(character) if " " <= character <= "}" and character != "\\" else 0x3F
