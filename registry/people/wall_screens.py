"""Wall screens: links by which a screen in a hall shows one site, read only and without names of people.

A link's code is told once. A browser exchanges it for a key, which is a hash of the code and goes into a cookie that no
script reads; what is kept is a hash of that key. So neither a cookie nor the database tells the link, and both end with
the row. docs/adr/0060 says why.
"""

from __future__ import annotations

import hashlib
import secrets
from collections.abc import Collection
from contextlib import suppress
from dataclasses import dataclass
from datetime import datetime, timedelta

from django.db import transaction
from django.db.models import Q

from registry.audit.record import note_act
from registry.errors import RegistryError
from registry.live.fanout import publish
from registry.models import Site, User, WallScreen
from registry.people.throttle import Attempt, counted, network_of

MOST_NAME = 100
MOST_DAYS = 3660
MOST_OF_SITE = 20
KEPT_EXPIRED = timedelta(days=30)
SEEN_NOTED_EVERY = timedelta(minutes=1)
COOKIE = "vipo_wall"
KEY_LENGTH = 64


class BadWallScreen(RegistryError):
    """A wall screen that cannot be made so."""

    code = "bad_wall_screen"
    status = 422


class TooManyWallScreens(RegistryError):
    """The site has as many wall screens as it may."""

    code = "too_many_wall_screens"
    status = 409


class NoSuchWallScreen(RegistryError):
    """There is no such wall screen at the site."""

    code = "not_found"
    status = 404


class UnknownWallLink(RegistryError):
    """A link that opens no wall screen; whether it ever did is not said."""

    code = "unknown_link"
    status = 404


@dataclass(frozen=True, slots=True)
class WallScreenView:
    """A wall screen without its link; `seen_at` is when it last showed the site, to the minute."""

    id: int
    name: str
    made_by: str
    made_at: datetime
    expires_at: datetime
    seen_at: datetime | None


@dataclass(frozen=True, slots=True)
class OpenedWall:
    """A wall screen that may show its site: its row, the site, and until when."""

    id: int
    site: str
    expires_at: datetime


def make_wall_screen(*, site: str, by: User, name: str, days: int, now: datetime) -> tuple[WallScreenView, str]:
    """Make a wall screen; return it, and the code of its link, which nobody can be told again.

    Raises BadWallScreen, TooManyWallScreens.
    """
    name = " ".join(name.split())
    if not 0 < len(name) <= MOST_NAME or not name.isprintable():
        raise BadWallScreen(f"A wall screen needs a name of 1 to {MOST_NAME} characters that says where it hangs.")
    if not 1 <= days <= MOST_DAYS:
        raise BadWallScreen(f"A wall screen lasts 1 to {MOST_DAYS} days, not {days}.")
    code = secrets.token_urlsafe(32)
    with transaction.atomic():
        row = Site.objects.select_for_update(no_key=True).get(slug=site)
        if WallScreen.objects.filter(site=row, expires_at__gt=now).count() >= MOST_OF_SITE:
            raise TooManyWallScreens(f"This site has {MOST_OF_SITE} wall screens. Turn off one that hangs no more.")
        made = WallScreen.objects.create(
            site=row,
            name=name,
            key_hash=_hash(key_of(code)),
            made_by=by,
            made_at=now,
            expires_at=now + timedelta(days=days),
        )
        note_act(site_id=row.pk, code="wall_screen_made", facts={"name": name, "days": days})
    return _view(made), code


def list_wall_screens(*, site: str) -> tuple[WallScreenView, ...]:
    """Return the wall screens of a site, the newest first; also those that have expired."""
    rows = WallScreen.objects.filter(site__slug=site).select_related("made_by")
    return tuple(_view(row) for row in rows.order_by("-made_at", "-pk")[:200])


def list_walls_of(*, site: str, user: User, now: datetime) -> tuple[str, ...]:
    """Return the names of the wall screens of a site that somebody made and that have not expired."""
    rows = WallScreen.objects.filter(site__slug=site, made_by=user, expires_at__gt=now)
    return tuple(rows.order_by("pk").values_list("name", flat=True))


def revoke_walls_of(*, user: User, now: datetime) -> None:
    """End all wall screens that were made in somebody's name, at all sites."""
    rows = WallScreen.objects.filter(made_by=user, expires_at__gt=now).order_by("pk")
    for site, wall in rows.values_list("site__slug", "pk"):
        with suppress(NoSuchWallScreen):  # an admin has just turned it off
            revoke_wall_screen(site=site, wall_screen=wall)


def revoke_wall_screen(*, site: str, wall_screen: int) -> None:
    """End a wall screen at once: whatever shows it goes dark. Raises NoSuchWallScreen."""
    with transaction.atomic():
        row = WallScreen.objects.select_for_update().filter(site__slug=site, pk=wall_screen).first()
        if row is None:
            raise NoSuchWallScreen("There is no such wall screen here. It may have been turned off already.")
        note_act(site_id=row.site_id, code="wall_screen_revoked", facts={"name": row.name})
        row.delete()
        transaction.on_commit(lambda: publish(site, {"type": "members"}))


def open_by_code(*, code: str, address: str, now: datetime) -> tuple[OpenedWall, str]:
    """Return what a link shows, and the key that its cookie holds. Raises UnknownWallLink, TooManyAttempts.

    Wrong codes are counted for the network that they come from, as those of invitations are.
    """
    network = network_of(address)
    with counted(Attempt(f"link:{network}", address), now, "link"):
        key = key_of(code)
        found = find_wall(key=key, now=now)
        if found is None:
            raise UnknownWallLink("This link shows no site, or none any more. Ask an admin for another one.")
        return found, key


def find_wall(*, key: str, now: datetime) -> OpenedWall | None:
    """Return what the key of a cookie shows now, None for nothing."""
    if len(key) != KEY_LENGTH or not key.isascii():
        return None
    row = WallScreen.objects.select_related("site").filter(key_hash=_hash(key), expires_at__gt=now).first()
    return OpenedWall(row.pk, row.site.slug, row.expires_at) if row else None


def read_standing_sites(*, walls: Collection[int], now: datetime) -> dict[int, str]:
    """Return which sites wall screens show that were opened before; those that have ended are left out."""
    rows = WallScreen.objects.filter(pk__in=walls, expires_at__gt=now)
    return dict(rows.values_list("pk", "site__slug"))


def note_wall_seen(*, wall: int, now: datetime) -> None:
    """Keep that a wall screen shows its site, to the minute."""
    due = Q(seen_at=None) | Q(seen_at__lt=now - SEEN_NOTED_EVERY)
    WallScreen.objects.filter(due, pk=wall).update(seen_at=now)


def prune_wall_screens(*, now: datetime) -> int:
    """Forget those that ended long ago; returns how many."""
    return WallScreen.objects.filter(expires_at__lt=now - KEPT_EXPIRED).delete()[0]


def key_of(code: str) -> str:
    """Return the key that a link's code is exchanged for."""
    return hashlib.sha256(f"wall:{code}".encode(errors="replace")).hexdigest()


def _hash(key: str) -> str:
    return hashlib.sha256(key.encode()).hexdigest()


def _view(row: WallScreen) -> WallScreenView:
    maker = row.made_by.display_name if row.made_by else ""
    return WallScreenView(row.pk, row.name, maker, row.made_at, row.expires_at, row.seen_at)
