"""How often a password may be tried: each attempt is counted before it is looked at, so that none is tried unseen.

A browser from which somebody has signed in before is counted for itself: whoever guesses elsewhere does not keep them
out. docs/adr/0015 has the reasons.
"""

from __future__ import annotations

import ipaddress
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import datetime, timedelta
from math import ceil
from typing import Literal

from django.db.models import QuerySet

from registry.audit.actor import Actor, who_acts
from registry.audit.record import note_act
from registry.errors import RegistryError
from registry.models import AuditLine, Membership, SignInFailure

WINDOW = timedelta(minutes=15)
Tried = Literal["wait", "link", "sign_on"]
"""What is tried: a password, the link of an invitation, or the answer of a provider."""
_TRIED: dict[Tried, str] = {
    "wait": "Too many sign-ins failed.",
    "link": "Too many invalid links were tried from here.",
    "sign_on": "Too many invalid sign-ons were tried from here.",
}
MOST_FOR_PAIR, MOST_FOR_EMAIL, MOST_FOR_ADDRESS = 8, 50, 200


class TooManyAttempts(RegistryError):
    """Too many sign-ins failed within a short time."""

    code = "too_many_attempts"
    status = 429


@dataclass(frozen=True, slots=True)
class Attempt:
    """Somebody who tries a password; `device` is a browser that is known to be this person's, or empty."""

    email: str
    address: str
    device: str = ""


def network_of(address: str) -> str:
    """Return what an address is counted as: IPv4 as it is, IPv6 as its /64, of which one customer has all."""
    try:
        parsed = ipaddress.ip_address(address.partition("%")[0])
    except ValueError:
        return address[:64]
    if isinstance(parsed, ipaddress.IPv6Address):
        mapped = parsed.ipv4_mapped
        return str(mapped or ipaddress.ip_network((parsed, 64), strict=False))
    return str(parsed)


@contextmanager
def counted(attempt: Attempt, now: datetime, what: Tried = "wait") -> Iterator[None]:
    """Count an attempt, then let it be made; it is forgotten, with those before it, if the block ends well.

    Of any number at once no more are let through than one after the other. Raises TooManyAttempts.
    """
    address = network_of(attempt.address)
    row = SignInFailure.objects.create(email=attempt.email, address=address, device=attempt.device, at=now)
    wait_s = _wait_s(attempt, address, now)
    if wait_s:
        row.delete()
        if what == "wait":
            _note_locked(attempt.email, now)
        raise TooManyAttempts(
            f"{_TRIED[what]} Try again in {ceil(wait_s / 60)} min.",
            {"why": what, "minutes": ceil(wait_s / 60), "retry_after_s": wait_s},
        )
    yield
    _same(attempt, address).delete()


def _note_locked(email: str, now: datetime) -> None:
    """Tell the sites of somebody that guessing their password is held up; once while it lasts."""
    members = Membership.objects.filter(user__email=email).select_related("user")
    for member in members:
        lines = AuditLine.objects.filter(site_id=member.site_id, code="sign_in_locked", at__gt=now - WINDOW)
        if not lines.filter(person_id=member.user_id).exists():
            address = who_acts().address
            who = Actor("vipo", person=member.user_id, address=address)
            minutes = round(WINDOW.total_seconds() / 60)
            note_act(
                site_id=member.site_id,
                code="sign_in_locked",
                actor=who,
                at=now,
                facts={"person": member.user.display_name, "minutes": minutes},
            )


def _same(attempt: Attempt, address: str) -> QuerySet[SignInFailure]:
    """Return the attempts of this browser, or at this address where the browser is not known."""
    rows = SignInFailure.objects.filter(email=attempt.email, device=attempt.device)
    return rows if attempt.device else rows.filter(address=address)


def _wait_s(attempt: Attempt, address: str, now: datetime) -> int:
    """Return in how many seconds there is room for this attempt; 0 where there is."""
    recent = SignInFailure.objects.filter(device=attempt.device, at__gt=now - WINDOW)
    if attempt.device:
        limits = [(recent.filter(email=attempt.email), MOST_FOR_PAIR)]
    else:
        limits = [
            (recent.filter(email=attempt.email, address=address), MOST_FOR_PAIR),
            (recent.filter(email=attempt.email), MOST_FOR_EMAIL),
            (recent.filter(address=address), MOST_FOR_ADDRESS),
        ]
    return max(_until_room_s(rows, most, now) for rows, most in limits)


def _until_room_s(rows: QuerySet[SignInFailure], most: int, now: datetime) -> int:
    """Return when the oldest of more than `most` rows are forgotten."""
    latest = list(rows.order_by("-at", "-id").values_list("at", flat=True)[: most + 1])
    return max(1, ceil((latest[most] + WINDOW - now).total_seconds())) if len(latest) > most else 0


def forget_attempts(*, now: datetime) -> int:
    """Remove the attempts that count no more; returns how many."""
    return SignInFailure.objects.filter(at__lte=now - WINDOW).delete()[0]
