"""What is said to a provider and what it answers: discovery, the code's exchange, keys, and what its ID token proves.

Authlib speaks OAuth and knows the claims, joserfc the signatures. What they leave to whoever uses them stands here:
that the issuer is the one of the settings, that only signatures with public keys count, that keys are asked for anew,
and that no answer is larger or later than it may be.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any
from urllib.parse import urlencode, urlsplit

import requests
from authlib.integrations.base_client.errors import OAuthError
from authlib.integrations.requests_client import OAuth2Session
from authlib.oidc.core import CodeIDToken
from joserfc import jwt
from joserfc.errors import ClaimError, ExpiredTokenError, InvalidKeyIdError, JoseError
from joserfc.jwk import KeySet
from joserfc.jwt import JWTClaimsRegistry
from requests.adapters import HTTPAdapter

from registry.people.sign_on.providers import BadLogoutToken, Identity, LoggedOut, Provider, SignOnFailed, Why

ALGORITHMS = ["RS256", "RS384", "RS512", "PS256", "PS384", "PS512", "ES256", "ES384", "ES512", "Ed25519"]
"""Signatures with a public key: none with a shared secret, and never `none`."""
LEEWAY_S = 60
"""So far a clock may be wrong."""
KEPT_S = 300
"""So long what a provider says of itself, and its keys, are good; a key that is not among them is asked for at once."""
CONNECT_S, ANSWER_S, MOST_BYTES = 4, 10, 1024 * 1024
_WHY_OF_CLAIM: dict[str, Why] = {"nonce": "nonce", "iat": "clock", "nbf": "clock", "exp": "clock"}
SCOPE = "openid email profile"
LOGOUT_EVENT = "http://schemas.openid.net/event/backchannel-logout"
MOST_TOKEN = 16 * 1024
"""Characters of a logout token."""
STRANGERS_EVERY_S = 10
"""Anybody may send a logout token: so often at most is the provider asked for the key that one names."""


class _Bounded(HTTPAdapter):  # type: ignore[misc]  # requests ships no types
    """Takes no answer that is larger or later than it may be, and follows nobody elsewhere."""

    def send(self, request: Any, **options: Any) -> Any:
        """Return the answer, read."""
        until = time.monotonic() + ANSWER_S
        response = super().send(request, **{**options, "stream": True, "timeout": (CONNECT_S, ANSWER_S)})
        if response.is_redirect:
            raise requests.TooManyRedirects("It sends VIPO elsewhere.")
        read = b""
        for piece in response.iter_content(16 * 1024):
            read += piece
            if len(read) > MOST_BYTES or time.monotonic() > until:
                raise requests.ConnectionError("Its answer is too long, or took too long.")
        response._content = read
        return response


@dataclass(frozen=True, slots=True)
class _Known:
    """What a provider says of itself, and its keys, as read at a moment of the monotonic clock."""

    metadata: dict[str, Any]
    keys: Any
    at: float


_known: dict[tuple[str, str], _Known] = {}
_lock = threading.Lock()


def forget_providers() -> None:
    """Forget what providers have said of themselves, so that they are asked anew."""
    _known.clear()


def begin_address(provider: Provider, *, state: str, nonce: str, verifier: str, back: str) -> str:
    """Return where a browser goes to be asked who it is; it comes back to `back`. Raises SignOnFailed (down)."""
    with _session(provider, back) as session:
        url, _ = session.create_authorization_url(
            _metadata(provider)["authorization_endpoint"],
            state=state,
            nonce=nonce,
            code_verifier=verifier,
            **({"acr_values": " ".join(sorted(provider.acr))} if provider.acr else {}),
        )
        return str(url)


def check_sender(provider: Provider, issuer: str) -> None:
    """Refuse an answer that another provider has sent (RFC 9207). Raises SignOnFailed."""
    says = bool(_metadata(provider).get("authorization_response_iss_parameter_supported"))
    if (says or issuer) and issuer != provider.issuer:
        raise SignOnFailed("answer", provider.title, f"sent by {issuer[:200]!r}")


def exchange(provider: Provider, *, code: str, nonce: str, verifier: str, back: str) -> Identity:
    """Give a code to the provider and return whom its ID token proves. Raises SignOnFailed."""
    endpoint = _metadata(provider)["token_endpoint"]
    with _session(provider, back) as session:
        try:
            token = session.fetch_token(endpoint, code=code, code_verifier=verifier, grant_type="authorization_code")
        except OAuthError as error:
            why: Why = "code" if error.error == "invalid_grant" else "refused"
            raise SignOnFailed(why, provider.title, f"{error.error}: {error.description}"[:500]) from error
        except (requests.RequestException, ValueError, KeyError) as error:
            raise SignOnFailed("down", provider.title, str(error)) from error
        claims = _read_token(provider, token, nonce)
        about = {**_more(provider, session, token, claims), **claims}
    amr = claims.get("amr") if isinstance(claims.get("amr"), list) else []
    return Identity(
        issuer=provider.issuer,
        subject=str(claims["sub"]),
        email=_text(about.get("email"), 254).strip().lower(),
        is_verified=about.get("email_verified") is True,
        name=_text(about.get("name"), 100) or _text(about.get("preferred_username"), 100),
        has_factor=not provider.amr.isdisjoint(map(str, amr or ())) or claims.get("acr") in provider.acr,
        id_token=str(token["id_token"]) if provider.signs_out else "",
        sid=_text(claims.get("sid"), 255),
    )


def sign_out_address(provider: Provider, *, id_token: str, back: str) -> str:
    """Return where a browser goes to be signed out at the provider, too; empty where it cannot, or does not answer."""
    try:
        endpoint = _metadata(provider).get("end_session_endpoint", "")
    except SignOnFailed:
        return ""
    asked = {"client_id": provider.client_id, "id_token_hint": id_token, "post_logout_redirect_uri": back}
    joint = "&" if "?" in endpoint else "?"
    return f"{endpoint}{joint}{urlencode({k: v for k, v in asked.items() if v})}" if endpoint else ""


def read_logout_token(provider: Provider, text: str) -> LoggedOut:
    """Return whose session has ended at the provider (OpenID Connect Back-Channel Logout 1.0, section 2.6).

    Raises BadLogoutToken, SignOnFailed (down).
    """
    right = JWTClaimsRegistry(
        leeway=LEEWAY_S,
        iss={"essential": True, "value": provider.issuer},
        aud={"essential": True, "value": provider.client_id},
        iat={"essential": True},
        exp={"essential": True},
        jti={"essential": True},
    )
    try:
        if len(text) > MOST_TOKEN:
            raise BadLogoutToken("It is too long.")
        claims = _decode(provider, text, again_after_s=STRANGERS_EVERY_S).claims
        right.validate(claims)
    except (JoseError, ValueError, TypeError, KeyError, AttributeError) as error:
        raise BadLogoutToken(f"It is not right: {type(error).__name__}.") from error
    events = claims.get("events")
    if not isinstance(events, dict) or not isinstance(events.get(LOGOUT_EVENT), dict) or "nonce" in claims:
        raise BadLogoutToken("It is a token for something else.")
    subject, sid = (claims.get(name, "") for name in ("sub", "sid"))
    if not all(isinstance(each, str) and len(each) <= 255 and "\0" not in each for each in (subject, sid)):
        raise BadLogoutToken("Its sub or sid is none.")
    if not subject and not sid:
        raise BadLogoutToken("It has neither sub nor sid.")
    return LoggedOut(provider.issuer, subject, sid, at=max(0.0, float(claims["iat"])))


def _session(provider: Provider, back: str = "") -> Any:
    """Return what speaks to a provider, which follows no redirect and reads no file of this machine's."""
    session = OAuth2Session(
        client_id=provider.client_id,
        client_secret=provider.client_secret,
        scope=SCOPE,
        redirect_uri=back,
        code_challenge_method="S256",
        token_endpoint_auth_method=_auth_method(provider),
    )
    for start in ("https://", "http://"):
        session.mount(start, _Bounded())
    return session


def _auth_method(provider: Provider) -> str:
    methods = _metadata(provider).get("token_endpoint_auth_methods_supported") or ["client_secret_basic"]
    return "client_secret_basic" if "client_secret_basic" in methods else "client_secret_post"


def _read_token(provider: Provider, token: dict[str, Any], nonce: str) -> dict[str, Any]:
    """Return the claims of the ID token, once everything about it is right."""
    title = provider.title
    try:
        read = _decode(provider, str(token.get("id_token", "")))
        params = {"nonce": nonce, "client_id": provider.client_id, "access_token": token.get("access_token")}
        wanted = {
            "iss": {"essential": True, "value": provider.issuer},
            "aud": {"essential": True, "value": provider.client_id},
        }
        claims = CodeIDToken(read.claims, read.header, wanted, params)
        claims.validate(leeway=LEEWAY_S)
    except ExpiredTokenError as error:
        raise SignOnFailed("clock", title, str(error)) from error
    except ClaimError as error:
        raise SignOnFailed(_WHY_OF_CLAIM.get(error.claim, "answer"), title, str(error)) from error
    except (JoseError, ValueError, TypeError, KeyError, AttributeError) as error:
        raise SignOnFailed("answer", title, f"{type(error).__name__}: {error}") from error
    subject = claims.get("sub")
    if not isinstance(subject, str) or not 0 < len(subject) <= 255 or "\0" in subject:
        raise SignOnFailed("answer", title, "its subject is none")
    return dict(claims)


def _decode(provider: Provider, text: str, *, again_after_s: float = 0.0) -> Any:
    """Read a token by the provider's keys; one that is not known yet is asked for, as keys are changed.

    Not if the keys were read within the last `again_after_s`.
    """
    known = _known_of(provider)
    try:
        return jwt.decode(text, KeySet.import_key_set(known.keys), algorithms=ALGORITHMS)
    except InvalidKeyIdError:
        if time.monotonic() - known.at < again_after_s:
            raise
        return jwt.decode(text, KeySet.import_key_set(_ask(provider).keys), algorithms=ALGORITHMS)


def _more(provider: Provider, session: Any, token: dict[str, Any], claims: dict[str, Any]) -> dict[str, Any]:
    """Return what the provider tells beside its ID token, where that has no address; of the same person alone."""
    endpoint = _metadata(provider).get("userinfo_endpoint")
    if "email" in claims or not endpoint or not token.get("access_token"):
        return {}
    try:
        answer = session.get(endpoint)
        answer.raise_for_status()
        told = answer.json()
    except (requests.RequestException, OAuthError, ValueError) as error:
        raise SignOnFailed("down", provider.title, str(error)) from error
    if not isinstance(told, dict) or told.get("sub") != claims["sub"]:
        raise SignOnFailed("answer", provider.title, "userinfo tells of somebody else")
    return told


def _metadata(provider: Provider) -> dict[str, Any]:
    return _known_of(provider).metadata


def _known_of(provider: Provider) -> _Known:
    known = _known.get((provider.issuer, provider.client_id))
    return known if known and time.monotonic() - known.at < KEPT_S else _ask(provider)


def _ask(provider: Provider) -> _Known:
    """Ask a provider for what it is and for its keys. Raises SignOnFailed (down)."""
    with requests.Session() as session:
        for start in ("https://", "http://"):
            session.mount(start, _Bounded())
        metadata = _read_json(provider, lambda: session.get(_discovery(provider.issuer)))
        _check(provider, metadata)
        keys = _read_json(provider, lambda: session.get(metadata["jwks_uri"]))
    known = _Known(metadata, keys, time.monotonic())
    with _lock:
        _known[(provider.issuer, provider.client_id)] = known
    return known


def _read_json(provider: Provider, ask: Callable[[], requests.Response]) -> dict[str, Any]:
    try:
        answer = ask()
        answer.raise_for_status()
        found = answer.json()
    except (requests.RequestException, ValueError) as error:
        raise SignOnFailed("down", provider.title, str(error)) from error
    if not isinstance(found, dict):
        raise SignOnFailed("down", provider.title, "its answer is no object")
    return found


def _check(provider: Provider, metadata: dict[str, Any]) -> None:
    """Refuse what another provider says of itself, and addresses where others read along."""
    if metadata.get("issuer") != provider.issuer:
        raise SignOnFailed("down", provider.title, f"it calls itself {str(metadata.get('issuer'))[:200]!r}")
    scheme = urlsplit(provider.issuer).scheme
    needed = {"authorization_endpoint", "token_endpoint", "jwks_uri"}
    for name in needed | ({"userinfo_endpoint", "end_session_endpoint"} & metadata.keys()):
        address = metadata.get(name)
        if not isinstance(address, str) or urlsplit(address).scheme not in {"https", scheme}:
            raise SignOnFailed("down", provider.title, f"its {name} is none that can be trusted")


def _discovery(issuer: str) -> str:
    return f"{issuer.rstrip('/')}/.well-known/openid-configuration"


def _text(value: object, most: int) -> str:
    """Return a claim that is a text of one line, empty where it is none."""
    text = value if isinstance(value, str) else ""
    return text[:most] if text.isprintable() else ""
