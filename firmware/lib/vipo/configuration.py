"""The configuration: a JSON file, checked field by field, with sentences that say what to mend."""

import json
import os

from vipo.drivers import TABLE
from vipo.portable import clock_is_set, unix_time

WORD = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.-"
FARTHEST_M = 1000000
LONGEST_FILE = 8192


class BadConfiguration(Exception):
    """The configuration cannot be used; the text says what to mend."""


def is_word(value):
    """Tell whether a value is an id: 1 to 64 letters, digits, '_', '.' or '-'."""
    return isinstance(value, str) and 0 < len(value) <= 64 and all(c in WORD for c in value)


def is_text(value, least, most):
    """Tell whether a value is a text of so many bytes without control characters."""
    return isinstance(value, str) and least <= len(value.encode()) <= most and all(" " <= c != "\x7f" for c in value)


def is_number(value, least, most):
    """Tell whether a value is a number within limits; NaN is not."""
    return isinstance(value, (int, float)) and not isinstance(value, bool) and least <= value <= most


def is_row(value, count, least, most):
    """Tell whether a value is a list of so many numbers within limits."""
    return isinstance(value, (list, tuple)) and len(value) == count and all(is_number(v, least, most) for v in value)


def is_host(value):
    """Tell whether a value can be a host's name or address."""
    return isinstance(value, str) and 0 < len(value) <= 253 and all(c in WORD or c == ":" for c in value)


def is_pins(value):
    """Tell whether a value names pins by numbers."""
    return isinstance(value, dict) and all(isinstance(n, (int, bool)) and 0 <= n <= 127 for n in value.values())


# Name, its check, and what it must be.
RULES = (
    ("host", is_host, "the broker's name or address"),
    ("port", lambda v: isinstance(v, int) and 0 < v < 65536, "a whole number from 1 to 65535"),
    ("id", is_word, "1 to 64 letters, digits, '_', '.' or '-'"),
    ("password", lambda v: is_text(v, 1, 128), "a text of at most 128 characters"),
    ("site", lambda v: v == "+" or is_word(v), "the site's short name"),
    ("driver", lambda v: v in TABLE, "one of: " + ", ".join(sorted(TABLE))),
    ("name", lambda v: is_text(v, 1, 100), "a text of at most 100 characters"),
    ("about", lambda v: is_text(v, 1, 300), "a text of at most 300 characters"),
    ("location", lambda v: is_row(v, 4, -FARTHEST_M, FARTHEST_M), "[x, y, z, theta] in metres and radians"),
    ("size", lambda v: is_row(v, 3, 0.01, 100), "[x, y, z] in metres, each from 0.01 to 100"),
    ("wifi_name", lambda v: is_text(v, 1, 32), "a text of at most 32 characters"),
    ("wifi_password", lambda v: v == "" or is_text(v, 8, 63), "empty, or a text of 8 to 63 characters"),
    ("object", is_word, "1 to 64 letters, digits, '_', '.' or '-'"),
    ("slots", lambda v: isinstance(v, int) and 0 < v <= 1000, "a whole number from 1 to 1000"),
    ("keepalive_s", lambda v: is_number(v, 1, 300), "a number from 1 to 300"),
    ("speed", lambda v: is_number(v, 0.01, 1000), "a number from 0.01 to 1000"),
    ("pins", is_pins, "an object of names and numbers of pins"),
    ("time_server", is_host, "a host's name or address"),
)
NEEDED = ("host", "port", "id", "password")


def find_fault(configuration, where, needed=NEEDED):
    """Return the first thing that is wrong with a configuration, in a sentence, or an empty text."""
    for name in needed:
        if not configuration.get(name):
            return "%s does not say %r." % (where, name)
    for name, is_right, rule in RULES:
        value = configuration.get(name)
        if value is not None and not is_right(value):
            return "%s: %r must be %s." % (where, name, rule)
    return ""


def read_configuration(path, needed=NEEDED):
    """Read the JSON file and see that it can be used. Raises BadConfiguration."""
    try:
        with open(path) as file:
            configuration = json.loads(file.read(LONGEST_FILE))
    except OSError:
        raise BadConfiguration("There is no configuration file %s." % path)
    except ValueError:
        raise BadConfiguration("%s is not JSON." % path)
    if not isinstance(configuration, dict):
        raise BadConfiguration("%s must hold a JSON object." % path)
    fault = find_fault(configuration, path, needed)
    if fault:
        raise BadConfiguration(fault)
    return configuration


def write_file(path, content):
    """Write a text so that a power cut leaves the old one or the new one."""
    with open(path + ".new", "w") as file:
        file.write(content)
    os.rename(path + ".new", path)


def next_boot(path):
    """Return this start's number, one higher than the last, and keep it in a file."""
    try:
        with open(path) as file:
            boot = int(file.read()) + 1
    except (OSError, ValueError):
        # A lost file must not take the numbers back: the server ignores older boots.
        boot = unix_time() if clock_is_set() else 1
    write_file(path, str(boot))
    return boot
