"""Tokens by which programs ask as a person at one site: made, told once, kept as hashes, listed, revoked."""

from __future__ import annotations

import hashlib
import hmac
import secrets
from collections.abc import Collection
from dataclasses import dataclass
from datetime import datetime, timedelta

from django.db import transaction
from django.db.models import Q, QuerySet

from registry.audit.record import note_act
from registry.errors import RegistryError
from registry.live.fanout import publish
from registry.models import ApiToken, Membership, User
from registry.models.people import Grant
from registry.people.access import ROLES, SCOPES, FactorDemanded, NotAllowed, NotAMember, access_of, has_not_ended
from registry.people.demanded_factor import is_held_back, is_vouched_for
from vipo_device.protocol.credentials import broker_hash
from vipo_device.protocol.topics import reader_name

MARK = "vipo"
MOST_OF_MEMBER = 20
MOST_LISTED = 1000
MOST_DAYS = 366
MOST_NAME = 100
USE_NOTED_EVERY = timedelta(minutes=1)
KEPT_EXPIRED = timedelta(days=30)
BROKER = "broker"
"""The scope that lets a token in at the MQTT broker, too; it goes with `read` alone and says nothing of roles."""
_LEAST_ROLE = {"read": "viewer", "operate": "viewer", "run": "commenter", "admin": "admin", BROKER: "viewer"}
"""Who may give a token which scope; viewers operate nothing but the stop, and commenters' programs write comments."""


class InvalidToken(RegistryError):
    """A token that is none, or none any more; which of these is not said (RFC 6750)."""

    code = "invalid_token"
    status = 401


class BadToken(RegistryError):
    """A token that cannot be made so."""

    code = "bad_token"
    status = 422


class TooManyTokens(RegistryError):
    """The person has as many tokens at the site as they may."""

    code = "too_many_tokens"
    status = 409


class NoSuchToken(RegistryError):
    """There is no such token, or it is another person's."""

    code = "not_found"
    status = 404


_ABSENT = "There is no such token here. It may have been revoked already."


@dataclass(frozen=True, slots=True)
class TokenView:
    """A token without its secret; `id` is the public part of it."""

    id: str
    site: str
    site_id: int
    name: str
    scopes: tuple[str, ...]
    person_id: int
    person: str
    email: str
    created_at: datetime
    expires_at: datetime
    last_used_at: datetime | None

    @property
    def opens_broker(self) -> bool:
        """Whether the broker lets somebody in by it."""
        return BROKER in self.scopes


@dataclass(frozen=True, slots=True)
class Reader:
    """Whom the broker lets in by a token: the user name there, the site, and what Mosquitto keeps of the token."""

    name: str
    site: str
    broker_hash: str


def keep_token(
    *, user: User, site: str, name: str, scopes: Collection[str], days: int, now: datetime
) -> tuple[TokenView, str]:
    """Keep a new token of a member; return it, and its text, which nobody can be told again.

    One for the broker opens that once it has the account. Raises NotAMember, NotAllowed, BadToken, TooManyTokens.
    """
    name = " ".join(name.split())
    if not 0 < len(name) <= MOST_NAME or not name.isprintable():
        raise BadToken(f"A token needs a name of 1 to {MOST_NAME} characters that says what it is for.")
    if not 1 <= days <= MOST_DAYS:
        raise BadToken(f"A token lasts 1 to {MOST_DAYS} days, not {days}.")
    public_id, secret = secrets.token_hex(8), secrets.token_urlsafe(32)
    text = f"{MARK}_{public_id}_{secret}"
    with transaction.atomic():
        member = _lock_member(user, site)
        _check_scopes(scopes, member.role)
        if is_held_back(user, member) and not {"read", BROKER} >= set(scopes):
            raise FactorDemanded(
                f"This site demands a second factor of the role {member.role}, and so of who makes such a token. Set "
                "one up on the page of your account."
            )
        if member.tokens.filter(expires_at__gt=now).count() >= MOST_OF_MEMBER:
            raise TooManyTokens(f"You have {MOST_OF_MEMBER} tokens at this site. Revoke one that is no longer used.")
        row = ApiToken.objects.create(
            membership=member,
            public_id=public_id,
            secret_hash=_hash(secret),
            name=name,
            scopes=" ".join(scope for scope in SCOPES if scope in scopes) or "read",
            created_at=now,
            expires_at=now + timedelta(days=days),
            broker_hash=broker_hash(text) if BROKER in scopes else "",
        )
        note_act(
            site_id=member.site_id, code="token_made", facts={"name": name, "scopes": sorted(scopes), "days": days}
        )
    return _view(row), text


def _lock_member(user: User, site: str) -> Membership:
    rows = Membership.objects.select_for_update(of=("self",)).select_related("site", "user")
    member = rows.filter(has_not_ended(), user_id=user.pk, user__is_active=True, site__slug=site).first()
    if member is None:
        raise NotAMember("There is no such site, or you are not one of its members. Ask its admin to add you.")
    return member


def _check_scopes(scopes: Collection[str], role: str) -> None:
    if not scopes or not set(scopes) <= _LEAST_ROLE.keys():
        raise BadToken(f"A token has one or more of the scopes {', '.join(_LEAST_ROLE)}.")
    if BROKER in scopes and not set(scopes) <= {"read", BROKER}:
        raise BadToken("A token that opens the broker is for read alone. Make another one for what else is to be done.")
    for scope in scopes:
        if ROLES.index(role) < ROLES.index(_LEAST_ROLE[scope]):
            raise NotAllowed(f"You are {role} of this site; a token for {scope} needs the role {_LEAST_ROLE[scope]}.")


def find_member(*, site: str, email: str) -> User:
    """Return a member of a site by their address, as their provider vouched for them last. Raises NotAMember."""
    members = Membership.objects.filter(site__slug=site, user__email=email.strip().lower()).select_related("user")
    member = members.first()
    if member is None:
        raise NotAMember(
            f"{email[:100]} is no member of {site[:64]!r}. Try: vipo account EMAIL --site SITE --role ROLE"
        )
    member.user.has_two_factors = is_vouched_for(member.user)
    return member.user


def list_tokens(*, site: str, user: User | None = None) -> tuple[TokenView, ...]:
    """Return the tokens of a site, or of one of its members, the newest first; also those that have expired."""
    rows = _rows().filter(membership__site__slug=site)
    if user is not None:
        rows = rows.filter(membership__user_id=user.pk)
    return tuple(_view(row) for row in rows.order_by("-created_at", "-id")[:MOST_LISTED])


def find_token(*, token_id: str, site: str = "", user: User | None = None) -> TokenView:
    """Return a token, of one site or person only, if named. Raises NoSuchToken."""
    rows = _rows().filter(public_id=token_id.replace("\0", ""))
    if site:
        rows = rows.filter(membership__site__slug=site)
    row = (rows if user is None else rows.filter(membership__user_id=user.pk)).first()
    if row is None:
        raise NoSuchToken(_ABSENT)
    return _view(row)


def drop_token(*, token_id: str, site: str = "", user: User | None = None) -> TokenView:
    """End a token at once, with the streams opened by it; of one site or person only, if named. Raises NoSuchToken."""
    view = find_token(token_id=token_id, site=site, user=user)
    with transaction.atomic():
        if not ApiToken.objects.filter(public_id=view.id).delete()[0]:
            raise NoSuchToken(_ABSENT)
        _tell_end(view)
    return view


def drop_all_tokens(*, user: User, now: datetime) -> tuple[TokenView, ...]:
    """End all tokens of a person that have not expired, at all sites, as `drop_token` does; return them."""
    with transaction.atomic():
        rows = _rows().select_for_update(of=("self",)).filter(membership__user_id=user.pk, expires_at__gt=now)
        views = tuple(_view(row) for row in rows.order_by("pk"))
        ApiToken.objects.filter(public_id__in=[view.id for view in views]).delete()
        for view in views:
            _tell_end(view, by=view.person)
    return views


def end_without_access(*, token_id: str, now: datetime) -> bool:
    """End a token whose person may not come in at the moment, though it has not expired; False if they may.

    Its account at the broker goes, and cannot come back if they may again: nobody knows its secret but its owner.
    """
    with transaction.atomic():
        row = ApiToken.objects.select_for_update().filter(public_id=token_id, expires_at__gt=now).first()
        if row is None:
            return True
        if _standing(now).filter(pk=row.pk).exists():
            return False
        (view,) = map(_view, _rows().filter(pk=row.pk))
        row.delete()
        _tell_end(view)
    return True


def _tell_end(view: TokenView, *, by: str = "") -> None:
    """Write into the record that a token has ended, and have what was opened by it end, too."""
    note_act(site_id=view.site_id, code="token_revoked", facts={"name": view.name, "person": view.person}, by=by)
    transaction.on_commit(lambda: publish(view.site, {"type": "members"}))


def find_bearer(*, token: str, now: datetime) -> User:
    """Return the person whose token this is, who has no more rights than it grants. Raises InvalidToken."""
    row = _find_row(token, now)
    if row is None:
        raise InvalidToken("This token is not valid: it has ended, was revoked, or never was one. Make another one.")
    _note_use(row, now)
    return _person(row)


def _find_row(token: str, now: datetime) -> ApiToken | None:
    mark, _, rest = token.partition("_")
    public_id, _, secret = rest.partition("_")
    looks_like_one = mark == MARK and len(token) < 100 and token.isascii() and token.isprintable()
    row = _standing(now).filter(public_id=public_id).first() if looks_like_one else None
    is_right = hmac.compare_digest(_hash(secret), row.secret_hash if row else _hash(""))
    return row if is_right else None


def find_reader(*, username: str, password: str, now: datetime) -> Reader | None:
    """Return whom the broker lets in by this user name and token; None for nobody."""
    row = _find_row(password, now)
    if row is None or not row.broker_hash or reader_name(row.public_id) != username:
        return None
    _note_use(row, now)
    return _reader(row)


def list_readers(*, now: datetime) -> tuple[Reader, ...]:
    """Return all tokens that open the broker at this moment."""
    return tuple(_reader(row) for row in _standing(now).exclude(broker_hash=""))


def stands_locked(*, token_id: str) -> bool:
    """Tell whether nobody has revoked a token, and let nobody do so before the transaction ends."""
    return ApiToken.objects.select_for_update().filter(public_id=token_id).first() is not None


def _reader(row: ApiToken) -> Reader:
    return Reader(reader_name(row.public_id), row.membership.site.slug, row.broker_hash)


def read_standing_roles(*, token_ids: Collection[int], now: datetime) -> dict[int, dict[str, str]]:
    """Return what tokens that were shown before are good for: role by site; those that have ended are left out."""
    roles = {}
    for row in _standing(now).filter(pk__in=token_ids):
        access = access_of(_person(row), row.membership)
        roles[row.pk] = {access.site: access.role}
    return roles


def prune_tokens(*, now: datetime) -> int:
    """Forget those that ended long ago; returns how many."""
    return ApiToken.objects.filter(expires_at__lt=now - KEPT_EXPIRED).delete()[0]


def _rows() -> QuerySet[ApiToken]:
    return ApiToken.objects.select_related("membership__user", "membership__site")


def _standing(now: datetime) -> QuerySet[ApiToken]:
    standing = has_not_ended("membership__")
    return _rows().filter(standing, expires_at__gt=now, membership__user__is_active=True)


def _note_use(row: ApiToken, now: datetime) -> None:
    """Keep when a token was used, to the minute: a program that asks often costs no write each time."""
    noted = Q(last_used_at=None) | Q(last_used_at__lt=now - USE_NOTED_EVERY)
    if row.last_used_at is None or row.last_used_at < now - USE_NOTED_EVERY:
        ApiToken.objects.filter(noted, pk=row.pk).update(last_used_at=now)


def _person(row: ApiToken) -> User:
    person = row.membership.user
    person.grant = Grant(row.pk, row.membership.site_id, frozenset(row.scopes.split()))
    return person


def _hash(secret: str) -> str:
    return hashlib.sha256(secret.encode()).hexdigest()


def _view(row: ApiToken) -> TokenView:
    member = row.membership
    return TokenView(
        id=row.public_id,
        site=member.site.slug,
        site_id=member.site_id,
        name=row.name,
        scopes=(*row.scopes.split(), *((BROKER,) if row.broker_hash else ())),
        person_id=member.user_id,
        person=member.user.display_name,
        email=member.user.email,
        created_at=row.created_at,
        expires_at=row.expires_at,
        last_used_at=row.last_used_at,
    )
