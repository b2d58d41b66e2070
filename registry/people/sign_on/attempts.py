"""Sign-ons that are under way: each is begun by one browser, and taken once, by that browser, within ten minutes.

The browser holds a secret in a cookie that no script reads. What goes to the provider is made of it, and so is nowhere
kept: the nonce, and the proof that goes with the code (PKCE). Whoever steals a code, or has somebody open an address
that they have begun themselves, has the wrong secret.
"""

from __future__ import annotations

import base64
import hashlib
import hmac
import re
import secrets
from dataclasses import asdict, dataclass
from datetime import datetime, timedelta

from registry.models import Invitation, SignOnAttempt, User
from registry.people.sign_on.providers import Identity, Provider, SignOnFailed
from registry.people.throttle import WINDOW, TooManyAttempts, network_of

LASTS = timedelta(minutes=10)
KEPT = timedelta(hours=1)
"""One that is over is known for so long, so that a second use of it is told from a made-up one."""
MOST_OF_NETWORK = 200
_SECRET = re.compile(r"[A-Za-z0-9_-]{43}")
_NEXT = re.compile(r"/(?![/\\])[^\s\\]*")


@dataclass(frozen=True, slots=True)
class Begun:
    """What a browser and a provider are told of a sign-on; `browser` is the secret that only the browser holds."""

    state: str
    browser: str

    @property
    def nonce(self) -> str:
        """What the provider writes into its ID token."""
        return _derive(self, "nonce")

    @property
    def verifier(self) -> str:
        """What proves, with the code, that the same browser comes back; the provider is told its hash before."""
        return _derive(self, "verifier")


@dataclass(frozen=True, slots=True)
class Purpose:
    """What a sign-on is for: where to go then, who wants to be linked, and the invitation that somebody came by.

    `link_code` is the code of its link, where it is not found yet.
    """

    next: str = ""
    link_code: str = ""
    link_to: User | None = None
    invitation: Invitation | None = None


def safe_next(address: str) -> str:
    """Return an address of VIPO's own pages, or the first page: nobody is led elsewhere."""
    return address if len(address) <= 500 and _NEXT.fullmatch(address) else "/"


def begin_attempt(*, provider: Provider, browser: str, purpose: Purpose, address: str, now: datetime) -> Begun:
    """Begin a sign-on in a browser, which keeps the secret that it has. Raises TooManyAttempts."""
    network = network_of(address)
    if SignOnAttempt.objects.filter(network=network, at__gt=now - LASTS).count() >= MOST_OF_NETWORK:
        minutes = round(LASTS.total_seconds() / 60)
        raise TooManyAttempts(
            f"Too many sign-ons began here. Try again in {minutes} min.",
            {"why": "sign_on", "minutes": minutes, "retry_after_s": minutes * 60},
        )
    begun = Begun(secrets.token_urlsafe(32), browser if _SECRET.fullmatch(browser) else secrets.token_urlsafe(32))
    SignOnAttempt.objects.create(
        state_hash=_hash(begun.state),
        browser_hash=_hash(begun.browser),
        provider=provider.name,
        network=network,
        next=safe_next(purpose.next),
        link_to=purpose.link_to,
        invitation=purpose.invitation,
        at=now,
    )
    return begun


def take_attempt(*, provider: Provider, begun: Begun, now: datetime) -> SignOnAttempt:
    """Take a sign-on that this browser began, once; one that waits for a code of the second factor may go on.

    Raises SignOnFailed.
    """
    rows = SignOnAttempt.objects.select_related("link_to", "invitation")
    row = rows.filter(state_hash=_hash(begun.state), provider=provider.name).first()
    if row is None:
        raise SignOnFailed("unknown", provider.title)
    if not hmac.compare_digest(row.browser_hash, _hash(begun.browser)):
        raise SignOnFailed("browser", provider.title)
    if row.at <= now - LASTS:
        raise SignOnFailed("expired", provider.title)
    if row.identity is not None and row.done_at is None:
        return row
    if SignOnAttempt.objects.filter(pk=row.pk, used_at=None).update(used_at=now) != 1:
        raise SignOnFailed("replayed", provider.title)
    return row


def keep_identity(row: SignOnAttempt, identity: Identity) -> None:
    """Keep what the provider has proved, until the code of the second factor is there."""
    SignOnAttempt.objects.filter(pk=row.pk).update(identity=asdict(identity))


def kept_identity(row: SignOnAttempt) -> Identity | None:
    """Return what the provider has proved before, if anything."""
    return Identity(**row.identity) if row.identity else None


def end_attempt(row: SignOnAttempt, provider: Provider, now: datetime) -> None:
    """Let it be used no more, just before somebody comes in by it. Raises SignOnFailed (replayed)."""
    if SignOnAttempt.objects.filter(pk=row.pk, done_at=None).update(done_at=now, identity=None) != 1:
        raise SignOnFailed("replayed", provider.title)


def forget_sign_ons(*, now: datetime) -> int:
    """Remove sign-ons that are long over; returns how many."""
    return SignOnAttempt.objects.filter(at__lte=now - max(KEPT, WINDOW)).delete()[0]


def _derive(begun: Begun, what: str) -> str:
    digest = hmac.digest(begun.browser.encode(), f"vipo sign-on {what} {begun.state}".encode(), "sha256")
    return base64.urlsafe_b64encode(digest).decode().rstrip("=")


def _hash(text: str) -> str:
    return hashlib.sha256(text.encode(errors="replace")).hexdigest()
