"""What a configuration may say: each field's kind and limits, and the sentence for one that is wrong."""

from vipo.drivers import NAMES

WORD = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.-"
FARTHEST_M = 1000000
MOST_PINS = 127
# Name, kind, and the kind's limits.
RULES = (
    ("host", "host"),
    ("port", "whole", 1, 65535),
    ("id", "word"),
    ("password", "key", 1, 128),
    ("join_key", "key", 1, 128),
    ("site", "site"),
    ("driver", "driver"),
    ("name", "text", 1, 100),
    ("about", "text", 1, 300),
    ("location", "row", 4, -FARTHEST_M, FARTHEST_M),
    ("size", "row", 3, 0.01, 100),
    ("wifi_name", "text", 1, 32),
    ("wifi_password", "key", 8, 63),
    ("object", "word"),
    ("slots", "whole", 1, 1000),
    ("keepalive_s", "number", 1, 300),
    ("speed", "number", 0.01, 1000),
    ("pins", "pins"),
    ("time_server", "host"),
    ("ca", "key", 1, 100),
    ("description", "text", 1, 300),
)
SENTENCES = {
    "host": "a name or address of at most 253 characters",
    "word": "1 to 64 letters, digits, '_', '.' or '-'",
    "site": "the site's short name",
    "driver": "one of: " + ", ".join(NAMES),
    "text": "a text of %d to %d characters",
    "key": "empty, or a text of %d to %d characters",
    "whole": "a whole number from %d to %d",
    "number": "a number from %s to %s",
    "row": "a list of %d numbers from %s to %s",
    "pins": "an object of names and numbers of pins",
}


def find_fault(configuration, where, needed):
    """Return the first thing that is wrong with a configuration, in a sentence, or an empty text."""
    for name in needed:
        if not configuration.get(name):
            return "%s does not say %r." % (where, name)
    for rule in RULES:
        value = configuration.get(rule[0])
        if value is not None and not is_right(value, rule[1], rule[2:]):
            sentence = SENTENCES[rule[1]]
            return "%s: %r must be %s." % (where, rule[0], sentence % rule[2:] if "%" in sentence else sentence)
    return fault_of_keys(configuration, where)


def fault_of_keys(configuration, where):
    """Return what is missing of keys, or an empty text; a configuration without an id is only a part of one."""
    if configuration.get("join_key") and configuration.get("site", "+") == "+":
        return "%s has an enrolment key, but does not say 'site', whose key it is." % where
    if configuration.get("id") and not configuration.get("join_key") and not configuration.get("password"):
        return "%s needs 'password', the device's own key, or 'join_key', the site's." % where
    return ""


def is_right(value, kind, limits):
    """Tell whether a value is of a kind and within its limits."""
    if kind == "whole":
        return is_number(value, *limits) and isinstance(value, int)
    if kind == "number":
        return is_number(value, *limits)
    if kind == "row":
        count, least, most = limits
        return (
            isinstance(value, (list, tuple)) and len(value) == count and all(is_number(v, least, most) for v in value)
        )
    if kind == "pins":
        # To MicroPython a bool is no int.
        return isinstance(value, dict) and all(
            isinstance(n, (int, bool)) and 0 <= n <= MOST_PINS for n in value.values()
        )
    return isinstance(value, str) and is_right_text(value, kind, limits)


def is_right_text(value, kind, limits):
    """Tell whether a text is of a kind; lengths are counted in bytes, and control characters are never right."""
    if kind == "driver":
        return value in NAMES
    if kind == "host":
        return 0 < len(value) <= 253 and all(c in WORD or c == ":" for c in value)
    if kind in ("word", "site"):
        return (0 < len(value) <= 64 and all(c in WORD for c in value)) or (kind == "site" and value == "+")
    if kind == "key" and not value:
        return True
    return limits[0] <= len(value.encode()) <= limits[1] and all(" " <= c != "\x7f" for c in value)


def is_number(value, least, most):
    """Tell whether a value is a number within limits; NaN is not."""
    return isinstance(value, (int, float)) and not isinstance(value, bool) and least <= value <= most
