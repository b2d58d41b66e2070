"""The set-up page on the real MicroPython: from a board without a configuration to a device on the bus."""

from __future__ import annotations

import json
import re
import socket
import struct
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass
from html import unescape
from html.parser import HTMLParser
from pathlib import Path
from typing import Any
from urllib.parse import urlencode

import pytest

from tests.firmware.hd44780 import texts
from tests.firmware.rig import ACCOUNTS, DEVICE, LIMIT_S, Chip, Running, listening, running_bus, running_chip
from tests.kit.files import ROOT
from tests.kit.servers import free_port
from tests.kit.waiting import wait_for

EVIL = "\"><script>alert('1')</script>&"
SECRET = "a secret that stays"
LONGEST_CERTIFICATE = 4000


class Form(HTMLParser):
    """The page's fields with their values, and whether anything on it could run."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.values: dict[str, str] = {}
        self.tags: set[str] = set()
        self.feed(page)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        known = dict(attributes)
        self.tags.add(tag)
        assert not any(name.startswith("on") for name in known)
        if tag in ("input", "select", "textarea"):
            self.values[known["name"] or ""] = known.get("value") or ""


@dataclass
class Page:
    """A board in set-up mode."""

    chip: Chip
    port: int
    names_port: int

    def ask(self, request: bytes) -> tuple[int, dict[str, str], str]:
        with socket.create_connection(("127.0.0.1", self.port), timeout=LIMIT_S) as connection:
            connection.sendall(request)
            with connection.makefile("rb") as answer:
                status = int(answer.readline().split(b" ")[1])
                lines = iter(lambda: answer.readline().decode().strip(), "")
                headers = dict(line.split(": ", 1) for line in lines)
                return status, headers, answer.read(int(headers["Content-Length"])).decode()

    def get(self, path: str = "/", host: str = "") -> tuple[int, dict[str, str], str]:
        return self.ask(f"GET {path} HTTP/1.1\r\nHost: {host or self.host}\r\n\r\n".encode())

    def post(self, values: dict[str, str], host: str = "") -> tuple[int, dict[str, str], str]:
        body = urlencode(values)
        head = f"POST / HTTP/1.1\r\nHost: {host or self.host}\r\nContent-Length: {len(body)}\r\n\r\n"
        return self.ask((head + body).encode())

    @property
    def host(self) -> str:
        return f"127.0.0.1:{self.port}"

    @property
    def form(self) -> Form:
        return Form(self.get()[2])


@pytest.fixture
def page(micropython: str, tmp_path: Path) -> Iterator[Page]:
    known = {"wifi_name": "hall", "password": SECRET, "name": EVIL, "pins": {"sda": 21, "scl": 22, "button": 0}}
    (tmp_path / "config.json").write_text(json.dumps({**known, "host": "old", "port": 1883, "id": "old"}))
    with set_up(micropython, tmp_path, {"VIPO_PRESSED": str(tmp_path)}) as found:
        yield found


def set_up(micropython: str, folder: Path, environment: dict[str, str]) -> Any:
    from contextlib import contextmanager

    @contextmanager
    def running() -> Iterator[Page]:
        port, names = free_port(), free_port()
        program = folder / "main.py"
        ports = f"import vipo.setting_up as s\ns.HTTP_PORT, s.DNS_PORT = {port}, {names}\n"
        program.write_text(f"import vipo.chip\n{ports}vipo.chip.run()\n")
        with running_chip(micropython, folder, environment, main=program) as chip:
            page = Page(chip, port, names)
            wait_for("the page", lambda: _answers(port), story=lambda: chip.console)
            yield page

    return running()


def _answers(port: int) -> bool:
    try:
        socket.create_connection(("127.0.0.1", port), timeout=1).close()
    except OSError:
        return False
    return True


def test_from_the_box_to_the_bus(micropython: str, tmp_path: Path) -> None:
    with running_bus("mosquitto with TLS", tmp_path) as bus, listening(bus) as ear:
        with set_up(micropython, tmp_path, {}) as page:
            (point,) = [entry[2] for entry in page.chip.record if entry[1] == "point"]
            assert texts(page.chip.record)[-1] == ("VIPO-12abcd     ", f"key {point['password']}    ")
            assert (point["ssid"], point["authmode"], len(point["password"])) == ("VIPO-12abcd", 3, 8)
            assert ["addresses", ["127.0.0.1", "255.255.255.0", "127.0.0.1", "127.0.0.1"]] in [
                entry[1:] for entry in page.chip.record
            ]
            form = page.form
            status, _, body = page.post(
                {
                    **form.values,
                    "wifi_name": "hall",
                    "wifi_password": "warm paint",
                    "host": "localhost",
                    "port": str(bus.device_port),
                    "id": DEVICE,
                    "password": ACCOUNTS[DEVICE],
                    "site": "hall",
                    "driver": "oven",
                    "name": "Curing Öfchen",
                    "location": "3.5 -2 0 1.57",
                    "ca": Path(bus.authority).read_text(),
                }
            )
            assert (status, "Saved." in body) == (200, True)
            assert page.chip.process.wait(LIMIT_S) == 7
            assert page.chip.record[-1][1] == "reset"
        with running_chip(micropython, tmp_path, {}) as chip:
            oven = Running(ear, bus, chip.process, tmp_path / "console")
            told = ear.wait(lambda h: h.topic == oven.up + "desc", LIMIT_S).payload.decode()
            assert 'dct:title "Curing Öfchen"' in told
            assert "vipo:location ( 3.5 -2.0 0.0 1.57 )" in told
            assert "vipo/v1/dev/paintMixer02/down/curePaint" in told
            oven.state(lambda s: s["props"]["jobStatus"] == 0)


def test_secrets_are_never_shown_and_texts_are_escaped(page: Page) -> None:
    status, headers, body = page.get()
    assert status == 200
    assert SECRET not in body
    assert "script" not in Form(body).tags
    assert Form(body).values["name"] == EVIL
    assert Form(body).values["password"] == ""
    assert headers["Content-Security-Policy"].startswith("default-src 'none'")
    status, _, body = page.post({**Form(body).values, "host": EVIL, "password": ""})
    assert (status, Form(body).values["host"]) == (200, EVIL)
    assert 'role="alert"' in body
    assert "script" not in Form(body).tags


def test_an_empty_secret_keeps_the_one_that_is_there(page: Page) -> None:
    page.post({**page.form.values, "driver": "mixer", "host": "new", "name": "Mixer", "wifi_password": ""})
    page.chip.process.wait(LIMIT_S)
    kept = json.loads((page.chip.folder / "config.json").read_text())
    assert (kept["password"], kept["host"], kept["name"], kept["driver"]) == (SECRET, "new", "Mixer", "mixer")
    assert kept["pins"] == {"sda": 21, "scl": 22, "button": 0}
    assert "token" not in kept


def test_a_certificate_as_long_as_the_field_allows_is_kept(page: Page, tmp_path: Path) -> None:
    script = ROOT / "deploy" / "mosquitto" / "make-certificates.sh"
    subprocess.run([script, tmp_path / "authority", "localhost"], check=True, capture_output=True)
    authority = (tmp_path / "authority" / "ca.crt").read_text()
    chain = (authority * (LONGEST_CERTIFICATE // len(authority))).replace("\n", "\r\n")
    assert len(chain) > 3500
    status, _, body = page.post({**page.form.values, "driver": "mixer", "name": "Mixer", "ca": chain})
    assert (status, "Saved." in body) == (200, True)
    page.chip.process.wait(LIMIT_S)
    assert (tmp_path / "ca.crt").read_bytes().decode().split() == chain.split()


WRONG = [
    ({"id": "a/b"}, """The form: "This device's id" must be 1 to 64 letters, digits, '_', '.' or '-'."""),
    ({"id": ""}, """The form does not say "This device's id"."""),
    ({"port": "many"}, 'The form: "Broker: port (8883 with TLS)" must be in numbers.'),
    ({"port": "70000"}, 'The form: "Broker: port (8883 with TLS)" must be a whole number from 1 to 65535.'),
    ({"wifi_password": "short"}, 'The form: "Wi-Fi password" must be empty, or a text of 8 to 63 characters.'),
    ({"driver": "bomb"}, 'The form: "This device is a" must be one of: dispenser, drop-off, inventory, mixer,'),
    ({"location": "1 2 3"}, 'The form: "Place: x y z theta (metres, radians)" must be a list of 4 numbers'),
    ({"location": "1 2 nan 3"}, 'The form: "Place: x y z theta (metres, radians)" must be a list of 4 numbers'),
    ({"host": "x" * 254}, 'The form: "Broker: name or address" must be a name or address of at most 253 characters.'),
    ({"name": "a\x00b"}, 'The form: "Name on the map" must be a text of 1 to 100 characters.'),
    (
        {"join_key": "j" * 129},
        """The form: "The site's enrolment key, for a new device" must be empty, or a text of 1 to 128""",
    ),
    (
        {"join_key": "word"},
        """The form has an enrolment key, but does not say "Site (its short name)", whose key it is.""",
    ),
    ({"ca": "no certificate"}, "The form: the certificate is not in PEM form."),
    (
        {"ca": "-----BEGIN CERTIFICATE-----\nAAAA\n-----END CERTIFICATE-----"},
        "The form: the certificate is not in PEM form.",
    ),
    ({"time_server": "a b"}, 'The form: "Time server, if not pool.ntp.org" must be a name or address of at most 253'),
]


def test_a_value_that_does_not_fit_is_named_and_nothing_is_kept(page: Page) -> None:
    before = (page.chip.folder / "config.json").read_text()
    good = {**page.form.values, "driver": "mixer", "name": "Mixer"}
    for values, sentence in WRONG:
        status, _, body = page.post({**good, **values})
        told = re.search(r'role="alert">(.*?)</p>', body)
        assert status == 200
        assert told is not None, body
        assert unescape(told[1]).startswith(sentence)
    assert (page.chip.folder / "config.json").read_text() == before
    assert page.chip.process.poll() is None


def test_requests_that_are_none_and_from_elsewhere(page: Page) -> None:
    before = (page.chip.folder / "config.json").read_text()
    good = {**page.form.values, "driver": "mixer", "name": "Mixer"}
    assert page.get("/generate_204", "connectivitycheck.example")[:2][1]["Location"] == f"http://{page.host}/"
    assert page.get("/other")[0] == 302
    assert page.post(good, host="rebound.example")[0] == 302
    assert page.post({**good, "token": "guessed"})[0] == 400
    assert page.post({name: value for name, value in good.items() if name != "token"})[0] == 400
    assert page.post({f"field{n}": "" for n in range(50)})[0] == 400
    host = f"Host: {page.host}\r\n".encode()
    for request, status in (
        (b"nonsense\r\n\r\n", 400),
        (b"GET / HTTP/1.1 more words\r\n\r\n", 400),
        (b"\xff\xfe\r\n\r\n", 400),
        (b"GET /" + b"a" * 1100 + b" HTTP/1.1\r\n\r\n", 400),
        (b"GET / HTTP/1.1\r\n" + b"A: b\r\n" * 41 + b"\r\n", 400),
        (b"DELETE / HTTP/1.1\r\n" + host + b"\r\n", 405),
        (b"POST /other HTTP/1.1\r\n" + host + b"\r\n", 404),
        (b"POST / HTTP/1.1\r\n" + host + b"Content-Length: 9000\r\n\r\n", 413),
        (b"POST / HTTP/1.1\r\n" + host + b"Content-Length: -1\r\n\r\n", 400),
        (b"POST / HTTP/1.1\r\n" + host + b"Content-Length: 7\r\n\r\ntoken=%", 400),
    ):
        assert page.ask(request)[0] == status, request
    assert (page.chip.folder / "config.json").read_text() == before
    assert page.get()[0] == 200


def test_every_name_leads_to_the_page(page: Page) -> None:
    question = b"\x12\x34\x01\x00\x00\x01\x00\x00\x00\x00\x00\x00\x07captive\x05apple\x03com\x00"
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as asker:
        asker.settimeout(LIMIT_S)
        asker.connect(("127.0.0.1", page.names_port))
        for nonsense in (
            b"",
            b"\x00",
            b"\xff" * 512,
            question,
            question[:12] + b"\x3f" + b"a" * 20,
            b"\x12\x34\x81" + question[3:],
        ):
            asker.send(nonsense)
        asker.send(question + b"\x00\x1c\x00\x01")  # an IPv6 address: there is none
        assert struct.unpack("!HHHHHH", asker.recv(512)[:12]) == (0x1234, 0x8500, 1, 0, 0, 0)
        asker.send(question + b"\x00\x01\x00\x01")
        answer = asker.recv(512)
    assert struct.unpack("!HHHHHH", answer[:12]) == (0x1234, 0x8500, 1, 1, 0, 0)
    assert answer.endswith(b"\xc0\x0c\x00\x01\x00\x01\x00\x00\x00\x0a\x00\x04\x7f\x00\x00\x01")


def test_the_button_asks_for_the_page_while_the_wifi_is_looked_for(micropython: str, tmp_path: Path) -> None:
    pressed = tmp_path / "pressed"
    known = {"wifi_name": "gone", "host": "old", "port": 1883, "id": "old", "password": "word", "pins": {"button": 0}}
    (tmp_path / "config.json").write_text(json.dumps(known))
    environment = {"VIPO_PRESSED": str(pressed)}
    with running_chip(micropython, tmp_path, environment) as chip:
        chip.wait(lambda record: any(entry[1] == "join" for entry in record))
        pressed.touch()
        wait_for("the press of the button in the log", lambda: "release button" in chip.console)
        assert chip.process.poll() is None
        pressed.unlink()
        assert chip.process.wait(LIMIT_S) == 7
    with set_up(micropython, tmp_path, environment) as page:
        assert page.form.values["host"] == "old"
    assert not (tmp_path / "set-up").exists()


def test_another_chip_of_the_family_opens_the_page_without_the_usual_pins(micropython: str, tmp_path: Path) -> None:
    with set_up(micropython, tmp_path, {"VIPO_LACKS": "22 23 24 25"}) as page:
        assert page.get()[0] == 200
        assert "Join the Wi-Fi VIPO-12abcd with " in page.chip.console
        assert not [entry for entry in page.chip.record if entry[1] in ("i2c", "pin")]


def test_a_pin_that_the_chip_does_not_have_is_named(micropython: str, tmp_path: Path) -> None:
    known: dict[str, Any] = {"wifi_name": "hall", "host": "old", "port": 1883, "id": "old", "password": "word"}
    known["pins"] = {"sda": 4, "scl": 5, "output": 24}
    (tmp_path / "config.json").write_text(json.dumps(known))
    with set_up(micropython, tmp_path, {"VIPO_LACKS": "24"}) as page:
        assert "config.json: pin 24 cannot be 'output': invalid pin.\n" in page.chip.console
        assert texts(page.chip.record)[-1][0] == "VIPO-12abcd     "
        assert not [entry for entry in page.chip.record if entry[1] == "pin"]
