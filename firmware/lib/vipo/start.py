"""From a configuration to a running device; shared by the chip and by a computer."""

import json
import time
from binascii import a2b_base64

from vipo.device import Device
from vipo.drivers import make_driver
from vipo.mqtt import Client

CLOCK_IS_SET = 700000000


class BadConfiguration(Exception):
    """The configuration cannot be used; the text says what to mend."""


def read_configuration(path):
    """Read the JSON file and see that it has what a device cannot do without."""
    try:
        with open(path) as file:
            configuration = json.load(file)
    except OSError:
        raise BadConfiguration("There is no configuration file %s." % path)
    except ValueError:
        raise BadConfiguration("%s is not JSON." % path)
    for name in ("host", "port", "id", "password", "description"):
        if not configuration.get(name):
            raise BadConfiguration("%s does not say %r." % (path, name))
    return configuration


def next_boot(path):
    """Return this start's number, one higher than the last, and keep it in a file."""
    try:
        with open(path) as file:
            boot = int(file.read()) + 1
    except (OSError, ValueError):
        # A lost file must not take the numbers back: the server ignores older boots.
        now = int(time.time())
        boot = now if now > CLOCK_IS_SET else 1
    with open(path, "w") as file:
        file.write(str(boot))
    return boot


def read_description(path):
    """Return the bytes that are published as they are."""
    try:
        with open(path, "rb") as file:
            return file.read()
    except OSError:
        raise BadConfiguration("There is no description file %s." % path)


def tls_context(authority_path):
    """Return a context that checks the broker's certificate against the authority's file (PEM)."""
    try:
        import tls as ssl
    except ImportError:
        import ssl
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.verify_mode = ssl.CERT_REQUIRED
    certificate = read_certificate(authority_path)
    try:
        context.load_verify_locations(cadata=certificate)
    except TypeError:  # MicroPython's takes it by position only
        context.load_verify_locations(certificate)
    return context


def read_certificate(path):
    """Return the first certificate of a PEM file as DER, which every port of MicroPython takes."""
    try:
        with open(path) as file:
            text = file.read()
    except OSError:
        raise BadConfiguration("There is no certificate file %s." % path)
    begin, end = "-----BEGIN CERTIFICATE-----", "-----END CERTIFICATE-----"
    if begin not in text or end not in text:
        raise BadConfiguration("%s holds no certificate in PEM form." % path)
    return a2b_base64(text.split(begin, 1)[1].split(end, 1)[0])


def make_device(configuration, panel):
    """Return a Device made as the configuration says."""
    client = Client(
        configuration["host"],
        int(configuration["port"]),
        configuration["id"],
        configuration["id"],
        configuration["password"],
        keepalive_s=int(configuration.get("keepalive_s", 15)),
        tls=tls_context(configuration["ca"]) if configuration.get("ca") else None,
    )
    return Device(
        client,
        make_driver(configuration.get("driver", "mixer"), panel),
        panel,
        read_description(configuration["description"]),
        next_boot(configuration.get("boot_file", "boot.txt")),
        site=configuration.get("site", "+"),
        speed=float(configuration.get("speed", 1)),
        location=configuration.get("location"),
    )
