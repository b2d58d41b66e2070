"""Who comes by single sign-on: the person that an account of a provider is linked with, or one who may come anew.

An address alone never lets anybody in: it links an account or makes one only where the provider has verified it and the
server's settings allow that. docs/adr/0070 has the reasons.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from datetime import datetime
from typing import cast

from django.db import transaction
from django.db.models import F

from registry.broker.accounts import close_readers
from registry.models import SignOnAttempt, User
from registry.people.second_factor import SecondFactorNeeded, check_code, has_factor
from registry.people.sign_in import BadPerson, create_person
from registry.people.sign_on.attempts import (
    Begun,
    Purpose,
    begin_attempt,
    end_attempt,
    keep_identity,
    kept_identity,
    take_attempt,
)
from registry.people.sign_on.bindings import find_linked, link, note_person, note_use, unlink_others
from registry.people.sign_on.provider_client import begin_address, check_sender, exchange
from registry.people.sign_on.providers import Identity, Provider, SignOnFailed
from registry.people.throttle import Attempt, counted, network_of
from registry.people.tokens import drop_all_tokens
from registry.people.wall_screens import revoke_walls_of
from registry.sites.invitations import find_open_link, revoke_invitations_of, take_in

log = logging.getLogger(__name__)
_NO_GUESSES = frozenset({"down", "clock"})
"""What nobody can bring about by what they send: all else is counted, and held up after some."""


@dataclass(frozen=True, slots=True)
class Answer:
    """What a browser has brought back from a provider, and what goes with it.

    `back` is the address that it came to, `factor` a code of the second factor, `who` the person of its session.
    """

    begun: Begun
    code: str
    error: str
    issuer: str
    back: str
    factor: str = ""
    who: User | None = None


@dataclass(frozen=True, slots=True)
class Arrival:
    """Who came, where they want to go, and what the provider has proved; `is_new_session`: they were not in before."""

    user: User
    next: str
    identity: Identity
    is_new_session: bool


def begin_sign_on(
    *, provider: Provider, browser: str, purpose: Purpose, address: str, back: str, now: datetime
) -> tuple[str, Begun]:
    """Begin a sign-on; return where the browser goes, and what it keeps.

    Raises SignOnFailed (down), TooManyAttempts, UnknownLink, LinkOver.
    """
    if purpose.link_code:
        purpose = replace(purpose, invitation=find_open_link(code=purpose.link_code, address=address, now=now))
    begun = begin_attempt(provider=provider, browser=browser, purpose=purpose, address=address, now=now)
    with _telling(purpose.link_to, provider):
        told = {"state": begun.state, "nonce": begun.nonce, "verifier": begun.verifier}
        return begin_address(provider, back=back, **told), begun


def finish_sign_on(
    *, provider: Provider, answer: Answer, address: str, device_of: Callable[[str], str], now: datetime
) -> Arrival:
    """Let in whom a provider has proved, or link them; `device_of` tells by what a person's browser is known.

    Raises SignOnFailed, SecondFactorNeeded, WrongCode, TooManyAttempts, LinkOver.
    """
    with _telling(answer.who, provider):
        row, identity = _prove(provider, answer, address, now)
        if row.link_to is not None:
            return _link_own(row, provider, identity, answer.who, now)
    found = find_linked(identity)
    with _telling(found, provider):
        known = found or _find_by_address(provider, identity)
        if known is not None and not known.is_active:
            raise SignOnFailed("closed", provider.title)
        if known is not None and has_factor(user=known) and not (found and identity.has_factor):
            keep_identity(row, identity)
            _ask_factor(known, answer.factor, Attempt(known.email, address, device_of(known.email)), now)
        with transaction.atomic():
            end_attempt(row, provider, now)
            user = known or _make_account(row, provider, identity, now)
            if found is None:
                _link_by_address(user, provider, identity, now, is_known=known is not None)
            note_use(identity=identity, now=now)
            return Arrival(user, _come_in(row, user, now) or row.next, identity, True)


def _prove(provider: Provider, answer: Answer, address: str, now: datetime) -> tuple[SignOnAttempt, Identity]:
    """Take the sign-on and ask the provider who it is. What fails is counted for its network."""
    failed: SignOnFailed | None = None
    with counted(Attempt(f"sign-on:{network_of(address)}", address), now, "sign_on"):
        try:
            row = take_attempt(provider=provider, begun=answer.begun, now=now)
            identity = kept_identity(row) or _ask(provider, answer)
        except SignOnFailed as error:
            if error.why not in _NO_GUESSES:
                raise
            failed = error
    if failed is not None:
        raise failed
    return row, identity


def _ask(provider: Provider, answer: Answer) -> Identity:
    check_sender(provider, answer.issuer)
    if answer.error:
        raise SignOnFailed("denied" if answer.error == "access_denied" else "refused", provider.title, answer.error)
    begun = answer.begun
    return exchange(provider, code=answer.code, nonce=begun.nonce, verifier=begun.verifier, back=answer.back)


def _find_by_address(provider: Provider, identity: Identity) -> User | None:
    """Return whose verified address it is, if that may link an account. Raises SignOnFailed (address)."""
    if not identity.email or not identity.is_verified:
        return None
    known = User.objects.filter(email=identity.email).first()
    if known is not None and not (provider.links_by_email and _is_of_domains(provider, identity)):
        raise SignOnFailed("address", provider.title)
    return known


def _is_of_domains(provider: Provider, identity: Identity) -> bool:
    """Tell whether an address is of the provider's mail domains, where the settings name some."""
    return not provider.domains or identity.email.rpartition("@")[2] in provider.domains


def _ask_factor(user: User, code: str, attempt: Attempt, now: datetime) -> None:
    """Ask for a code of the second factor, counted as codes beside passwords are."""
    if not code.strip():
        raise SecondFactorNeeded("You are known. Now send the code of your authenticator app, too.")
    with counted(attempt, now):
        check_code(user=user, code=code, now=now)


def _make_account(row: SignOnAttempt, provider: Provider, identity: Identity, now: datetime) -> User:
    """Make an account for who was invited, or has an address of a domain that may come. Raises SignOnFailed."""
    may_come = bool(provider.domains) and _is_of_domains(provider, identity)
    if row.invitation is None and not may_come:
        raise SignOnFailed("nobody", provider.title)
    if not identity.is_verified:
        raise SignOnFailed("unverified", provider.title)
    name = identity.name.strip() or identity.email.partition("@")[0]
    try:
        user = create_person(email=identity.email, display_name=name[:100])
    except BadPerson as error:
        raise SignOnFailed("unverified", provider.title) from error
    note_person(user, "sign_on_account_made", provider.title)
    return user


def _link_by_address(user: User, provider: Provider, identity: Identity, now: datetime, *, is_known: bool) -> None:
    """Link an account by its address; nobody had proved before that the address is theirs, so all others leave it."""
    if is_known:
        _turn_all_out(user, identity, now)
    link(user=user, provider=provider, identity=identity, now=now)


def _turn_all_out(user: User, identity: Identity, now: datetime) -> None:
    """End what opens a person's account or was given in their name. A second factor was asked for.

    That is the password, sessions, tokens, links with other providers, open invitations, and wall screens.
    """
    user.set_unusable_password()
    user.save(update_fields=["password"])
    User.objects.filter(pk=user.pk).update(session_generation=F("session_generation") + 1)
    user.refresh_from_db(fields=["session_generation"])
    revoke_walls_of(user=user, now=now)
    unlink_others(user=user, issuer=identity.issuer)
    revoke_invitations_of(user=user, now=now)
    readers = [token.id for token in drop_all_tokens(user=user, now=now) if token.opens_broker]
    transaction.on_commit(lambda: close_readers(readers))


def _come_in(row: SignOnAttempt, user: User, now: datetime) -> str:
    """Make somebody a member by the link that they came by; return the page to go to, empty without one."""
    if row.invitation is None:
        return ""
    return f"/sites/{take_in(invitation=row.invitation, user=user, now=now)}/programs"


def _link_own(row: SignOnAttempt, provider: Provider, identity: Identity, who: User | None, now: datetime) -> Arrival:
    """Link an account with who is signed in, if it is they who began this."""
    user = cast("User", row.link_to)
    if who is None or who.pk != user.pk:
        raise SignOnFailed("signed_out", provider.title)
    with transaction.atomic():
        end_attempt(row, provider, now)
        link(user=user, provider=provider, identity=identity, now=now)
    return Arrival(user, row.next, identity, False)


@contextmanager
def _telling(person: User | None, provider: Provider) -> Iterator[None]:
    """Write of a sign-on that fails into the record, and what the provider said into the server's log."""
    try:
        yield
    except SignOnFailed as error:
        log.warning("A sign-on by %s failed (%s): %s", provider.name, error.why, error.log or error.detail)
        note_person(person, "sign_on_refused", provider.title, error.why)
        raise
