"""Tokens with their accounts at the broker: no token is told before the broker has its account, none outlives it long.

A token ends in many ways, by whatever process: revoked, expired, its person no member any more. So the gateway looks
every second which of the accounts at the broker still stand for one (`end_readers`).
"""

from __future__ import annotations

from collections.abc import Collection
from datetime import datetime

from django.conf import settings
from django.db import transaction

from registry.broker.accounts import Account, accounts, close_readers
from registry.errors import RegistryError
from registry.models import User
from registry.people.tokens import (
    NoSuchToken,
    TokenView,
    drop_token,
    end_without_access,
    keep_token,
    list_readers,
    stands_locked,
)
from vipo_device.protocol.topics import is_reader, reader_name, things_prefix


def create_token(
    *, user: User, site: str, name: str, scopes: Collection[str], days: int, now: datetime
) -> tuple[TokenView, str]:
    """Make a token of a member; return it, and its text, which nobody can be told again.

    One with the scope `broker` is also the password of an account there that may hear the site's Things and say
    nothing. Raises NotAMember, NotAllowed, BadToken, TooManyTokens, BrokerAway.
    """
    view, text = keep_token(user=user, site=site, name=name, scopes=scopes, days=days, now=now)
    if view.opens_broker:
        try:
            _open_broker(view, text)
        except RegistryError:
            drop_token(token_id=view.id)
            raise
    return view, text


def _open_broker(view: TokenView, text: str) -> None:
    """Give the broker the account of a token that is kept already, so that whoever tidies accounts up knows it."""
    with transaction.atomic():
        if not stands_locked(token_id=view.id):
            raise NoSuchToken("This token was revoked while it was being made. Make another one.")
        accounts().put(Account(reader_name(view.id), text, site=view.site))


def revoke_token(*, token_id: str, site: str = "", user: User | None = None) -> TokenView:
    """End a token at once, with what was opened by it; of one site or person only, if named. Raises NoSuchToken."""
    view = drop_token(token_id=token_id, site=site, user=user)
    if view.opens_broker:
        close_readers([view.id])
    return view


def end_readers(*, known: frozenset[str] | None, now: datetime) -> frozenset[str]:
    """Take away from the broker the accounts of tokens that have ended; return those that it has now.

    A token whose person may come in no more ends with its account, for good, and the site's record says so: if they may
    again, nobody could give the broker its account back. `known` are those that it had when this was last asked, None
    to ask the broker for them. Raises BrokerAway.
    """
    if known is None:
        known = frozenset(filter(is_reader, accounts().names() or ()))
    standing = frozenset(reader.name for reader in list_readers(now=now))
    ended = {
        name for name in known - standing if end_without_access(token_id=name.removeprefix(reader_name("")), now=now)
    }
    for name in ended:
        accounts().remove(name)
    return standing | (known - ended)


def broker_of(*, view: TokenView) -> dict[str, str] | None:
    """Return how a program comes in to the broker by a token and what it may hear, but the password: that is the token.

    `address` is empty where VIPO_BROKER_URL does not say it.
    """
    if not view.opens_broker:
        return None
    return {
        "address": str(settings.VIPO_BROKER_URL),
        "username": reader_name(view.id),
        "topics": f"{things_prefix(view.site)}#",
    }
