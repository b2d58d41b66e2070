"""A provider of OpenID Connect that nobody here wrote (npm's oidc-provider), and who signs in there."""

from __future__ import annotations

import json
import secrets
import subprocess
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs, urlsplit

import httpx
from joserfc.jwk import RSAKey

from tests.kit.node_packages import install_packages
from tests.kit.servers import answers, find_program, free_port, wait_ready

HERE = Path(__file__).parent
CLIENT, SECRET = "vipo-tests", "a secret of these tests, long enough for HMAC"
PEOPLE: dict[str, dict[str, Any]] = {
    "ada": {"email": "author@vipo.example", "email_verified": True, "name": "Ada of the provider"},
    "new": {"email": "new@vipo.example", "email_verified": True, "name": "Nova New"},
    "vague": {"email": "vague@vipo.example", "email_verified": False, "name": "Vague"},
    "mallory": {"email": "author@vipo.example", "email_verified": False, "name": "Mallory"},
    "bare": {},
}
"""Who has an account at the provider: claims by subject."""


def make_key(name: str) -> dict[str, Any]:
    """Return a key to sign with, as a JWK."""
    return {**RSAKey.generate_key(2048).as_dict(private=True), "kid": name, "use": "sig", "alg": "RS256"}


@dataclass
class OpenId:
    """A running provider; `back` is where it lets browsers come back to."""

    back: list[str]
    folder: Path
    port: int = field(default_factory=free_port)
    keys: list[dict[str, Any]] = field(default_factory=lambda: [make_key("first")])
    people: dict[str, dict[str, Any]] = field(default_factory=lambda: dict(PEOPLE))
    offset_s: int = 0
    client: dict[str, Any] = field(default_factory=dict)
    process: subprocess.Popen[bytes] | None = None

    @property
    def issuer(self) -> str:
        return f"http://127.0.0.1:{self.port}"

    def setting(self, **more: Any) -> dict[str, Any]:
        """Return what VIPO's settings say of this provider."""
        return {
            "name": "acme",
            "title": "Acme",
            "issuer": self.issuer,
            "client_id": CLIENT,
            "client_secret": SECRET,
            "links_by_email": False,
            "domains": [],
            "amr": [],
            "acr": [],
            "signs_out": False,
            **more,
        }

    def environment(self, **more: str) -> dict[str, str]:
        """Return the same as a server's environment."""
        about = {"ISSUER": self.issuer, "CLIENT_ID": CLIENT, "CLIENT_SECRET": SECRET, "TITLE": "Acme", **more}
        return {"VIPO_SIGN_ON": "acme", **{f"VIPO_SIGN_ON_ACME_{name}": value for name, value in about.items()}}

    def start(self) -> None:
        """Start (again), on the same port; what it kept is gone."""
        client = {
            "client_id": CLIENT,
            "client_secret": SECRET,
            "redirect_uris": self.back,
            "post_logout_redirect_uris": [address.rpartition("/sign-on/")[0] + "/sign-in" for address in self.back],
            **self.client,
        }
        told = {
            "issuer": self.issuer,
            "port": self.port,
            "client": client,
            "people": self.people,
            "keys": self.keys,
            "offset_s": self.offset_s,
        }
        log = self.folder / "openid.log"
        with log.open("ab") as out:
            command = [find_program("node"), "provider.mjs", json.dumps(told)]
            self.process = subprocess.Popen(command, cwd=HERE, stdout=out, stderr=out)
        wait_ready(lambda: answers(self.port), log.read_text, self.process)

    def stop(self) -> None:
        """End it."""
        if self.process is not None:
            self.process.kill()
            self.process.wait()

    def restart(self, **changes: Any) -> None:
        """Start it again with something changed."""
        self.stop()
        for name, value in changes.items():
            setattr(self, name, value)
        self.start()


@contextmanager
def run_openid(folder: Path, back: list[str]) -> Iterator[OpenId]:
    """Run a provider within the block."""
    install_packages(HERE)
    provider = OpenId(back, folder)
    provider.start()
    try:
        yield provider
    finally:
        provider.stop()


def visit(address: str, name: str, *, amr: str = "", acr: str = "", do: str = "in") -> dict[str, str]:
    """Go to a provider as a person's browser does, and sign in there; return what it gives the browser along."""
    with httpx.Client(timeout=30) as browser:
        answer = browser.get(address)
        for _ in range(8):
            if answer.is_redirect:
                place = str(httpx.URL(address).join(answer.headers["Location"]))
                if "/sign-on/" in urlsplit(place).path:
                    return {key: values[0] for key, values in parse_qs(urlsplit(place).query).items()}
                answer = browser.get(place)
            else:
                assert answer.status_code == 200, answer.text
                answer = browser.post(answer.url, data={"name": name, "amr": amr, "acr": acr, "do": do})
    raise AssertionError(f"The provider did not send the browser back: {answer.status_code} {answer.text[:500]}")


def answer_of(given: Mapping[str, str]) -> dict[str, str]:
    """Return what the page sends of what the provider gave along."""
    return {key: given[key] for key in ("state", "code", "iss", "error") if key in given}


def stray_state() -> str:
    """Return a state that nobody has begun."""
    return secrets.token_urlsafe(32)
