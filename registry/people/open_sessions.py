"""A person's own sessions, as they see them: when each began, when it last asked for something, and from what browser.

Django keeps sessions by their keys alone; beside each that is in use stands a row that says whose it is.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from datetime import datetime, timedelta

from django.contrib.sessions.models import Session as KeptSession
from django.db import transaction

from registry.bounds.pagination import FIRST, Listed, Page, take_page
from registry.errors import RegistryError
from registry.live.fanout import EVERY_SITE, publish
from registry.models import OpenSession, User
from registry.people.sessions import Session, read_standings

NOTED_EVERY = timedelta(minutes=1)
MOST_REMEMBERED = 10_000
_noted: dict[str, datetime] = {}
"""When this process last wrote of a session that it was in use."""
_BROWSERS = (
    ("Edge", r"Edg(?:A|iOS)?/"), ("Opera", r"OPR/|Opera"), ("Samsung Internet", r"SamsungBrowser/"),
    ("Firefox", r"Firefox/|FxiOS/"), ("Chromium", r"Chromium/"), ("Chrome", r"Chrome/|CriOS/"), ("Safari", r"Safari/"),
)  # fmt: skip
"""In this order: most browsers name those before them, too."""
_SYSTEMS = (
    ("Android", r"Android"), ("iPhone", r"iPhone"), ("iPad", r"iPad"), ("Windows", r"Windows"),
    ("macOS", r"Macintosh|Mac OS X"), ("ChromeOS", r"CrOS"), ("Linux", r"Linux|X11"),
)  # fmt: skip
_PRODUCT = re.compile(r"[A-Za-z][A-Za-z0-9._-]{0,39}")


class NoSuchSession(RegistryError):
    """The session has ended, or is somebody else's."""

    code = "not_found"
    status = 404


@dataclass(frozen=True, slots=True)
class OpenSessionView:
    """A session without its key; `browser` and `system` may be empty."""

    id: int
    key: str
    browser: str
    system: str
    begun_at: datetime
    seen_at: datetime


def name_browser(agent: str) -> tuple[str, str]:
    """Return what a header User-Agent says in plain words: the browser or program, and the system it runs on."""
    browser = next((name for name, pattern in _BROWSERS if re.search(pattern, agent)), "")
    system = next((name for name, pattern in _SYSTEMS if re.search(pattern, agent)), "")
    product = _PRODUCT.match(agent)
    if not browser and product and product[0] != "Mozilla":
        browser = product[0]
    return browser, system


def note_session(*, key: str, user: User, agent: str, now: datetime) -> None:
    """Keep that a session is in use, to the minute: a page that asks often costs no write each time."""
    if key in _noted and now - _noted[key] < NOTED_EVERY:
        return
    browser, system = name_browser(agent[:1000])
    known = {"user": user, "browser": browser, "system": system, "seen_at": now}
    OpenSession.objects.update_or_create(key=key, defaults=known, create_defaults={**known, "begun_at": now})
    if len(_noted) >= MOST_REMEMBERED:
        _noted.clear()
    _noted[key] = now


def list_open_sessions(*, user: User, page: Page = FIRST) -> Listed[OpenSessionView]:
    """Return a person's sessions that stand, the one that began last first; a page may have fewer. Raises BadMark."""
    found = take_page(rows=OpenSession.objects.filter(user=user), by="-begun_at", page=page, view=_view)
    standing = read_standings([Session(view.key, user.pk) for view in found])
    listed = Listed(view for view in found if Session(view.key, user.pk) in standing)
    listed.rest = found.rest
    return listed


def end_session(*, user: User, session_id: int) -> None:
    """End one of a person's sessions; its sockets and streams close within seconds. Raises NoSuchSession."""
    with transaction.atomic():
        row = OpenSession.objects.filter(user=user, pk=session_id).first()
        if row is None:
            raise NoSuchSession("You have no such session. It may have ended already.")
        KeptSession.objects.filter(session_key=row.key).delete()
        row.delete()
        transaction.on_commit(lambda: publish(EVERY_SITE, {"type": "members"}))


def follow_session(*, old: str, new: str) -> None:
    """Say that a session goes on under another key."""
    OpenSession.objects.filter(key=old).update(key=new)


def drop_expired(*, now: datetime) -> int:
    """Remove the sessions that have expired, with what stands beside them; returns how many."""
    dropped = KeptSession.objects.filter(expire_date__lt=now).delete()[0]
    OpenSession.objects.exclude(key__in=KeptSession.objects.values("session_key")).delete()
    return dropped


def _view(row: OpenSession) -> OpenSessionView:
    return OpenSessionView(row.pk, row.key, row.browser, row.system, row.begun_at, row.seen_at)
