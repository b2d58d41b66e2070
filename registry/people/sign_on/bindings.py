"""Which account of a provider is whose here: linked, listed, unlinked; what of it the record tells."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime

from django.db import IntegrityError, transaction
from django.db.models import F

from registry.audit.record import note_act
from registry.errors import RegistryError
from registry.live.fanout import EVERY_SITE, publish
from registry.models import Membership, SignOn, User
from registry.people.sign_on.providers import Identity, Provider, SignOnFailed, title_of


class OnlyWayIn(RegistryError):
    """Somebody without a password who would take away what they sign in by."""

    code = "only_way_in"
    status = 409


class NoSuchSignOn(RegistryError):
    """A link that is not there, or somebody else's."""

    code = "not_found"
    status = 404


@dataclass(frozen=True, slots=True)
class SignOnView:
    """An account of a provider by which somebody signs in; `label` is what it calls them."""

    id: int
    provider: str
    title: str
    label: str
    linked_at: datetime
    used_at: datetime | None


def list_sign_ons(*, user: User) -> tuple[SignOnView, ...]:
    """Return by which accounts of providers a person signs in, the oldest first."""
    rows = SignOn.objects.filter(user=user).order_by("pk")
    return tuple(
        SignOnView(row.pk, row.provider, title_of(row.provider), row.label, row.linked_at, row.used_at) for row in rows
    )


def find_linked(identity: Identity) -> User | None:
    """Return whose account of a provider this is."""
    row = SignOn.objects.select_related("user").filter(issuer=identity.issuer, subject=identity.subject).first()
    return row.user if row else None


def link(*, user: User, provider: Provider, identity: Identity, now: datetime) -> None:
    """Let a person sign in by an account of a provider from now on. Raises SignOnFailed (taken, other)."""
    owner = find_linked(identity)
    if owner is not None:
        if owner.pk != user.pk:
            raise SignOnFailed("taken", provider.title)
        return
    try:
        with transaction.atomic():
            SignOn.objects.create(
                user=user,
                provider=provider.name,
                issuer=identity.issuer,
                subject=identity.subject,
                label=identity.email or identity.name,
                linked_at=now,
            )
            note_person(user, "sign_on_linked", provider.title)
    except IntegrityError as error:
        raise SignOnFailed("other", provider.title) from error


def note_use(*, identity: Identity, now: datetime) -> None:
    """Keep that somebody has come by it, and whether with a second factor."""
    rows = SignOn.objects.filter(issuer=identity.issuer, subject=identity.subject)
    rows.update(used_at=now, had_factor=identity.has_factor, label=identity.email or identity.name)


def unlink(*, user: User, sign_on: int) -> None:
    """Take a link away; all sessions of the person end. Raises NoSuchSignOn, OnlyWayIn."""
    with transaction.atomic():
        person = User.objects.select_for_update().get(pk=user.pk)
        row = SignOn.objects.filter(user=person, pk=sign_on).first() if sign_on < 2**63 else None
        if row is None:
            raise NoSuchSignOn("There is no such link. It may have been taken away already.")
        if not person.has_usable_password() and SignOn.objects.filter(user=person).count() == 1:
            raise OnlyWayIn(
                "You have no password: this is your only way in. Whoever runs this VIPO server can give you one "
                "(vipo account EMAIL --new-password)."
            )
        row.delete()
        User.objects.filter(pk=person.pk).update(session_generation=F("session_generation") + 1)
        note_person(person, "sign_on_unlinked", title_of(row.provider))
        transaction.on_commit(lambda: publish(EVERY_SITE, {"type": "members"}))


def unlink_others(*, user: User, issuer: str) -> None:
    """Take away a person's links with all other issuers than this; the caller sees to it that they can come in."""
    with transaction.atomic():
        for row in SignOn.objects.select_for_update().filter(user=user).exclude(issuer=issuer).order_by("pk"):
            row.delete()
            note_person(user, "sign_on_unlinked", title_of(row.provider))


def note_person(user: User | None, code: str, provider: str, why: str = "") -> None:
    """Tell the record of each site of a person, of the server's alone where there is none, what befell a sign-on."""
    sites: list[int | None] = (
        list(Membership.objects.filter(user=user).values_list("site_id", flat=True)) if user else []
    )
    facts = {"provider": provider, **({"person": user.display_name} if user else {}), **({"why": why} if why else {})}
    for site in sites or [None]:
        note_act(site_id=site, code=code, facts=facts, by=user.display_name if user else "")
