"""The machines that this firmware can be. A driver declares its methods; the device core does the talking.

A driver is a `vipo.drivers.machine.Machine` with `device_class`, `about` and `size` (metres), `gives` and `takes`,
`readings` (declared values), `methods` {name: declared method} with their `order`, which a dict of MicroPython does not
keep, `properties` {name: value now}, and a coroutine for each method, called with the Work and the checked arguments.
"""

TABLE = {
    "mixer": ("mixer", "Mixer"),
    "oven": ("oven", "Oven"),
    "painter": ("painter", "Painter"),
    "dispenser": ("dispenser", "Dispenser"),
    "inventory": ("inventory", "Inventory"),
    "drop-off": ("drop_off", "DropOff"),
    "relay": ("relay", "Relay"),
}


class NoSuchDriver(Exception):
    """The configuration names a machine that this firmware is not."""


def make_driver(name, panel, options):
    """Return the driver of that name; only its own module is loaded, to save memory.

    `options` is the configuration; a driver takes what it knows from it: `object`, `slots`, `count_file`.
    """
    if name not in TABLE:
        raise NoSuchDriver("There is no driver %r; choose one of: %s." % (name, ", ".join(sorted(TABLE))))
    module, cls = TABLE[name]
    return getattr(__import__("vipo.drivers." + module, None, None, [cls]), cls)(panel, options)
