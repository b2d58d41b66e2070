"""The Wi-Fi; not needed any more once it is joined, which it is again by itself later."""

import time

import network

TIMEOUT_S = 30


def join_wifi(name, password, look):
    """Return whether the network was joined in time; later it is joined again by itself. `look` is called meanwhile."""
    station = network.WLAN(network.STA_IF)
    station.active(True)
    station.connect(name, password or None)
    for _ in range(TIMEOUT_S * 10):
        look()
        if station.isconnected():
            return True
        time.sleep(0.1)
    return False
