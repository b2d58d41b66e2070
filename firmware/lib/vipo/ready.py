"""From a configuration to a machine in the Wi-Fi; not needed any more once it speaks."""

import time

import machine
from vipo import chip
from vipo.configuration import BadConfiguration, read_configuration
from vipo.portable import forget, load

CONFIGURATION = "config.json"
NEEDED = ("host", "port", "id", "wifi_name")
WATCHDOG_MS = 60000


def look_up():
    """Return (the configuration, why it cannot be used or an empty text)."""
    try:
        return read_configuration(CONFIGURATION, NEEDED), ""
    except BadConfiguration as error:
        return {}, str(error)


def make_ready(configuration, board):
    """Join the Wi-Fi and return the machine, watched over; None when the Wi-Fi does not come.

    The large parts are loaded first, while there is room to compile them.
    """
    load("describe", "mqtt", "duties", "device")
    panel = board.panel()
    forget("board")
    identity = identify(configuration, panel)
    forget("identity", "describe")
    if not join(configuration, panel, board.pins):
        return None
    forget("wifi", "button")
    server = configuration.get("time_server")
    look_for_time = find_time(server, configuration.get("ca"))
    device = make(configuration, panel, identity, board.output)
    forget("start", "certificate", "recall")
    if look_for_time:
        look_for_time(device.client, server)
    device.feed = machine.WDT(timeout=WATCHDOG_MS).feed
    return device


def identify(configuration, panel):
    """Return the driver and the description of the machine."""
    from vipo.identity import make_identity

    return make_identity(configuration, panel)


def join(configuration, panel, pins):
    """Join the Wi-Fi; tell whether it came."""
    from vipo.button import ask
    from vipo.wifi import join_wifi

    name = configuration["wifi_name"]
    panel.show("Wi-Fi", name)
    if not join_wifi(name, configuration.get("wifi_password"), lambda: ask(panel, pins)):
        panel.show("No Wi-Fi", name)
        time.sleep(chip.SHOWN_S)
        return False
    return True


def find_time(server, is_needed):
    """Set the clock; return what asks for the time later where it did not come and is needed."""
    from vipo.clock import look_for_time, set_clock

    if not set_clock(server) and is_needed:
        return look_for_time
    forget("clock")
    return None


def make(configuration, panel, identity, output):
    """Return the device."""
    load("recall", "start")
    from vipo.start import make_device

    return make_device(configuration, panel, identity, output)
