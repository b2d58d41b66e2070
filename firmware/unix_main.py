"""Run the firmware as a process of a computer: micropython unix_main.py CONFIG.json (or python3 …)."""

import asyncio
import sys

sys.path.insert(0, (__file__.rsplit("/", 1)[0] if "/" in __file__ else ".") + "/lib")

from vipo.configuration import BadConfiguration, read_configuration
from vipo.drivers import NoSuchDriver
from vipo.panel import ConsolePanel
from vipo.portable import load


def main():
    """Run until killed; the broker then sends the will."""
    if len(sys.argv) != 2:
        print("usage: unix_main.py CONFIG.json")
        sys.exit(2)
    try:
        configuration = read_configuration(sys.argv[1])
        stream = open(configuration["log"], "w") if configuration.get("log") else sys.stdout
        device = make(configuration, ConsolePanel(stream))
    except (BadConfiguration, NoSuchDriver, OSError) as error:
        print(error)
        sys.exit(2)
    try:
        asyncio.run(device.run())
    except KeyboardInterrupt:
        pass


def make(configuration, panel):
    """Return the device; its parts are loaded one after the other, to fit into a small heap."""
    from vipo.identity import make_identity

    identity = make_identity(configuration, panel)
    load("duties", "mqtt", "device", "start")
    from vipo.start import make_device

    return make_device(configuration, panel, identity)


main()
