"""The life of an ESP32: Wi-Fi, the clock, then the machine that config.json describes; or the set-up page.

What is needed only for a while is loaded for a while: the heap is small.
"""

import time

import machine
from vipo.configuration import BadConfiguration, read_configuration
from vipo.portable import forget, load, show_error

CONFIGURATION = "config.json"
# Of the board in docs/devices/esp32.md; 0 is the BOOT button that most boards have.
DEFAULT_PINS = {"sda": 21, "scl": 22, "red": 25, "green": 26, "blue": 27, "output": 23, "button": 0}
NEEDED = ("host", "port", "id", "wifi_name")
WATCHDOG_MS = 60000
SHOWN_S = 5


def run():
    """Run for ever; whatever goes wrong ends in a restart, with the reason on the display."""
    configuration, fault = look_up()
    pins = configuration.get("pins") or DEFAULT_PINS
    output = make_output(pins)
    try:
        if fault or is_set_up_due(pins):
            from vipo.setting_up import set_up

            set_up(panel_of(pins), fault)
        else:
            serve(configuration, pins, output)
    except Exception as error:  # the edge of the program; Ctrl-C goes through, to whoever works on the board
        report(error, pins)
    machine.reset()


def report(error, pins):
    """Show why the program ended, if that can still be shown."""
    show_error(error)
    try:
        panel_of(pins).show("Fault", str(error))
    except (OSError, MemoryError, ImportError) as other:
        show_error(other)
    time.sleep(SHOWN_S)


def look_up():
    """Return (the configuration, why it cannot be used or an empty text)."""
    try:
        return read_configuration(CONFIGURATION, NEEDED), ""
    except BadConfiguration as error:
        return {}, str(error)


def make_output(pins):
    """Return what switches the machine's output, off to begin with; None without a pin."""
    if "output" not in pins:
        return None
    inverted = bool(pins.get("output_inverted"))
    # The level comes with the pin, so that nothing starts for a moment.
    pin = machine.Pin(pins["output"], machine.Pin.OUT, value=int(inverted))
    return lambda on: pin.value(on ^ inverted)


def is_set_up_due(pins):
    """Tell whether somebody asks for the set-up page."""
    from vipo.button import was_asked

    return was_asked(pins)


def panel_of(pins):
    """Return the panel of the board."""
    from vipo.board import make_panel

    return make_panel(pins)


def serve(configuration, pins, output):
    """Join the Wi-Fi and be the machine; returns when the Wi-Fi does not come."""
    panel = panel_of(pins)
    forget("board")
    identity = identify(configuration, panel)
    forget("identity")
    if not find_network(configuration, panel, pins):
        return
    forget("wifi", "button")
    device = make(configuration, panel, identity, output)
    forget("start", "certificate")
    del configuration, identity
    device.feed = machine.WDT(timeout=WATCHDOG_MS).feed
    import asyncio

    asyncio.run(device.run())


def identify(configuration, panel):
    """Return the driver and the description of the machine."""
    from vipo.identity import make_identity

    return make_identity(configuration, panel)


def find_network(configuration, panel, pins):
    """Join the Wi-Fi and set the clock; tell whether the Wi-Fi came."""
    from vipo.button import ask
    from vipo.wifi import join_wifi, set_clock

    name = configuration["wifi_name"]
    panel.show("Wi-Fi", name)
    if not join_wifi(name, configuration.get("wifi_password"), lambda: ask(panel, pins)):
        panel.show("No Wi-Fi", name)
        time.sleep(SHOWN_S)
        return False
    if not set_clock(configuration.get("time_server")) and configuration.get("ca"):
        panel.show("No time", "certificate?")
    return True


def make(configuration, panel, identity, output):
    """Return the device; its parts are loaded one after the other."""
    load("duties", "mqtt", "device", "start")
    from vipo.start import make_device

    return make_device(configuration, panel, identity, output)
