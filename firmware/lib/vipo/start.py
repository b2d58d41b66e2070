"""From a configuration to a running device; shared by the chip and by a computer."""

from vipo.certificate import tls_context
from vipo.configuration import next_boot
from vipo.device import Device
from vipo.duties import Duties
from vipo.entrance import Entrance
from vipo.ledger import Ledger
from vipo.mqtt import Client
from vipo.recall import read_ledger


def make_device(configuration, panel, identity, output=None):
    """Return a Device made as the configuration says, with its (driver, description). Raises BadConfiguration."""
    driver, description = identity
    client = Client(
        configuration["host"],
        configuration["port"],
        configuration["id"],
        "",
        keepalive_s=int(configuration.get("keepalive_s", 15)),
        tls=tls_context(configuration["ca"]) if configuration.get("ca") else None,
    )
    speed = float(configuration.get("speed", 1))
    path = configuration.get("ledger_file", "ledger.txt")
    ledger = Ledger(path, read_ledger(path))
    duties = Duties(driver, panel, speed, output, make_entrance(configuration, client), ledger)
    boot = next_boot(configuration.get("boot_file", "boot.txt"))
    return Device(client, duties, description, boot, configuration.get("site", "+"))


def make_entrance(configuration, client):
    """Return the client's keys: the kept ones, the configuration's, and the site's enrolment key for one that nobody knows."""
    join_key = configuration.get("join_key")
    enrolment = (configuration["site"], join_key) if join_key else None
    return Entrance(client, configuration.get("key_file", "key.txt"), configuration.get("password"), enrolment)
