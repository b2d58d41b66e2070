# ruff: noqa: UP031 - MicroPython; what stands here takes the board's heap
import os

from machine import note

STA_IF, AP_IF = 0, 1
AUTH_WPA2_PSK = 3


class WLAN:
    def __init__(self, interface):
        self.interface = interface

    def active(self, on):
        note("wifi %d %d" % (self.interface, on))

    def connect(self, name, password):
        tell("join", [name, password])
        self.joined = name == os.getenv("VIPO_WIFI")

    def isconnected(self):
        return self.joined

    def config(self, **settings):
        tell("point", [settings])

    def ifconfig(self, wanted=None):
        if wanted:
            tell("addresses", [wanted])
        return ("127.0.0.1", "255.255.255.0", "127.0.0.1", "127.0.0.1")


def tell(word, values):
    import json

    note(word, json.dumps(values).encode())
