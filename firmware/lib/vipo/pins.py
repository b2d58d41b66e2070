"""The pins of a board: those that the configuration names, or the usual ones of an ESP32."""

import machine

# Of the board in docs/devices/esp32.md; 0 is the BOOT button that most boards have.
DEFAULT_PINS = {"sda": 21, "scl": 22, "red": 25, "green": 26, "blue": 27, "output": 23, "button": 0}
LIGHTS, LEVELS = ("red", "green", "blue", "led"), ("lcd", "inverted", "output_inverted")


def find_pins(named):
    """Return (the pins to use, why a named one cannot be used or an empty text).

    A chip that lacks a usual pin is another one of the family: there the others may be the flash's, so none is used.
    """
    if not named:
        return ({} if any(why_not(name, DEFAULT_PINS) for name in DEFAULT_PINS) else DEFAULT_PINS), ""
    good, fault = {}, ""
    for name in named:
        why = why_not(name, named, True)
        if why:
            fault = "config.json: pin %d cannot be %r: %s." % (named[name], name, why)
        else:
            good[name] = named[name]
    return good, fault


def why_not(name, pins, switch=False):
    """Return why a pin cannot be used, or an empty text; with `switch` also whether it can be switched."""
    try:
        if name == "output" and switch:
            make_output(pins)
        elif name in LIGHTS and switch:
            machine.Pin(pins[name], machine.Pin.OUT)
        elif name not in LEVELS:
            machine.Pin(pins[name])
    except ValueError as error:
        return str(error)
    return ""


def make_output(pins):
    """Return what switches the machine's output, off to begin with; None without a pin. Raises ValueError."""
    if "output" not in pins:
        return None
    inverted = bool(pins.get("output_inverted"))
    # The level comes with the pin, so that nothing starts for a moment.
    pin = machine.Pin(pins["output"], machine.Pin.OUT, value=int(inverted))
    return lambda on: pin.value(on ^ inverted)
