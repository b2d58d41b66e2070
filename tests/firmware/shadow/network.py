"""A Wi-Fi for a computer: it is there when VIPO_WIFI names it; what is asked of it is recorded."""

import os

from machine import note

STA_IF, AP_IF = 0, 1
AUTH_WPA2_PSK = 3


class WLAN:
    def __init__(self, interface):
        self.interface, self.joined = interface, False

    def active(self, on):
        note("wifi", self.interface, on)

    def connect(self, name, password):
        note("join", name, password)
        self.joined = name == os.getenv("VIPO_WIFI")

    def isconnected(self):
        return self.joined

    def config(self, **settings):
        note("point", settings)

    def ifconfig(self, wanted=None):
        if wanted:
            note("addresses", wanted)
        return ("127.0.0.1", "255.255.255.0", "127.0.0.1", "127.0.0.1")
