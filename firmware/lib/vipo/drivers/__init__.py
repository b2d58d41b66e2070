"""The machines that this firmware can be. A driver declares its methods; the device core does the talking.

Each module has a class Driver, a `vipo.drivers.machine.Machine` with `device_class`, `about` and `size` (metres),
`gives` and `takes`, `readings` (declared values), `methods` {name: declared method} with their `order`, which a dict of
MicroPython does not keep, `properties` {name: value now}, and a coroutine for each method, called with the Work and the
checked arguments.
"""

NAMES = ("dispenser", "drop-off", "inventory", "mixer", "oven", "painter", "relay")


class NoSuchDriver(Exception):
    """The configuration names a machine that this firmware is not."""


def make_driver(name, panel, options):
    """Return the driver of that name; only its own module is loaded, to save memory.

    `options` is the configuration; a driver takes what it knows from it: `object`, `slots`, `count_file`.
    """
    if name not in NAMES:
        raise NoSuchDriver("There is no driver %r; choose one of: %s." % (name, ", ".join(NAMES)))
    path = "vipo.drivers." + name.replace("-", "_")
    return __import__(path, None, None, ["Driver"]).Driver(panel, options)
