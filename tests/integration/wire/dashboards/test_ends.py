"""However a token ends, the broker ends the dashboard that came in by it within 3 s, and lets it in no more."""

from __future__ import annotations

import time
from collections import defaultdict
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from typing import Any

import pytest

from execution.gateway.gateway import Gateway
from registry import services
from registry.models import ApiToken, Membership, User
from tests.integration.wire.bus import SITE, Bus
from tests.integration.wire.dashboards.program import EVERYTHING, dashboard, make_person, make_token
from tests.kit.waiting import wait_for

pytestmark = pytest.mark.servers
END_LIMIT_S = 3.0
BETWEEN_LOOKS_S = END_LIMIT_S - 1.0
"""The second that is left is for the end itself."""


@dataclass
class Looks:
    """What VIPO does again and again to find whom the broker must end: when it would, and what it may.

    It looks only when a test lets it, once, so that what comes of a look is known, however busy the machine is.
    """

    due_at: defaultdict[str, list[float]] = field(default_factory=lambda: defaultdict(list))
    allowed: set[str] = field(default_factory=set)
    taken: set[str] = field(default_factory=set)

    def allow(self) -> None:
        """Let each be taken once from now on."""
        self.taken.clear()
        self.allowed = {"end_readers", "find_ended"}

    def over(self, name: str, otherwise: Callable[[dict[str, Any]], Any]) -> Callable[..., Any]:
        look = getattr(services, name)

        def take(**asked: Any) -> Any:
            self.due_at[name].append(time.monotonic())
            if name not in self.allowed:
                return otherwise(asked)
            self.allowed.discard(name)
            found = look(**asked)
            self.taken.add(name)
            return found

        return take

    def follow_each_other(self, name: str) -> bool:
        """Tell whether three have come as soon as they should; one by itself may have been hinted at."""
        at = self.due_at[name]
        return any(third - first < 2 * BETWEEN_LOOKS_S for first, third in zip(at, at[2:], strict=False))


@pytest.fixture
def looks(monkeypatch: pytest.MonkeyPatch) -> Looks:
    made = Looks()
    monkeypatch.setattr(services, "end_readers", made.over("end_readers", lambda asked: asked["known"]))
    monkeypatch.setattr(services, "find_ended", made.over("find_ended", lambda _asked: frozenset()))
    return made


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


def test_whatever_ends_a_token_ends_its_connection_for_good(bus: Bus, gateway: Gateway, looks: Looks) -> None:
    stays = make_token(make_person("eve@vipo.example"))
    with ExitStack() as stack:
        other = stack.enter_context(dashboard(bus, *stays, EVERYTHING))
        people = [make_person(f"ada{number}@vipo.example") for number in range(len(ENDS))]
        ways = [make_token(person) for person in people]
        seen = [stack.enter_context(dashboard(bus, *way, EVERYTHING)) for way in ways]
        looks.allow()
        # a token that is erased before somebody has looked is found later
        wait_for("a look", lambda: "end_readers" in looks.taken)
        for end, person, (name, _), one in zip(ENDS, people, ways, seen, strict=True):
            begun = time.monotonic()
            end(person, name.removeprefix("token:"))
            looks.allow()
            wait_for(f"the end by {end.__name__}", lambda o=one, since=begun: o.ended_at > since)
            assert name not in services.list_broker_hashes()
        looks.due_at.clear()
        for one in seen:
            wait_for("the refusal", lambda o=one: o.refused)
        assert (other.is_in, other.ended_at) == (True, 0)
        for name in ("end_readers", "find_ended") if bus.kind == "amqtt" else ("end_readers",):
            wait_for(f"{name} again and again", lambda name=name: looks.follow_each_other(name))
    for name, key in ways:
        with dashboard(bus, name, key) as again:
            assert again.refused
