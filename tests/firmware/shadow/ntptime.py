from machine import exists, note
from vipo import portable


def settime():
    note("time")
    if not exists("VIPO_TIME"):
        raise OSError(110)
    portable.CLOCK_IS_SET_S = 0
