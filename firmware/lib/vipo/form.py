"""The set-up page's form: its fields, its HTML with every value escaped, and what comes back from it."""

from vipo.drivers import NAMES

LONGEST_VALUE = 6144
PERCENT, PLUS, SPACE = 0x25, 0x2B, 0x20
MOST_VALUES = 24
# Name, kind, what the page calls it, the longest value.
FIELDS = (
    ("wifi_name", "text", "Wi-Fi name", 32),
    ("wifi_password", "secret", "Wi-Fi password", 63),
    ("host", "text", "Broker: name or address", 253),
    ("port", "number", "Broker: port (8883 with TLS)", 5),
    ("id", "text", "This device's id", 64),
    ("site", "text", "Site (its short name)", 64),
    ("join_key", "secret", "The site's enrolment key, for a new device", 128),
    ("password", "secret", "This device's own key, if it has one", 128),
    ("time_server", "text", "Time server, if not pool.ntp.org", 253),
    ("driver", "driver", "This device is a", 16),
    ("name", "text", "Name on the map", 100),
    ("location", "place", "Place: x y z theta (metres, radians)", 80),
)
STYLE = (
    "body{font:16px/1.5 system-ui,sans-serif;max-width:30rem;margin:1rem auto;padding:0 1rem;color-scheme:light dark}"
    "label{display:block;margin:.75rem 0 0}input,select,textarea,button{font:inherit;width:100%;box-sizing:border-box;"
    "padding:.5rem}button{margin:1rem 0}.fault{border:2px solid #c33;padding:.5rem}"
)


def page(known, token, fault="", saved=False):
    """Return the page: the form with what is known, or the word that all is saved."""
    if saved:
        inner = "<p>Saved. The board starts again and joins the Wi-Fi; its display says the rest.</p>"
    else:
        inner = ('<p class="fault" role="alert">%s</p>' % escape(fault) if fault else "") + form(known, token)
    return (
        '<!doctype html><html lang="en"><meta charset="utf-8"><meta name="viewport" content="width=device-width">'
        "<title>VIPO device</title><style>%s</style><h1>VIPO device</h1>%s</html>" % (STYLE, inner)
    )


def form(known, token):
    """Return the form; secrets are never shown."""
    rows = [row(name, kind, label, most, known.get(name)) for name, kind, label, most in FIELDS]
    secure = "a certificate is kept already" if known.get("ca") else "without it the connection is not encrypted"
    return (
        '<form method="post" action="/"><input type="hidden" name="token" value="%s">%s'
        '<label>Certificate of the broker\'s authority, PEM (%s)<textarea name="ca" rows="4" maxlength="4096">'
        "</textarea></label><button>Save</button></form>" % (escape(token), "".join(rows), secure)
    )


def row(name, kind, label, most, value):
    """Return one field with its label."""
    if kind == "driver":
        options = "".join(
            "<option%s>%s</option>" % (" selected" if option == value else "", option) for option in NAMES
        )
        return '<label>%s<select name="%s">%s</select></label>' % (label, name, options)
    if isinstance(value, (list, tuple)):
        value = " ".join([str(part) for part in value])
    shown = "" if value is None or kind == "secret" else escape(str(value))
    kept = ' placeholder="keep the one that is there"' if value and kind == "secret" else ""
    return '<label>%s<input name="%s" type="%s" maxlength="%d" value="%s"%s autocapitalize="off"></label>' % (
        label,
        name,
        "password" if kind == "secret" else "text",
        most,
        shown,
        kept,
    )


def escape(text):
    """Return a text as it may stand in HTML, in an attribute too."""
    for character, entity in (("&", "&amp;"), ("<", "&lt;"), (">", "&gt;"), ('"', "&quot;"), ("'", "&#39;")):
        text = text.replace(character, entity)
    return text


def read_form(body):
    """Return {name: value} of a form sent as application/x-www-form-urlencoded, or None when it cannot be read.

    A certificate fills much of a small heap: it is copied as seldom as can be.
    """
    values, start = {}, 0
    while start <= len(body):
        end = find(body, b"&", start, len(body))
        middle = find(body, b"=", start, end)
        if len(values) == MOST_VALUES or end - middle > LONGEST_VALUE:
            return None
        try:
            values[unquote(body, start, middle)] = unquote(body, middle + 1, end)
        except ValueError:
            return None
        start = end + 1
    return values


def find(body, mark, start, end):
    """Return where a mark stands between two places, or the end."""
    at = body.find(mark, start, end)
    return end if at < 0 else at


def unquote(body, start, end):
    """Return the text between two places with its %XX and + undone. Raises ValueError."""
    out, length = bytearray(max(0, end - start)), 0
    while start < end:
        byte = body[start]
        if byte == PERCENT:
            if start + 3 > end:
                raise ValueError("a broken %")
            byte = int(body[start + 1 : start + 3], 16)
            start += 2
        out[length] = SPACE if byte == PLUS and body[start] == PLUS else byte
        length += 1
        start += 1
    return str(memoryview(out)[:length], "utf-8")
