"""Sessions of browsers and programs, and tokens: whose they are, and what they are good for at this moment."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from django.contrib.auth import BACKEND_SESSION_KEY, HASH_SESSION_KEY, SESSION_KEY
from django.contrib.sessions.backends.db import SessionStore
from django.contrib.sessions.models import Session as KeptSession
from django.http import HttpRequest
from django.utils import timezone
from django.utils.crypto import constant_time_compare

from registry.models import User
from registry.people.access import allows
from registry.people.backends import TWO_FACTORS
from registry.people.demanded_factor import role_until_then
from registry.people.tokens import read_standing_roles
from registry.people.wall_screens import read_standing_sites


@dataclass(frozen=True, slots=True)
class Session:
    """A browser's or program's session, by its key and the id of the person who signed in.

    Or a token's, or a wall screen's, by its row; a wall screen has no person.
    """

    key: str
    person: int
    token: int = 0
    wall: int = 0


@dataclass(frozen=True, slots=True)
class Standing:
    """What a session that stands is good for: the roles of its person, by the slugs of their sites.

    A wall screen has no role anywhere; it shows the site `shows`, and no person's session does.
    """

    roles: Mapping[str, str]
    shows: str = ""

    def allows(self, site: str, role: str) -> bool:
        """Tell whether the person has this role at the site, or one that includes it."""
        return site in self.roles and allows(self.roles[site], role)


def session_of(request: HttpRequest) -> Session:
    """Return the session of a request that is signed in, or comes with a token."""
    user = request.user
    if isinstance(user, User) and user.grant:
        return Session("", user.pk, user.grant.token_id)
    return Session(request.session.session_key or "", int(request.session[SESSION_KEY]))


def session_of_socket(scope: Mapping[str, Any]) -> Session | None:
    """Return the session of a socket that is signed in; None where the socket came in without one."""
    key = scope["session"].session_key if "session" in scope else None
    return Session(key, scope["user"].pk) if key and scope["user"].is_authenticated else None


def read_standings(sessions: Collection[Session]) -> dict[Session, Standing]:
    """Return the standing of each session that stands, by two statements for all of them, and one for all tokens.

    One more is for all wall screens.

    One that has ended is left out: signed out, expired, revoked, another password, or an account that is closed.
    """
    walls = [session for session in sessions if session.wall]
    tokens = [session for session in sessions if session.token]
    cookies = [session for session in sessions if not session.token and not session.wall]
    return {**_read_cookies(cookies), **_read_tokens(tokens), **_read_walls(walls)}


def _read_walls(sessions: Collection[Session]) -> dict[Session, Standing]:
    if not sessions:
        return {}
    sites = read_standing_sites(walls={session.wall for session in sessions}, now=timezone.now())
    return {session: Standing({}, sites[session.wall]) for session in sessions if session.wall in sites}


def _read_tokens(sessions: Collection[Session]) -> dict[Session, Standing]:
    if not sessions:
        return {}
    roles = read_standing_roles(token_ids={session.token for session in sessions}, now=timezone.now())
    return {session: Standing(roles[session.token]) for session in sessions if session.token in roles}


def _read_cookies(sessions: Collection[Session]) -> dict[Session, Standing]:
    if not sessions:
        return {}
    texts = dict(
        KeptSession.objects.filter(
            session_key__in={session.key for session in sessions}, expire_date__gt=timezone.now()
        ).values_list("session_key", "session_data")
    )
    rows = User.objects.filter(pk__in={session.person for session in sessions}, is_active=True)
    people: dict[int, User] = {}
    roles: defaultdict[int, dict[str, str]] = defaultdict(dict)
    now = timezone.now()
    demands: defaultdict[int, dict[str, str]] = defaultdict(dict)
    protected = set()
    for person, password, generation, factor_at, site, role, ends_at, demanded in rows.values_list(
        *("pk", "password", "session_generation", "second_factor__confirmed_at"),
        *("memberships__site__slug", "memberships__role", "memberships__ends_at"),
        "memberships__site__second_factor_from",
    ):
        people[person] = User(pk=person, password=password, session_generation=generation)
        if factor_at is not None:
            protected.add(person)
        if site is not None and (ends_at is None or ends_at > now):
            roles[person][site], demands[person][site] = role, demanded

    def roles_of(session: Session) -> dict[str, str]:
        has_factor = session.person in protected or _decode(texts[session.key])[2] == TWO_FACTORS
        return {
            site: role_until_then(demands[session.person][site], role, has_factor=has_factor)
            for site, role in roles[session.person].items()
        }

    return {
        session: Standing(roles_of(session))
        for session in sessions
        if session.person in people and session.key in texts and _is_of(texts[session.key], people[session.person])
    }


def _is_of(text: str, person: User) -> bool:
    """Tell whether a kept session is this person's, begun with the password that they have now."""
    signed_in, proof, _ = _decode(text)
    proofs = (person.get_session_auth_hash(), *person.get_session_auth_fallback_hash())
    return signed_in == str(person.pk) and any(constant_time_compare(proof, known) for known in proofs)


@lru_cache(maxsize=4096)
def _decode(text: str) -> tuple[str, str, str]:
    kept = SessionStore().decode(text)
    person, proof, backend = (str(kept.get(key, "")) for key in (SESSION_KEY, HASH_SESSION_KEY, BACKEND_SESSION_KEY))
    return person, proof, backend
