"""From a configuration to a running device; shared by the chip and by a computer."""

from binascii import a2b_base64

from vipo.configuration import BadConfiguration, next_boot, read_file
from vipo.device import Device
from vipo.drivers import make_driver
from vipo.mqtt import Client
from vipo.portable import forget

BEGIN, END = "-----BEGIN CERTIFICATE-----", "-----END CERTIFICATE-----"
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


def tls_context(authority_path):
    """Return a context that checks the broker's certificate against the authority's file (PEM)."""
    try:
        import tls as ssl
    except ImportError:
        import ssl
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.verify_mode = ssl.CERT_REQUIRED
    try:
        with open(authority_path) as file:
            certificate = read_certificate(file)
    except OSError:
        raise BadConfiguration("There is no certificate file %s." % authority_path)
    except ValueError:
        raise BadConfiguration("%s holds no certificate in PEM form." % authority_path)
    try:
        context.load_verify_locations(cadata=certificate)
    except TypeError:  # MicroPython's takes it by position only
        context.load_verify_locations(certificate)
    return context


def read_certificate(lines):
    """Return the first certificate of a PEM text's lines as DER, which every port of MicroPython takes.

    Raises ValueError.
    """
    certificate, inside = bytearray(), False
    for line in lines:
        line = line.strip()
        if line == END and certificate:
            return bytes(certificate)
        if inside:
            certificate.extend(a2b_base64(line))
        inside = inside or line == BEGIN
    raise ValueError("no certificate")
