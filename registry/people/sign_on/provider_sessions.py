"""Sessions that began by a provider, and end when the provider says that theirs has ended (back-channel logout)."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta

from django.contrib.sessions.models import Session as KeptSession
from django.db import models, transaction

from registry.live.fanout import EVERY_SITE, publish
from registry.models import OpenSession, User
from registry.people.sign_on.bindings import note_person
from registry.people.sign_on.provider_client import LEEWAY_S, read_logout_token
from registry.people.sign_on.providers import Identity, LoggedOut, Provider


def bind_session(*, key: str, identity: Identity) -> None:
    """Keep by which session of a provider one of ours has begun."""
    OpenSession.objects.filter(key=key).update(issuer=identity.issuer, subject=identity.subject, sid=identity.sid)


def end_provider_sessions(*, provider: Provider, token: str) -> int:
    """End the sessions that a provider's logout token names; their sockets close within seconds. Returns how many.

    A token that is sent again ends none that began after it. Anybody may call: what is no such token costs a look at
    its signature and no statement. Raises BadLogoutToken, SignOnFailed (down).
    """
    told = read_logout_token(provider, token)
    with transaction.atomic():
        rows = list(_named(told).select_for_update().select_related("user"))
        KeptSession.objects.filter(session_key__in=[row.key for row in rows]).delete()
        OpenSession.objects.filter(pk__in=[row.pk for row in rows]).delete()
        people: dict[int, User] = {row.user_id: row.user for row in rows}
        for person in people.values():
            note_person(person, "sign_on_ended", provider.title)
        if rows:
            transaction.on_commit(lambda: publish(EVERY_SITE, {"type": "members"}))
    return len(rows)


def _named(told: LoggedOut) -> models.QuerySet[OpenSession]:
    until = datetime.fromtimestamp(told.at, UTC) + timedelta(seconds=LEEWAY_S)
    rows = OpenSession.objects.filter(issuer=told.issuer, begun_at__lte=until)
    if told.subject:
        rows = rows.filter(subject=told.subject)
    return rows.filter(sid=told.sid) if told.sid else rows
