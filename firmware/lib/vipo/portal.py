"""The set-up page: a small HTTP server that asks for what the configuration needs, and writes it.

It is reached through the board's own access point, whose password is on the display. One request for each
connection, a few connections at once, everything bounded; whatever is asked for elsewhere leads here.
"""

import asyncio
import io
import json
import os
from binascii import hexlify

from vipo.certificate import read_certificate, trusting
from vipo.checks import find_fault
from vipo.configuration import BadConfiguration, read_configuration
from vipo.form import FIELDS, page, read_form
from vipo.portable import close_stream, show_error, write_file

REQUEST_TIMEOUT_S = 10
MOST_CONNECTIONS = 4
LONGEST_LINE = 1024
LINGER_S, LINE_BYTES = 1, 256
MOST_LINES = 40
LONGEST_BODY = 8192
NEEDED = ("wifi_name", "host", "port", "id", "driver")
AUTHORITY = "ca.crt"
REASONS = {200: "OK", 302: "Found", 400: "Bad Request", 404: "Not Found", 405: "Method Not Allowed"}
REASONS[413] = "Payload Too Large"
REASONS[503] = "Service Unavailable"


class BadRequest(Exception):
    """A request that is not served; `code` is HTTP's."""

    def __init__(self, code):
        super().__init__(REASONS[code])
        self.code = code


class Portal:
    """The page's server. `run()` returns when a configuration was written to `folder` and the page has said so."""

    def __init__(self, address, port=80, folder=".", host="0.0.0.0"):
        self.address, self.port, self.folder, self.host = address, port, folder, host
        self.token = hexlify(os.urandom(8)).decode()
        self._saved = asyncio.Event()
        self._open = 0

    async def run(self):
        """Serve until a configuration was saved."""
        server = await asyncio.start_server(self._serve, self.host, self.port)
        try:
            await self._saved.wait()
        finally:
            server.close()
            await server.wait_closed()

    async def _serve(self, reader, writer):
        saved = False
        self._open += 1
        try:
            answer, saved, all_read = await self._ask_for(reader)
            writer.write(answer)
            await asyncio.wait_for(writer.drain(), REQUEST_TIMEOUT_S)
            if not all_read:
                await asyncio.wait_for(read_the_rest(reader), LINGER_S)
        except (OSError, EOFError, asyncio.TimeoutError):
            pass  # whoever asked is gone or too slow
        except Exception as error:  # the edge of a request: the next one must be served
            show_error(error)
        self._open -= 1
        await close_stream(writer)
        if saved:
            self._saved.set()

    async def _ask_for(self, reader):
        """Return (the response to a request, whether a configuration was saved, whether the request was read)."""
        request = None
        try:
            if self._open > MOST_CONNECTIONS:
                raise BadRequest(503)
            request = await asyncio.wait_for(self._read(reader), REQUEST_TIMEOUT_S)
            answer, saved = self._answer(*request)
        except (BadRequest, MemoryError) as error:
            code = getattr(error, "code", 503)
            answer, saved = response(code, REASONS[code]), False
        return answer, saved, request is not None

    async def _read(self, reader):
        """Return (method, path, host, body)."""
        words = (await read_line(reader)).split(" ")
        if len(words) != 3:
            raise BadRequest(400)
        host, length = "", 0
        for _ in range(MOST_LINES):
            line = await read_line(reader)
            if not line:
                break
            name, _, value = line.partition(":")
            if name.lower() == "host":
                host = value.strip()
            elif name.lower() == "content-length":
                length = read_length(value.strip())
        else:
            raise BadRequest(400)
        return words[0], words[1], host, await reader.readexactly(length)

    def _answer(self, method, path, host, body):
        """Return (the response, whether a configuration was saved)."""
        if host.split(":")[0] != self.address:
            return self._lead_here(), False
        if method == "GET":
            if path == "/":
                return response(200, page(self._known(), self.token)), False
            return self._lead_here(), False
        if method != "POST":
            raise BadRequest(405)
        if path != "/":
            raise BadRequest(404)
        return self._take(body)

    def _lead_here(self):
        port = "" if self.port == 80 else ":%d" % self.port
        return response(302, "", "Location: http://%s%s/\r\n" % (self.address, port))

    def _take(self, body):
        """Check the form and keep it."""
        values = read_form(body)
        if values is None or values.pop("token", "") != self.token:
            raise BadRequest(400)
        authority = values.pop("ca", "").strip()
        known = self._known()
        configuration, fault = merge(known, values)
        fault = fault or find_fault(configuration, "The form", NEEDED) or fault_of_authority(authority)
        if fault:
            return response(200, page(configuration, self.token, in_words(fault))), False
        if authority:
            write_file(self._path(AUTHORITY), authority + "\n")
            configuration["ca"] = AUTHORITY
        write_file(self._path("config.json"), json.dumps(configuration))
        return response(200, page(configuration, "", "", saved=True)), True

    def _known(self):
        """Return the configuration that is there already, or an empty one."""
        try:
            return read_configuration(self._path("config.json"), ())
        except BadConfiguration:
            return {}

    def _path(self, name):
        return self.folder + "/" + name


async def until_saved(portal, names):
    """Serve the page and the names until a configuration was saved."""
    naming = asyncio.create_task(names)
    try:
        await portal.run()
    finally:
        naming.cancel()


async def read_the_rest(reader):
    """Read and drop what still comes: a connection closed over unread bytes takes the answer with it."""
    while await reader.read(LINE_BYTES):
        pass


async def read_line(reader):
    """Return a line of a request without its end. Raises BadRequest for one that is too long or not plain text."""
    line = b""
    while not line.endswith(b"\n"):
        if len(line) >= LONGEST_LINE:
            raise BadRequest(400)
        line += await reader.readexactly(1)
    try:
        return line.decode().rstrip("\r\n")
    except ValueError:
        raise BadRequest(400)


def read_length(value):
    """Return a Content-Length. Raises BadRequest."""
    if not value.isdigit() or len(value) > 8:
        raise BadRequest(400)
    if int(value) > LONGEST_BODY:
        raise BadRequest(413)
    return int(value)


def response(code, body, more=""):
    """Return a whole HTTP response in bytes."""
    content = body.encode()
    head = (
        "HTTP/1.0 %d %s\r\nContent-Type: text/html; charset=utf-8\r\nContent-Length: %d\r\n%s"
        "Cache-Control: no-store\r\nX-Frame-Options: DENY\r\nReferrer-Policy: no-referrer\r\n"
        "Content-Security-Policy: default-src 'none'; style-src 'unsafe-inline'; form-action 'self'\r\n"
        "Connection: close\r\n\r\n"
    )
    return (head % (code, REASONS[code], len(content), more)).encode() + content


def merge(known, values):
    """Return (what was known with what the form says, the first fault or an empty text).

    An empty secret keeps the one that is known; any other empty field takes its entry away.
    """
    configuration = dict(known)
    for name, kind, _, _ in FIELDS:
        value = values.get(name, "").strip() if kind != "secret" else values.get(name, "")
        if kind in ("number", "place"):
            if not value:
                configuration.pop(name, None)
                continue
            try:
                configuration[name] = int(value) if kind == "number" else [float(part) for part in value.split()]
            except ValueError:
                return configuration, "The form: %r must be in numbers." % name
        elif value:
            configuration[name] = value
        elif kind != "secret":
            configuration.pop(name, None)
    return configuration, ""


def in_words(fault):
    """Return a fault with the page's own words for its fields."""
    for name, _, label, _ in FIELDS:
        fault = fault.replace("'%s'" % name, '"%s"' % label)
    return fault


def fault_of_authority(text):
    """Return what is wrong with a pasted certificate, or an empty text."""
    if not text:
        return ""
    try:
        trusting(read_certificate(io.StringIO(text)))
    except ValueError:
        return "The form: the certificate is not in PEM form."
    return ""
