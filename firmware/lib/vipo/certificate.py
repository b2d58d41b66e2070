"""The certificate of the authority that vouches for the broker, and the TLS context made with it."""

from binascii import a2b_base64

from vipo.configuration import BadConfiguration

BEGIN, END = "-----BEGIN CERTIFICATE-----", "-----END CERTIFICATE-----"


def tls_context(authority_path):
    """Return a context that checks the broker's certificate against the authority's file (PEM)."""
    try:
        with open(authority_path) as file:
            return trusting(read_certificate(file))
    except OSError:
        raise BadConfiguration("There is no certificate file %s." % authority_path)
    except ValueError:
        raise BadConfiguration("%s holds no certificate in PEM form." % authority_path)


def trusting(certificate):
    """Return a context that trusts an authority's certificate (DER). Raises ValueError."""
    try:
        import tls as ssl
    except ImportError:
        import ssl
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.verify_mode = ssl.CERT_REQUIRED
    try:
        context.load_verify_locations(cadata=certificate)
    except TypeError:  # MicroPython's takes it by position only
        context.load_verify_locations(certificate)
    except OSError:  # CPython's word for what is no certificate
        raise ValueError("no certificate")
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
