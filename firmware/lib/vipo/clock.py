"""The time from the network; not needed any more once it is known."""

import sys

from vipo.portable import clock_is_set, forget

TIME_SERVER = "pool.ntp.org"


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
        sys.modules.pop("ntptime", None)
        forget("clock")
        await prepare()

    client.prepare = ask_first
