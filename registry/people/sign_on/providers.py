"""Whom people may sign in by, as the server's settings say, and how a sign-on can fail."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Literal

from django.conf import settings

from registry.errors import RegistryError

Why = Literal[
    "provider", "down", "denied", "refused", "code", "clock", "nonce", "answer", "replayed", "expired", "browser",
    "unknown", "nobody", "unverified", "taken", "other", "address", "closed", "signed_out",
]  # fmt: skip
_SENTENCES: dict[Why, tuple[int, str]] = {
    "provider": (404, "Nobody signs in here by this provider. Go to the sign-in page and choose another way."),
    "down": (503, "{provider} does not answer, or says nothing that VIPO can read. Try again in a few minutes."),
    "denied": (403, "{provider} let you not in, or you turned back there. Start again from the sign-in page."),
    "refused": (
        403,
        "{provider} refused the sign-on; the server's log has its words. Tell whoever runs this VIPO server.",
    ),
    "code": (403, "{provider} does not take this sign-on any more. Start again from the sign-in page."),
    "clock": (403, "The clocks of {provider} and of VIPO differ too much. Tell whoever runs this VIPO server."),
    "nonce": (403, "The answer of {provider} belongs to another sign-on. Start again from the sign-in page."),
    "answer": (
        403,
        "The answer of {provider} is not signed by it, or not meant for VIPO. Tell whoever runs this VIPO server.",
    ),
    "replayed": (403, "This sign-on was used already. Start again from the sign-in page."),
    "expired": (403, "This sign-on took longer than 10 minutes. Start again from the sign-in page."),
    "browser": (403, "This sign-on began in another browser. Start again from the sign-in page of this one."),
    "unknown": (403, "This is no sign-on that began here. Start again from the sign-in page."),
    "nobody": (
        403,
        "Nobody here signs in by this account of {provider}. Sign in with your password and link it on the page of "
        "your account; without an account here, ask for an invitation.",
    ),
    "unverified": (
        403,
        "{provider} has not made sure that your e-mail address is yours, so no account is made. Have it verified "
        "there, then start again.",
    ),
    "taken": (409, "This account of {provider} is somebody else's here. Choose another one there."),
    "other": (409, "Another account of {provider} is linked here already. Take that link away first."),
    "address": (
        403,
        "Somebody has an account here with the e-mail address that {provider} tells. If it is you, sign in with your "
        "password and link {provider} on the page of your account.",
    ),
    "closed": (403, "This account is closed. Ask whoever runs this VIPO server."),
    "signed_out": (403, "You have signed out, or signed in as somebody else, since this began. Start again."),
}


class SignOnFailed(RegistryError):
    """A sign-on that lets nobody in; `why` says it in other languages, `log` is for the server's log alone."""

    code = "sign_on_failed"

    def __init__(self, why: Why, provider: str = "", log: str = "") -> None:
        self.why: Why = why
        self.log = log
        self.status, sentence = _SENTENCES[why]
        super().__init__(sentence.format(provider=provider), {"why": why, "provider": provider})


class BadLogoutToken(RegistryError):
    """What says that a session has ended at a provider, and is not the provider's word."""

    code = "bad_logout_token"
    status = 400

    def __init__(self, why: str) -> None:
        super().__init__(f"This is no logout token that VIPO takes. {why}")


@dataclass(frozen=True, slots=True)
class Provider:
    """A provider as the settings have it; `title` is what its button says.

    `links_by_email` lets a verified address link an account, accounts are made for verified addresses of `domains`,
    and `amr` and `acr` are the words of its ID token that stand for a second factor.
    """

    name: str
    title: str
    issuer: str
    client_id: str
    client_secret: str = field(repr=False)
    links_by_email: bool = False
    domains: frozenset[str] = frozenset()
    amr: frozenset[str] = frozenset()
    acr: frozenset[str] = frozenset()
    signs_out: bool = False


@dataclass(frozen=True, slots=True)
class Identity:
    """Who somebody is, as a provider has proved it; `has_factor`: also by a second factor, as the settings read it.

    `sid` is what the provider calls their session there, if it says so.
    """

    issuer: str
    subject: str
    email: str = ""
    is_verified: bool = False
    name: str = ""
    has_factor: bool = False
    id_token: str = field(default="", repr=False)
    sid: str = ""


@dataclass(frozen=True, slots=True)
class LoggedOut:
    """Whose session has ended at a provider: of a subject all, or the one called `sid`; `at` in seconds since 1970."""

    issuer: str
    subject: str
    sid: str
    at: float


def list_providers() -> tuple[Provider, ...]:
    """Return the providers of this server, in the order of their buttons."""
    return tuple(_read(row) for row in settings.VIPO_SIGN_ON)


def find_provider(name: str) -> Provider:
    """Return a provider by its name. Raises SignOnFailed."""
    found = next((each for each in list_providers() if each.name == name), None)
    if found is None:
        raise SignOnFailed("provider")
    return found


def title_of(name: str) -> str:
    """Return what a provider is called; one that is set up no more by its name."""
    return next((each.title for each in list_providers() if each.name == name), name)


def _read(row: dict[str, Any]) -> Provider:
    sets = {key: frozenset(row[key]) for key in ("domains", "amr", "acr")}
    return Provider(**{**row, **sets})
