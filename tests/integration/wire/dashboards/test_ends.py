"""However a token ends, the broker ends the dashboard that came in by it within 3 s, and lets it in no more."""

from __future__ import annotations

import time
from contextlib import ExitStack
from datetime import UTC, datetime, timedelta

import pytest

from execution.gateway.gateway import Gateway
from registry import services
from registry.models import ApiToken, Membership, User
from tests.integration.wire.bus import SITE, Bus
from tests.integration.wire.dashboards.program import EVERYTHING, dashboard, make_person, make_token
from tests.kit.waiting import wait_for

pytestmark = pytest.mark.servers
END_LIMIT_S = 3.0


def leave(person: User, token_id: str) -> None:
    services.remove_member(site=SITE, email=person.email)


def close(person: User, token_id: str) -> None:
    User.objects.filter(pk=person.pk).update(is_active=False)


def expire(person: User, token_id: str) -> None:
    ApiToken.objects.filter(public_id=token_id).update(expires_at=datetime.now(UTC) - timedelta(seconds=1))


def revoke(person: User, token_id: str) -> None:
    services.revoke_token(token_id=token_id)


def erase(person: User, token_id: str) -> None:
    Membership.objects.filter(user=person).delete()


ENDS = (revoke, expire, leave, close, erase)


def test_whatever_ends_a_token_ends_its_connection_for_good(bus: Bus, gateway: Gateway) -> None:
    stays = make_token(make_person("eve@vipo.example"))
    with ExitStack() as stack:
        other = stack.enter_context(dashboard(bus, *stays, EVERYTHING))
        people = [make_person(f"ada{number}@vipo.example") for number in range(len(ENDS))]
        ways = [make_token(person) for person in people]
        seen = [stack.enter_context(dashboard(bus, *way, EVERYTHING)) for way in ways]
        time.sleep(1.5)  # a token that is erased within a second of its making is found later
        for end, person, (name, _), one in zip(ENDS, people, ways, seen, strict=True):
            begun = time.monotonic()
            end(person, name.removeprefix("token:"))
            wait_for("the end", lambda o=one, since=begun: o.ended_at > since, 10)
            assert one.ended_at - begun < END_LIMIT_S, end.__name__
            assert name not in services.list_broker_hashes()
        for one in seen:
            wait_for("the refusal", lambda o=one: o.refused)
        assert (other.is_in, other.ended_at) == (True, 0)
    for name, key in ways:
        with dashboard(bus, name, key) as again:
            assert again.refused
