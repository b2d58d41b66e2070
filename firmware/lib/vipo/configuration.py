"""The configuration, a JSON file, and the other files of a device."""

import json
import os

from vipo.portable import clock_is_set, forget, unix_time, write_file

NEEDED = ("host", "port", "id")
LONGEST_FILE = 8192


class BadConfiguration(Exception):
    """The configuration cannot be used; the text says what to mend."""


def read_configuration(path, needed=NEEDED):
    """Read the JSON file and see that it can be used. Raises BadConfiguration."""
    from vipo.checks import find_fault

    content = read_file(path, LONGEST_FILE, "configuration")
    try:
        configuration = json.loads(content.decode())
    except ValueError:
        raise BadConfiguration("%s is not JSON." % path)
    if not isinstance(configuration, dict):
        raise BadConfiguration("%s must hold a JSON object." % path)
    fault = find_fault(configuration, path, needed)
    forget("checks")
    if fault:
        raise BadConfiguration(fault)
    return configuration


def read_file(path, most, what):
    """Return a file's bytes, `most` at most. Raises BadConfiguration."""
    try:
        size = os.stat(path)[6]
        if size > most:
            raise BadConfiguration("The %s file %s is longer than %d bytes." % (what, path, most))
        with open(path, "rb") as file:
            return file.read(size)
    except OSError:
        raise BadConfiguration("There is no %s file %s." % (what, path))


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
