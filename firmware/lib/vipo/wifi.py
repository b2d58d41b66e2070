"""The way to the network: the Wi-Fi, then the clock; not needed any more once the device speaks."""

import sys
import time

import network
from vipo.portable import clock_is_set

TIMEOUT_S = 30
TIME_SERVER = "pool.ntp.org"


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


def set_clock(server):
    """Return whether the clock is right: certificates are dated, and boots count by it when their file is lost."""
    if not clock_is_set():
        try:
            import ntptime

            ntptime.host, ntptime.timeout = server or TIME_SERVER, 2
            ntptime.settime()
        except (OSError, ImportError, OverflowError) as error:
            sys.stdout.write("no time from %s: %s\n" % (server or TIME_SERVER, error))
    return clock_is_set()


def look_for_time(client, server):
    """Ask for the time before each connection until it is known: without it no certificate can be judged."""
    prepare = client.prepare

    async def ask_first():
        if not set_clock(server):
            raise OSError("no time yet")
        client.prepare = prepare
        await prepare()

    client.prepare = ask_first
