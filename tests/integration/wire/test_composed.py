"""The documented deployment, set up by its script, started as processes and attacked as a stranger."""

from __future__ import annotations

import asyncio
import re
import ssl
import stat
import subprocess
import sys
from collections.abc import Iterator
from contextlib import closing
from email.message import EmailMessage
from pathlib import Path
from typing import Any

import httpx
import pytest
import websockets
from aiosmtpd.controller import Controller
from aiosmtpd.handlers import Message
from aiosmtpd.smtp import SMTP, AuthResult, Envelope, LoginPassword, Session

from tests.integration.wire.composed import Composed, running_composed, wait_open
from tests.kit.files import ROOT
from tests.kit.servers import free_port
from tests.kit.sign_in import sign_in
from tests.kit.waiting import wait_for
from vipo_device.kit.liveness_file import is_alive
from vipo_device.protocol.mqtt_client import MqttClient
from vipo_device.protocol.sockets import tls_context

pytestmark = pytest.mark.servers
FORGED = {"X-Forwarded-For": "198.51.100.{n}", "X-Real-IP": "198.51.100.{n}", "Forwarded": "for=198.51.100.{n}"}


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Composed]:
    with running_composed(tmp_path_factory.mktemp("composed")) as running:
        for web in ("web-1", "web-2"):
            wait_open(running, lambda w=web: answers(f"http://{running.address(w)}:8000/health", running))
        wait_open(running, lambda: answers(f"{running.url}/health", running))
        yield running


def trust(site: Composed) -> ssl.SSLContext:
    return ssl.create_default_context(cafile=str(site.site / "secrets" / "authority" / "ca.crt"))


def answers(url: str, site: Composed) -> bool:
    try:
        host = {"Host": site.address("proxy")}
        return httpx.get(url, verify=trust(site), headers=host, timeout=10).status_code == 200
    except httpx.HTTPError:
        return False


def browser(site: Composed) -> httpx.Client:
    client = httpx.Client(base_url=site.url, verify=trust(site), timeout=60)
    client.headers.update({"Origin": site.url, "Referer": f"{site.url}/"})
    client.headers["X-CSRFToken"] = client.get("/api/me").json()["csrf"]
    return client


def make_account(site: Composed, email: str) -> str:
    found = re.search(r"shown this once: (\S+)", site.vipo("account", email))
    assert found is not None
    return found[1]


def test_plain_http_is_sent_to_https(site: Composed) -> None:
    proxy = site.address("proxy")
    answer = httpx.post(f"http://{proxy}:8080/api/sign-in?x=1", json={}, follow_redirects=False)
    assert (answer.status_code, answer.headers["Location"]) == (301, f"https://{proxy}/api/sign-in?x=1")
    assert "Set-Cookie" not in answer.headers


@pytest.mark.parametrize("path", ["/", "/index.html", "/sites", "/theme.js", "/api/me", "/api/nothing", "/health"])
def test_every_answer_has_its_headers_once(site: Composed, path: str) -> None:
    answer = httpx.get(f"{site.url}{path}", verify=trust(site))
    told = {name: answer.headers.get_list(name) for name in ("Strict-Transport-Security", "X-Content-Type-Options")}
    assert told == {"Strict-Transport-Security": ["max-age=31536000"], "X-Content-Type-Options": ["nosniff"]}
    assert len(answer.headers.get_list("Content-Security-Policy")) == 1
    policy = dict(part.split(" ", 1) for part in answer.headers["Content-Security-Policy"].split("; "))
    assert (policy["script-src"], policy["object-src"], policy["base-uri"]) == ("'self'", "'none'", "'none'")
    assert (policy["frame-ancestors"], policy["form-action"]) == ("'none'", "'self'")
    assert "Access-Control-Allow-Origin" not in answer.headers


def test_a_stranger_learns_no_password_and_gets_safe_cookies(site: Composed) -> None:
    answer = httpx.get(f"{site.url}/api/me", verify=trust(site))
    assert (answer.json()["user"], answer.json()["demo_accounts"]) == (None, [])
    cookies = answer.headers.get_list("Set-Cookie")
    assert [("csrftoken=" in cookie, "; Secure" in cookie) for cookie in cookies] == [(True, True)]
    assert not (site.folder / "state" / "demo-accounts.json").exists()


def test_people_come_in_as_the_page_says(site: Composed) -> None:
    word = make_account(site, "ada@vipo.example")
    with closing(browser(site)) as client:
        answer = client.post("/api/sign-in", json={"email": "ada@vipo.example", "password": word})
        assert answer.status_code == 200, answer.text
        session = next(cookie for cookie in answer.headers.get_list("Set-Cookie") if cookie.startswith("sessionid="))
        assert {"Secure", "HttpOnly"} <= set(session.split("; "))
        assert client.get("/api/me").json()["user"]["email"] == "ada@vipo.example"


def test_forged_headers_do_not_reset_the_throttle(site: Composed) -> None:
    word = make_account(site, "bob@vipo.example")
    codes = []
    for number in range(10):
        with closing(browser(site)) as client:
            forged = {name: value.format(n=number) for name, value in FORGED.items()}
            body = {"email": "bob@vipo.example", "password": "wrong"}
            codes.append(client.post("/api/sign-in", json=body, headers=forged).status_code)
    assert 429 in codes
    assert codes == sorted(codes)
    with httpx.Client(transport=httpx.HTTPTransport(local_address=site.address("stranger"), verify=trust(site))) as one:
        one.base_url = site.url  # type: ignore[assignment]
        one.headers.update({"Origin": site.url, "Referer": f"{site.url}/"})
        one.headers["X-CSRFToken"] = one.get("/api/me").json()["csrf"]
        sign_in(one, "bob@vipo.example", word)


def test_who_comes_round_the_proxy_is_not_believed(site: Composed) -> None:
    forged = {"Host": site.address("proxy"), "X-Forwarded-Proto": "https", "X-Forwarded-For": "127.0.0.1"}
    with httpx.Client(transport=httpx.HTTPTransport(local_address=site.address("stranger"))) as stranger:
        answer = stranger.get(f"http://{site.address('web-1')}:8000/", headers=forged)
    assert "wss:" not in answer.headers["Content-Security-Policy"]
    with httpx.Client(base_url=site.url, verify=trust(site)) as through:
        assert f"wss://{site.address('proxy')}:8443" in through.get("/").headers["Content-Security-Policy"]


@pytest.mark.parametrize("host", ["evil.example", "localhost", "web-1", "testserver"])
def test_a_host_that_is_not_served_is_refused(site: Composed, host: str) -> None:
    assert httpx.get(f"{site.url}/api/me", headers={"Host": host}, verify=trust(site)).status_code == 400


async def open_socket(site: Composed, origin: str, cookie: str) -> int | None:
    """Return the status with which a socket was refused, or None where it was opened."""
    try:
        address = f"{site.url.replace('https', 'wss')}/ws/site/hall"
        async with websockets.connect(
            address,
            origin=origin,
            ssl=trust(site),
            additional_headers={"Cookie": cookie},  # type: ignore[arg-type]
        ):
            return None
    except websockets.InvalidStatus as refused:
        return refused.response.status_code


def test_pages_of_other_addresses_open_no_sockets(site: Composed) -> None:
    own = site.url
    foreign = [
        own.replace("https", "http"),
        own.replace(":8443", ""),
        own.replace(":8443", ":9"),
        "https://evil.example",
    ]
    assert [asyncio.run(open_socket(site, origin, "")) for origin in foreign] == [403] * 4
    assert asyncio.run(open_socket(site, own, "")) is None


def test_the_broker_takes_nobody_without_a_password(site: Composed) -> None:
    secrets = site.site / "secrets"
    context = tls_context(str(secrets / "authority" / "ca.crt"))
    address, word = site.address("mosquitto"), (secrets / "broker-password").read_text().strip()
    for username, password, taken in (("server", word, True), ("server", "wrong", False), ("", "", False)):
        client = MqttClient(
            host=address, port=8884, username=username, password=password, client_id="stranger", tls=context
        )
        client.start()
        assert client.wait_connected(10 if taken else 2) is taken
        client.stop()


SEND = """
import django
django.setup()
from registry.sites.mail import can_mail, send_mail
assert can_mail()
assert send_mail(to="member@example.com", subject="1 comment", text="Warum? Grüße.")
"""


class Letters(Message):
    """A mail server's memory: what it was given, and by whom."""

    def __init__(self) -> None:
        super().__init__(EmailMessage)
        self.kept: list[EmailMessage] = []

    def handle_message(self, message: EmailMessage) -> None:
        self.kept.append(message)

    def authenticate(
        self, server: SMTP, session: Session, envelope: Envelope, mechanism: str, said: LoginPassword
    ) -> AuthResult:
        return AuthResult(success=said == LoginPassword(b"vipo", b"of the mail server"))


@pytest.mark.filterwarnings("ignore:Requiring AUTH while not requiring TLS")  # on this machine alone
@pytest.mark.parametrize("service", ["web-1", "rehearsals"])
def test_whoever_sends_mail_signs_in_at_a_real_mail_server(site: Composed, service: str) -> None:
    """Invitations come from a web process, comments from the worker of upkeep."""
    given = site.environment(service)
    assert given["VIPO_MAIL_HOST"] == ""
    letters = Letters()
    port = free_port()
    controller = Controller(letters, "127.0.0.1", port, authenticator=letters.authenticate, auth_required=True,
                            auth_require_tls=False)  # fmt: skip
    controller.start()
    try:
        way = {"VIPO_MAIL_HOST": "127.0.0.1", "VIPO_MAIL_PORT": str(port), "VIPO_MAIL_TLS": "none",
               "VIPO_MAIL_USER": "vipo", "VIPO_MAIL_PASSWORD": "of the mail server",
               "VIPO_MAIL_FROM": "vipo@example.com"}  # fmt: skip
        assert way.keys() <= given.keys()
        command = [sys.executable, "-c", SEND]
        done = subprocess.run(command, cwd=ROOT, env=given | way, capture_output=True, text=True)
    finally:
        controller.stop()
    assert done.returncode == 0, done.stderr
    assert [(each["From"], each["To"], each["Subject"]) for each in letters.kept] == [
        ("vipo@example.com", "member@example.com", "1 comment")
    ]


def test_each_process_shows_that_it_lives(site: Composed) -> None:
    for service in ("gateway", "worker-1", "ticker", "mirror", "stand-ins"):
        wait_for(service, lambda s=service: is_alive(site.folder / f"tmp-{s}" / "pulse"), 60, story=site.story)


def test_secrets_lie_where_only_their_owner_gets_to_them(site: Composed) -> None:
    assert mode(site.site / "secrets") == 0o700
    assert mode(site.site / "secrets" / "authority" / "ca.key") == 0o600
    assert mode(site.site / ".env") == 0o600
    named = {entry["file"] for entry in site.said["secrets"].values()}
    assert not [file for file in named if "ca.key" in file or "authority/" in file]
    words = [(site.site / "secrets" / name).read_text().strip() for name in ("django-key", "database-password")]
    assert not any(word in str(site.said) for word in words)
    assert mode(site.folder / "broker" / "config" / "dynamic-security.json") == 0o600


def mode(path: Path) -> int:
    return stat.S_IMODE(path.stat().st_mode)


def test_every_service_is_closed_bounded_and_pinned(site: Composed) -> None:
    services: dict[str, Any] = site.said["services"]
    for name, service in services.items():
        assert service["read_only"] is True, name
        assert service["cap_drop"] == ["ALL"], name
        assert service["security_opt"] == ["no-new-privileges:true"], name
        assert service["mem_limit"], name
        assert service["networks"], name
        assert "privileged" not in service, name
        assert service["image"] == "vipo" or re.search(r":\d+\.\d+(\.\d+)?", service["image"]), name
    waits = {name for name, service in services.items() if "healthcheck" not in service}
    assert waits == {"setup", "accounts", "vda5050", "mtconnect"}
    signing = {name for name, service in services.items() if "django-key" in service.get("secrets", ())}
    assert signing == {"setup", "web-1", "web-2"}
    published = {name: service["ports"] for name, service in services.items() if "ports" in service}
    assert published == {"mosquitto": ["8883:8883"], "proxy": ["443:8443", "80:8080"]}
