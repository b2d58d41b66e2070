"""Legacy topics: asked for by one device, confirmed by an admin, gone with whatever ends them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from registry import services
from registry.models import Device, TopicClaim, User
from registry.services import TopicNotAsked, TopicTaken
from tests.kit.sign_in import below_role, post_json, signed_in
from tests.kit.sites import MIXER, NOW, approve, describe
from vipo_device.protocol.description import Description, MethodSpec

TOPIC = "plant/mixer1/start"
WHO: dict[str, Any] = {"site": "hall", "device_id": "mixer1", "by": None, "at": NOW}


def asking(topic: str = TOPIC, device: str = "mixer1", **fields: Any) -> Description:
    return replace(MIXER, id=device, methods=(MethodSpec("mix", topic),), **fields)


def may_hear() -> frozenset[str]:
    return frozenset(services.list_granted_topics().get("mixer1", ()))


def test_a_method_on_a_legacy_topic_can_be_called_once_an_admin_has_confirmed_it(hall: str) -> None:
    approve(asking())
    before = services.get_device(site="hall", device_id="mixer1")
    assert (before.canonical.methods, [m.topic for m in before.asks]) == ((), [TOPIC])
    after = services.confirm_topic(topic=TOPIC, **WHO)
    assert ([m.topic for m in after.canonical.methods], after.asks) == ([TOPIC], ())
    assert may_hear() == {TOPIC}
    with pytest.raises(TopicNotAsked, match="already"):
        services.confirm_topic(topic=TOPIC, **WHO)
    withdrawn = services.withdraw_topic(topic=TOPIC, **WHO)
    assert (withdrawn.canonical.methods, [m.name for m in withdrawn.asks], may_hear()) == ((), ["mix"], frozenset())
    with pytest.raises(TopicNotAsked):
        services.withdraw_topic(topic=TOPIC, **WHO)
    events = services.list_device_events(site="hall", device_id="mixer1")
    assert [e.kind for e in events[:2]] == ["topic_withdrawn", "topic_confirmed"]


def test_only_what_is_asked_for_can_be_confirmed_and_only_of_devices_that_take_part(hall: str) -> None:
    describe(asking())
    with pytest.raises(TopicNotAsked, match="Approve it first"):
        services.confirm_topic(topic=TOPIC, **WHO)
    services.approve_device(**WHO)
    with pytest.raises(TopicNotAsked, match="does not ask"):
        services.confirm_topic(topic="plant/other", **WHO)
    assert may_hear() == frozenset()


def test_another_device_cannot_ask_for_the_topic_wherever_it_stands(hall: str) -> None:
    approve(asking())
    services.create_site(name="Other", slug="other")
    for site in ("hall", "other"):
        with pytest.raises(TopicTaken):
            describe(asking(device="thief", site=site))
    assert not Device.objects.filter(pk="thief", description__isnull=False).exists()
    services.retire_device(**WHO)
    assert [m.topic for m in describe(asking(device="thief")).asks] == [TOPIC]
    services.readmit_device(**WHO)
    services.approve_device(**WHO)
    with pytest.raises(TopicTaken):
        services.confirm_topic(topic=TOPIC, **WHO)
    assert may_hear() == frozenset()


@pytest.mark.parametrize(
    "change", [asking("plant/mixer1/other"), replace(asking(), methods=(MethodSpec("go", TOPIC),))]
)
def test_a_description_that_changes_the_topic_loses_the_confirmation(hall: str, change: Description) -> None:
    approve(asking())
    services.confirm_topic(topic=TOPIC, **WHO)
    describe(replace(asking(), name="Renamed"))
    assert may_hear() == {TOPIC}
    view = describe(change)
    assert (view.canonical.methods, view.asks, may_hear()) == ((), change.methods, frozenset())
    assert [c.topic for c in TopicClaim.objects.filter(confirmed_at=None)] == [change.methods[0].topic]


def test_retirement_ends_the_confirmation_and_readmission_does_not_bring_it_back(hall: str) -> None:
    approve(asking())
    services.confirm_topic(topic=TOPIC, **WHO)
    services.retire_device(**WHO)
    assert (may_hear(), TopicClaim.objects.count()) == (frozenset(), 0)
    assert [m.topic for m in services.readmit_device(**WHO).asks] == [TOPIC]
    assert (may_hear(), TopicClaim.objects.get().confirmed_at) == (frozenset(), None)


@pytest.mark.parametrize("what", ["confirm", "withdraw"])
def test_only_admins_decide_about_topics(person: Callable[[str], User], what: str) -> None:
    approve(asking())
    if what == "withdraw":
        services.confirm_topic(topic=TOPIC, **WHO)

    def ask(name: str) -> int:
        answer = post_json(signed_in(name), f"/api/sites/hall/devices/mixer1/topics/{what}", {"topic": TOPIC})
        return int(answer.status_code)

    answers = {name: ask(name) for name in ("stranger", "nobody", *below_role("admin"))}
    assert answers == {"stranger": 404, "nobody": 401, **dict.fromkeys(below_role("admin"), 403)}
    assert bool(may_hear()) is (what == "withdraw")
    assert (ask("admin"), ask("admin")) == (200, 409)
    assert bool(may_hear()) is (what == "confirm")
