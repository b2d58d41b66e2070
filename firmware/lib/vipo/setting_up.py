"""Setting up a board: an access point with a password of its own, and the page that asks for the configuration."""

import asyncio
import os
import sys
import time

import machine
import network
from vipo.portable import load

load("form", "portal", "dns")

from vipo.dns import serve_names  # noqa: E402 - one after the other, to fit into a small heap
from vipo.portal import Portal, until_saved  # noqa: E402

HTTP_PORT, DNS_PORT = 80, 53
ALPHABET, KEY_LENGTH = "23456789abcdefghjkmnpqrstuvwxyz", 8


def set_up(panel, fault):
    """Open an access point with a password of its own and serve the set-up page until it was filled in."""
    sys.stdout.write((fault or "Somebody held the button.") + "\n")
    point = network.WLAN(network.AP_IF)
    point.active(True)
    name = "VIPO-" + "".join(["%02x" % byte for byte in machine.unique_id()[-3:]])
    password = "".join([ALPHABET[byte % len(ALPHABET)] for byte in os.urandom(KEY_LENGTH)])
    point.config(ssid=name, password=password, authmode=network.AUTH_WPA2_PSK)
    address, mask, _, _ = point.ifconfig()
    point.ifconfig((address, mask, address, address))  # who joins asks this board for names
    panel.show(name, "key " + password)
    sys.stdout.write("Join the Wi-Fi %s with %s and open http://%s\n" % (name, password, address))
    asyncio.run(until_saved(Portal(address, HTTP_PORT), serve_names(address, port=DNS_PORT)))
    time.sleep(1)
