"""What admins decide about devices and their keys, with a broker that asks the registry."""

from __future__ import annotations

import json
from datetime import timedelta
from typing import Any

import pytest

from registry import services
from registry.devices.authentication import Login
from registry.models import Device
from registry.services import BadDevice, NotApproved, NotRetired
from tests.kit.sign_in import below_role, signed_in
from tests.kit.sites import NOW, approve, come, describe, may_come_in, say
from vipo_device.protocol.credentials import secret_hash
from vipo_device.protocol.description import Pose
from vipo_device.protocol.messages import BadMessage

KEY, OTHER, JOIN = "k" * 32, "o" * 32, "j" * 32
WHO: dict[str, Any] = {"site": "hall", "device_id": "mixer1", "by": None, "at": NOW}


def test_a_new_device_with_the_join_key_gets_a_key_of_its_own_at_approval(hall: str) -> None:
    services.set_enrolment_key(site="hall", key=JOIN)
    credential = approve()
    assert len(credential) == 32
    assert may_come_in(credential)
    assert not may_come_in(JOIN)
    row = Device.objects.get(pk="mixer1")
    assert credential not in json.dumps([row.credential_hash, row.broker_hash])
    assert row.broker_hash.startswith("$7$101$")


def test_one_that_brought_its_own_key_keeps_it_when_it_cannot_take_a_new_one(hall: str) -> None:
    services.expect_device(site="hall", device_id="mixer1", credential=KEY, approved=False)
    describe()
    decided = services.approve_device(**WHO)
    assert (decided.credential, decided.taken, may_come_in(KEY)) == (None, False, True)


def test_a_new_key_ends_the_old_one_and_old_connections(hall: str) -> None:
    old = approve()
    logins = {"mixer1": Login(secret_hash(old), NOW)}
    assert services.find_ended(logins=logins) == frozenset()
    new = services.rotate_credential(**WHO)
    assert new.taken is False
    assert (may_come_in(str(new.credential)), may_come_in(old)) == (True, False)
    assert services.find_ended(logins=logins) == {"mixer1"}
    assert services.find_ended(logins={"mixer1": Login("", NOW - timedelta(seconds=1))}) == {"mixer1"}
    assert services.find_ended(logins={"mixer1": Login(secret_hash(str(new.credential)), NOW)}) == frozenset()


def test_a_revoked_key_lets_nobody_in_and_is_not_brought_back_by_the_next_start(hall: str) -> None:
    key = approve()
    come()
    view = services.revoke_credential(**WHO)
    assert (view.online, view.has_key, view.lifecycle) == (False, False, "approved")
    services.expect_device(site="hall", device_id="mixer1", credential=key)
    assert not may_come_in(key)
    assert services.find_ended(logins={"mixer1": Login("", NOW + timedelta(days=1))}) == {"mixer1"}
    with pytest.raises(BadDevice, match="key was revoked"):
        enrol(OTHER)
    assert services.list_broker_hashes() == {}
    assert come(boot=2) is None
    assert say(boot=2, seq=5).online is False


def test_a_retired_device_stays_out_until_an_admin_lets_it_come_back(hall: str) -> None:
    services.set_enrolment_key(site="hall", key=JOIN)
    key = approve()
    with pytest.raises(NotRetired):
        services.readmit_device(**WHO)
    services.retire_device(**WHO)
    assert services.list_devices(site="hall") == ()
    assert [d.id for d in services.list_devices(site="hall", lifecycle="retired")] == ["mixer1"]
    assert (may_come_in(key), may_come_in(JOIN)) == (False, False)
    assert not enrol(OTHER)
    assert not may_come_in(OTHER)
    for decide in (services.retire_device, services.rotate_credential, services.revoke_credential):
        with pytest.raises(NotApproved):
            decide(**WHO)
    assert services.readmit_device(**WHO).lifecycle == "pending"
    assert (may_come_in(key), may_come_in(JOIN)) == (False, True)
    assert enrol(OTHER)
    assert (may_come_in(key), may_come_in(OTHER)) == (False, True)
    assert [e.text for e in services.list_device_events(site="hall", device_id="mixer1")][1:4] == [
        "May come back",
        "Retired",
        "Approved",
    ]


@pytest.mark.parametrize("again", ["let back", "new key by hand"])
def test_another_board_of_the_same_id_counts_its_starts_anew(hall: str, again: str) -> None:
    approve()
    come(boot=57)
    say(boot=57, seq=900)
    come(boot=57, online=False)
    if again == "let back":
        services.retire_device(**WHO)
        services.readmit_device(**WHO)
        say(boot=57, seq=900, retained=True)
        assert enrol(OTHER)
        services.approve_device(**WHO)
    else:
        services.rotate_credential(**WHO)
    assert come(boot=1).online is True
    assert say(boot=1, seq=1, done=False).done is False
    with pytest.raises(BadDevice, match="comes as start 0"):
        come(boot=0)
    assert say(boot=1, seq=1) is None


def enrol(key: str, device_id: str = "mixer1") -> bool:
    body = json.dumps({"key": key}).encode()
    return services.enrol_device(site="hall", device_id=device_id, payload=body, at=NOW)


def test_a_stranger_knocks_brings_its_key_and_waits(hall: str) -> None:
    assert enrol(KEY)
    assert not enrol(KEY)
    assert may_come_in(KEY)
    assert describe().lifecycle == "pending"
    with pytest.raises(BadDevice, match="known with another key"):
        enrol(OTHER)
    assert (may_come_in(KEY), may_come_in(OTHER)) == (True, False)
    assert sorted(services.list_broker_hashes()) == ["mixer1"]


@pytest.mark.parametrize("payload", [b"", b"{", b'{"key": 5}', b'{"key": "short"}', b'{"key": "%s"}' % (b"k" * 129)])
def test_a_knock_without_a_proper_key_is_refused(hall: str, payload: bytes) -> None:
    with pytest.raises(BadMessage):
        services.enrol_device(site="hall", device_id="mixer1", payload=payload, at=NOW)
    assert Device.objects.count() == 0


def test_knocks_do_not_fill_the_registry(hall: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("registry.devices.enrolment.MOST_PENDING", 2)
    assert enrol(KEY, "a")
    assert enrol(KEY, "b")
    with pytest.raises(BadDevice, match="Decide about some of them first"):
        enrol(KEY, "c")
    Device.objects.filter(pk="a").update(first_seen_at=NOW - timedelta(days=2))
    assert enrol(KEY, "c")
    assert sorted(Device.objects.values_list("pk", flat=True)) == ["b", "c"]


def test_the_door_opens_with_its_sites_key_only(hall: str) -> None:
    services.set_enrolment_key(site="hall", key=JOIN)
    services.create_site(name="Other", slug="other")
    assert may_come_in(JOIN, "join:hall")
    assert not may_come_in(JOIN, "join:other")
    assert not may_come_in("", "join:other")
    assert services.find_ended(logins={"join:hall": Login(secret_hash(JOIN), NOW)}) == frozenset()
    services.set_enrolment_key(site="hall", key=OTHER)
    assert services.find_ended(logins={"join:hall": Login(secret_hash(JOIN), NOW)}) == {"join:hall"}


def test_an_error_begins_and_ends_in_the_history(hall: str) -> None:
    approve()
    come()
    say(seq=1, props={"error": "Nozzle blocked"})
    say(seq=2, props={"error": "Nozzle blocked"})
    say(seq=3, props={"error": ""})
    events = services.list_device_events(site="hall", device_id="mixer1")
    assert [e.text for e in events[:2]] == ["Reports no error any more", "Reports an error: Nozzle blocked"]


CALLS = (("post", "/retire"), ("post", "/credential"), ("delete", "/credential"), ("post", "/readmit"))


@pytest.mark.parametrize(("method", "path"), CALLS)
def test_only_admins_decide_about_keys(hall: str, method: str, path: str) -> None:
    key = approve()
    if path == "/readmit":
        services.retire_device(**WHO)
    address = f"/api/sites/hall/devices/mixer1{path}"
    refused = {"stranger": 404, "nobody": 401, **dict.fromkeys(below_role("admin"), 403)}
    assert {name: getattr(signed_in(name), method)(address).status_code for name in refused} == refused
    assert may_come_in(key) == (path != "/readmit")
    assert getattr(signed_in("admin"), method)(address).status_code == 200


def test_a_key_is_told_once_and_not_kept_by_browsers(hall: str) -> None:
    describe()
    admin = signed_in("admin")
    answer = admin.post("/api/sites/hall/devices/mixer1/approve")
    assert answer["Cache-Control"] == "no-store"
    assert may_come_in(answer.json()["credential"])
    assert "credential" not in admin.get("/api/sites/hall/devices/mixer1").json()
    assert admin.post("/api/sites/hall/devices/mixer1/approve").status_code == 409
    rotated = admin.post("/api/sites/hall/devices/mixer1/credential")
    assert rotated["Cache-Control"] == "no-store"
    assert may_come_in(rotated.json()["credential"])
    assert not may_come_in(answer.json()["credential"])
    assert admin.get("/api/sites/hall/devices?lifecycle=retired").json() == []
    assert admin.get("/api/sites/hall/devices?lifecycle=nonsense").status_code == 422


def test_a_machine_that_people_placed_stands_where_it_says_itself_again_when_they_take_that_back(hall: str) -> None:
    describe()
    own = services.get_device(site="hall", device_id="mixer1").pose
    admin, address = signed_in("admin"), "/api/sites/hall/devices/mixer1"

    def edit(body: dict[str, Any]) -> tuple[int, bool]:
        answer = admin.patch(address, json.dumps(body), content_type="application/json")
        return answer.status_code, answer.json()["is_placed"]

    assert edit({"location": None}) == (200, False)
    assert edit({"location": {"x": 5, "y": 6}}) == (200, True)
    assert edit({"name": "Left"}) == (200, True)
    assert services.get_device(site="hall", device_id="mixer1").pose == Pose(5, 6)
    assert edit({"location": None}) == (200, False)
    assert services.get_device(site="hall", device_id="mixer1").pose == own
    assert say(loc=[9, 8, 0, 0]).pose == Pose(9, 8)
    texts = [e.text for e in services.list_device_events(site="hall", device_id="mixer1")]
    again = f"Stands where it says itself again: {own.x:.2f}, {own.y:.2f}"
    assert texts[:3] == [again, "Renamed from Mixer One to Left", "Moved to 5.00, 6.00"]
