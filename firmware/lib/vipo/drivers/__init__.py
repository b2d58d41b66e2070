"""The machines that this firmware can be. A driver declares its methods; the device core does the talking.

A driver has `methods` {name: {argument: limits}}, `properties` {name: value} and a coroutine for each method, called
with the Work and the checked arguments. Limits are (lowest, highest) for a number and a tuple of texts for a choice.
`idle(seconds)` is called now and then while nothing is to be done.
"""

TABLE = {"mixer": ("vipo.drivers.mixer", "Mixer")}


class NoSuchDriver(Exception):
    """The configuration names a machine that this firmware is not."""


def make_driver(name, panel):
    """Return the driver of that name; only its own module is loaded, to save memory."""
    if name not in TABLE:
        raise NoSuchDriver("There is no driver %r; choose one of: %s." % (name, ", ".join(sorted(TABLE))))
    module, cls = TABLE[name]
    return getattr(__import__(module, None, None, [cls]), cls)(panel)


def check_arguments(limits, values):
    """Return what is wrong with the arguments, in a sentence, or an empty text."""
    for name in values:
        if name not in limits:
            return "there is no argument %s" % name
    for name, allowed in limits.items():
        value = values.get(name)
        if value is None:
            return "%s is missing" % name
        if isinstance(allowed[0], str):
            if value not in allowed:
                return "%s must be one of: %s" % (name, ", ".join(allowed))
        elif isinstance(value, bool) or not isinstance(value, (int, float)):
            return "%s must be a number" % name
        elif not allowed[0] <= value <= allowed[1]:
            return "%s must be from %s to %s" % (name, allowed[0], allowed[1])
    return ""
