# ruff: noqa: PTH123, PTH116, SIM115, RUF005, RET503 - MicroPython, without pathlib
"""Stands before MicroPython's own `machine`, which has no pins on a computer: records what is done to the hardware.

Each line of the file named by VIPO_RECORD is [microseconds, what, ...]. A byte on I2C takes as long as on the wire.
"""

import json
import os
import sys
import time

RECORD = open(os.getenv("VIPO_RECORD"), "a")
START = time.ticks_us()
LEVELS = {}


def note(*what):
    RECORD.write(json.dumps([time.ticks_diff(time.ticks_us(), START)] + list(what)) + "\n")
    RECORD.flush()


def unique_id():
    return b"\x24\x0a\xc4\x12\xab\xcd"


def reset():
    note("reset")
    sys.exit(7)


class Pin:
    IN, OUT, PULL_UP = 0, 1, 2

    def __init__(self, number, mode=IN, pull=None, value=None):
        self.number, self.mode = number, mode
        self.level = 1 if pull == self.PULL_UP and not (number == 0 and _exists(os.getenv("VIPO_PRESSED"))) else 0
        if value is not None:
            self.value(value)

    def value(self, level=None):
        if level is None:
            return self.level
        if not isinstance(level, (int, bool)):
            raise TypeError("a pin is high or low")
        if LEVELS.get(self.number) != int(level):
            LEVELS[self.number] = int(level)
            note("pin", self.number, int(level))
        self.level = int(level)


class I2C:
    def __init__(self, bus, scl, sda, freq=400000):
        self.freq = freq
        note("i2c", bus, scl.number, sda.number, freq)

    def scan(self):
        return [int(word) for word in (os.getenv("VIPO_I2C") or "").split()]

    def writeto(self, address, data):
        if address not in self.scan() or _exists(os.getenv("VIPO_UNPLUGGED")):
            raise OSError(19, "ENODEV")
        note("write", address, self.freq, list(data))
        time.sleep_us((len(data) + 1) * 9000000 // self.freq)
        return len(data)


class WDT:
    def __init__(self, id=0, timeout=5000):
        note("watchdog", timeout)

    def feed(self):
        note("fed")


def _exists(path):
    try:
        os.stat(path)
    except (OSError, TypeError):
        return False
    return True
