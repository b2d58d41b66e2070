"""The set-up button of a board, which is looked at until the device speaks.

BOOT cannot be held at the start itself: an ESP32 then waits for new firmware.
"""

import os
import time

import machine
from vipo.portable import write_file

ASKED = "set-up"


def is_pressed(pins):
    """Tell whether the button is held; it pulls its pin down."""
    return "button" in pins and not machine.Pin(pins["button"], machine.Pin.IN, machine.Pin.PULL_UP).value()


def ask(panel, pins):
    """Start again with the set-up page if the button is held."""
    if is_pressed(pins):
        panel.show("Set-up page", "release button")
        while is_pressed(pins):
            time.sleep(0.05)
        write_file(ASKED, "")
        machine.reset()


def was_asked(pins):
    """Tell whether somebody asks for the set-up page, or did before this start; that is forgotten then."""
    try:
        os.remove(ASKED)
    except OSError:
        return is_pressed(pins)
    return True
