# ruff: noqa: PTH123, PTH116, SIM115, RET503, UP031 - MicroPython, without pathlib; what stands here takes the board's heap
import os
import sys
import time

# Unbuffered, and nothing is kept: a line of microseconds, words and how many bytes follow, then these bytes.
RECORD = open(os.getenv("VIPO_RECORD"), "ab")
LEVELS = bytearray(b"\xff" * 40)


def note(words, data=b""):
    RECORD.write("%d %s %d\n" % (time.ticks_us(), words, len(data)))
    RECORD.write(data)


def unique_id():
    return b"\x24\x0a\xc4\x12\xab\xcd"


def reset():
    note("reset")
    sys.exit(7)


class Pin:
    IN, OUT, PULL_UP = 0, 1, 2

    def __init__(self, number, mode=0, pull=None, value=None):
        if str(number) in (os.getenv("VIPO_LACKS") or "").split():
            raise ValueError("invalid pin")
        self.number = number
        if pull:
            LEVELS[number] = not exists("VIPO_PRESSED")
        if value is not None:
            self.value(value)

    def value(self, level=None):
        before = LEVELS[self.number]
        if level is None:
            return before
        LEVELS[self.number] = level
        if before != level:
            note("pin %d %d" % (self.number, level))


class I2C:
    def __init__(self, bus, scl, sda, freq=400000):
        self.freq = freq
        note("i2c %d %d %d %d" % (bus, scl.number, sda.number, freq))

    def scan(self):
        return [int(word) for word in (os.getenv("VIPO_I2C") or "").split()]

    def writeto(self, address, data):
        if address not in self.scan() or exists("VIPO_UNPLUGGED"):
            raise OSError(19)
        note("write %d %d" % (address, self.freq), data)
        time.sleep_us((len(data) + 1) * 9000000 // self.freq)


class WDT:
    def __init__(self, timeout):
        note("watchdog %d" % timeout)

    def feed(self):
        note("fed")


def exists(name):
    try:
        return bool(os.stat(os.getenv(name)))
    except (OSError, TypeError):
        return False
