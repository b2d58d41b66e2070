"""The panel of a board: LCD and status light on the pins that the configuration names."""

import sys

from machine import I2C, Pin
from vipo.lcd import Lcd
from vipo.light import ColourLight, SingleLight
from vipo.panel import BoardPanel

I2C_HZ = 100000
COLOUR_PINS = ("red", "green", "blue")


def make_panel(pins, stream=sys.stdout):
    """Return the panel of a board; what has no pins is left out."""
    lcd = None
    if "sda" in pins and "scl" in pins:
        lcd = Lcd(I2C(0, scl=Pin(pins["scl"]), sda=Pin(pins["sda"]), freq=I2C_HZ), pins.get("lcd"))
    return BoardPanel(stream, lcd, make_light(pins))


def make_light(pins):
    """Return the status light, or None."""
    inverted = bool(pins.get("inverted"))
    if all(name in pins for name in COLOUR_PINS):
        return ColourLight([Pin(pins[name], Pin.OUT) for name in COLOUR_PINS], inverted)
    return SingleLight(Pin(pins["led"], Pin.OUT), inverted) if "led" in pins else None
