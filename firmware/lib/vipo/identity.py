"""What a device is and says of itself; made before the rest is loaded, since it takes room on the chip for a moment."""

from vipo.configuration import read_file
from vipo.drivers import make_driver
from vipo.portable import forget

# The broker's longest packet is 16,384 bytes, with the topic.
LONGEST_FILE = 16000


def make_identity(configuration, panel):
    """Return (driver, description in bytes) of a configuration. Raises BadConfiguration, NoSuchDriver."""
    driver = make_driver(configuration.get("driver", "mixer"), panel, configuration)
    return driver, make_description(configuration, driver)


def make_description(configuration, driver):
    """Return what is published: a file as it is when the configuration names one, else what the driver declares."""
    path = configuration.get("description")
    if path:
        return read_file(path, LONGEST_FILE, "description")
    from vipo.describe import describe

    description = describe(configuration["id"], driver, configuration)
    del describe
    forget("describe")
    return description
