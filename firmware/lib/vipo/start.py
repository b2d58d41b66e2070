"""From a configuration to a running device; shared by the chip and by a computer."""

from binascii import a2b_base64

from vipo.configuration import BadConfiguration, next_boot
from vipo.describe import describe
from vipo.device import Device
from vipo.drivers import make_driver
from vipo.mqtt import Client

BEGIN, END = "-----BEGIN CERTIFICATE-----", "-----END CERTIFICATE-----"
LONGEST_FILE = 16384


def make_device(configuration, panel, output=None, feed=None):
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
        feed=feed,
        output=output,
    )


def make_description(configuration, driver):
    """Return what is published: a file as it is when the configuration names one, else what the driver declares."""
    path = configuration.get("description")
    if not path:
        return describe(configuration["id"], driver, configuration)
    try:
        with open(path, "rb") as file:
            return file.read(LONGEST_FILE)
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
    try:
        with open(authority_path) as file:
            certificate = read_certificate(file.read(LONGEST_FILE))
    except OSError:
        raise BadConfiguration("There is no certificate file %s." % authority_path)
    except ValueError:
        raise BadConfiguration("%s holds no certificate in PEM form." % authority_path)
    try:
        context.load_verify_locations(cadata=certificate)
    except TypeError:  # MicroPython's takes it by position only
        context.load_verify_locations(certificate)
    return context


def read_certificate(text):
    """Return the first certificate of a PEM text as DER, which every port of MicroPython takes. Raises ValueError."""
    if BEGIN not in text or END not in text:
        raise ValueError("no certificate")
    return a2b_base64(text.split(BEGIN, 1)[1].split(END, 1)[0])
