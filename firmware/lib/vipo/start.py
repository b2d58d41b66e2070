"""From a configuration to a running device; shared by the chip and by a computer."""

from vipo.certificate import tls_context
from vipo.configuration import BadConfiguration, next_boot, read_file
from vipo.device import Device
from vipo.drivers import make_driver
from vipo.mqtt import Client
from vipo.portable import forget

LONGEST_FILE = 16384


def make_device(configuration, panel, output=None):
    """Return a Device made as the configuration says. Raises BadConfiguration, NoSuchDriver."""
    client = Client(
        configuration["host"],
        configuration["port"],
        configuration["id"],
        configuration["id"],
        configuration["password"],
        keepalive_s=int(configuration.get("keepalive_s", 15)),
        tls=tls_context(configuration["ca"]) if configuration.get("ca") else None,
    )
    driver = make_driver(configuration.get("driver", "mixer"), panel, configuration)
    return Device(
        client,
        driver,
        panel,
        make_description(configuration, driver),
        next_boot(configuration.get("boot_file", "boot.txt")),
        site=configuration.get("site", "+"),
        speed=float(configuration.get("speed", 1)),
        output=output,
    )


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
