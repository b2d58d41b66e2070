"""The life of an ESP32: Wi-Fi, the clock, then the machine that config.json describes; or the set-up page."""

import os
import sys
import time

import machine
import network
from vipo.configuration import BadConfiguration, read_configuration, write_file
from vipo.portable import clock_is_set, load, show_error

CONFIGURATION, ASKED = "config.json", "set-up"
# Of the board in docs/devices/esp32.md; 0 is the BOOT button that most boards have.
DEFAULT_PINS = {"sda": 21, "scl": 22, "red": 25, "green": 26, "blue": 27, "output": 23, "button": 0}
NEEDED = ("host", "port", "id", "wifi_name")
WIFI_TIMEOUT_S = 30
WATCHDOG_MS = 60000
SHOWN_S = 5
TIME_SERVER = "pool.ntp.org"


def run():
    """Run for ever; whatever goes wrong ends in a restart, with the reason on the display."""
    configuration, fault = look_up()
    pins = configuration.get("pins") or DEFAULT_PINS
    output = make_output(pins)
    try:
        if fault or is_pressed(pins) or was_asked():
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


def is_pressed(pins):
    """Tell whether the set-up button is held; it pulls its pin down."""
    return "button" in pins and not machine.Pin(pins["button"], machine.Pin.IN, machine.Pin.PULL_UP).value()


def panel_of(pins):
    """Return the panel of the board."""
    from vipo.board import make_panel

    return make_panel(pins)


def serve(configuration, pins, output):
    """Join the Wi-Fi and be the machine; returns when the Wi-Fi does not come."""
    from vipo.identity import make_identity

    panel = panel_of(pins)
    identity = make_identity(configuration, panel)
    load("duties", "mqtt", "device", "start")
    from vipo.start import make_device

    panel.show("Wi-Fi", configuration["wifi_name"])
    if not join_wifi(configuration["wifi_name"], configuration.get("wifi_password"), lambda: ask(panel, pins)):
        panel.show("No Wi-Fi", configuration["wifi_name"])
        time.sleep(SHOWN_S)
        return
    if not set_clock(configuration.get("time_server", TIME_SERVER)) and configuration.get("ca"):
        panel.show("No time", "certificate?")
    device = make_device(configuration, panel, identity, output)
    device.feed = machine.WDT(timeout=WATCHDOG_MS).feed
    import asyncio

    asyncio.run(device.run())


def join_wifi(name, password, look):
    """Return whether the network was joined in time; later it is joined again by itself. `look` is called meanwhile."""
    station = network.WLAN(network.STA_IF)
    station.active(True)
    station.connect(name, password or None)
    for _ in range(WIFI_TIMEOUT_S * 10):
        look()
        if station.isconnected():
            return True
        time.sleep(0.1)
    return False


def ask(panel, pins):
    """Start again with the set-up page if the button is held.

    BOOT cannot be held at the start itself: an ESP32 then waits for new firmware.
    """
    if is_pressed(pins):
        panel.show("Set-up page", "release button")
        while is_pressed(pins):
            time.sleep(0.05)
        write_file(ASKED, "")
        machine.reset()


def was_asked():
    """Tell whether somebody asked for the set-up page before this start, and forget it."""
    try:
        os.remove(ASKED)
    except OSError:
        return False
    return True


def set_clock(server):
    """Return whether the clock is right: certificates are dated, and boots count by it when their file is lost."""
    if not clock_is_set():
        try:
            import ntptime

            ntptime.host, ntptime.timeout = server, 2
            ntptime.settime()
        except (OSError, ImportError, OverflowError) as error:
            sys.stdout.write("no time from %s: %s\n" % (server, error))
    return clock_is_set()
