"""ID tokens that must not be taken: each is right but for one thing, and signed for real."""

from __future__ import annotations

import hashlib
import hmac
import time
from base64 import urlsafe_b64encode
from collections.abc import Iterator
from typing import Any

import pytest
from joserfc import jwt
from joserfc.jwk import ECKey, OctKey, RSAKey

from registry.people.sign_on import provider_client
from registry.people.sign_on.provider_client import _Known, _known, _read_token
from registry.people.sign_on.providers import Provider, SignOnFailed

ACME = Provider("acme", "Acme", "https://acme.example", "vipo", "a secret of these tests")
RSA, EC = RSAKey.generate_key(2048, {"kid": "rsa"}), ECKey.generate_key("P-256", {"kid": "ec"})
STRANGE = RSAKey.generate_key(2048, {"kid": "rsa"})
ACCESS = "an access token"


@pytest.fixture(autouse=True)
def keys() -> Iterator[None]:
    public = {"keys": [RSA.as_dict(private=False), EC.as_dict(private=False)]}
    _known[(ACME.issuer, ACME.client_id)] = _Known({"issuer": ACME.issuer}, public, time.monotonic())
    yield
    provider_client.forget_providers()


def encode(raw: bytes) -> str:
    return urlsafe_b64encode(raw).decode().rstrip("=")


def half_hash(text: str) -> str:
    return encode(hashlib.sha256(text.encode()).digest()[:16])


def claims(**changes: Any) -> dict[str, Any]:
    """Return what is right, with something changed; None leaves it out."""
    now = int(time.time())
    right = {"iss": ACME.issuer, "sub": "ada", "aud": "vipo", "iat": now, "exp": now + 300, "nonce": "n"}
    return {name: value for name, value in {**right, **changes}.items() if value is not None}


def read(told: dict[str, Any], key: Any = RSA, alg: str = "RS256", kid: str = "rsa") -> dict[str, Any]:
    text = jwt.encode({"alg": alg, "kid": kid}, told, key, algorithms=[alg])
    return _read_token(ACME, {"id_token": text, "access_token": ACCESS}, "n")


def why(told: dict[str, Any], **signed: Any) -> str:
    with pytest.raises(SignOnFailed) as failed:
        read(told, **signed)
    return failed.value.why


@pytest.mark.parametrize(("key", "alg", "kid"), [(RSA, "RS256", "rsa"), (RSA, "PS256", "rsa"), (EC, "ES256", "ec")])
def test_what_is_right_is_taken(key: Any, alg: str, kid: str) -> None:
    told = claims(at_hash=half_hash(ACCESS), azp="vipo")
    assert read(told, key, alg, kid) == told
    assert read(claims(aud=["vipo"]), key, alg, kid)["sub"] == "ada"


OFF = [
    ({"iss": "https://acme.example/"}, "answer"),
    ({"iss": "https://other.example"}, "answer"),
    ({"iss": None}, "answer"),
    ({"aud": "other"}, "answer"),
    ({"aud": ["other"], "azp": "vipo"}, "answer"),
    ({"aud": ["vipo", "other"]}, "answer"),
    ({"aud": ["vipo", "other"], "azp": "other"}, "answer"),
    ({"azp": "other"}, "answer"),
    ({"aud": None}, "answer"),
    ({"sub": None}, "answer"),
    ({"sub": ""}, "answer"),
    ({"sub": 7}, "answer"),
    ({"sub": "a\0b"}, "answer"),
    ({"sub": "a" * 256}, "answer"),
    ({"exp": 1}, "clock"),
    ({"exp": None}, "clock"),
    ({"iat": 4_000_000_000}, "clock"),
    ({"nbf": 4_000_000_000}, "clock"),
    ({"nonce": "m"}, "nonce"),
    ({"nonce": None}, "nonce"),
    ({"at_hash": half_hash("another")}, "answer"),
]


@pytest.mark.parametrize(("changes", "expected"), OFF)
def test_one_claim_that_is_off_is_enough(changes: dict[str, Any], expected: str) -> None:
    assert why(claims(**changes)) == expected


def test_signatures_of_others_with_shared_secrets_and_none_count_for_nothing() -> None:
    assert why(claims(), key=STRANGE) == "answer"
    shared = OctKey.import_key(ACME.client_secret)
    assert why(claims(), key=shared, alg="HS256") == "answer"
    right = jwt.encode({"alg": "RS256", "kid": "rsa"}, claims(), RSA)
    head, body, sign = right.split(".")
    none, confused = (encode(b'{"alg":"%s","kid":"rsa"}' % alg) for alg in (b"none", b"HS256"))
    by_public_key = encode(hmac.digest(RSA.as_pem(private=False), f"{confused}.{body}".encode(), "sha256"))
    for text in (
        f"{confused}.{body}.{by_public_key}",
        f"{none}.{body}.",
        f"{none}.{body}.{sign}",
        f"{head}.{body}.",
        f"{head}.{body}",
        "",
        "a.b.c",
        right[:-4],
    ):
        with pytest.raises(SignOnFailed) as failed:
            _read_token(ACME, {"id_token": text}, "n")
        assert failed.value.why == "answer"


def test_what_a_provider_says_of_itself_is_held_to_the_settings() -> None:
    right = {
        "issuer": ACME.issuer,
        "authorization_endpoint": "https://acme.example/auth",
        "token_endpoint": "https://acme.example/token",
        "jwks_uri": "https://acme.example/keys",
    }
    provider_client._check(ACME, right)
    for name, value in (
        ("issuer", "https://other.example"),
        ("token_endpoint", "http://acme.example/token"),
        ("jwks_uri", None),
    ):
        with pytest.raises(SignOnFailed):
            provider_client._check(ACME, {**right, name: value})
