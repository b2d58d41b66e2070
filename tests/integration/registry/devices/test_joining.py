from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from datetime import timedelta
from typing import Any

import pytest

from registry import services
from registry.devices import descriptions
from registry.devices.enrolment import MOST_PENDING
from registry.models import Device, DeviceEvent, Site, User
from registry.services import BadDevice, NoSuchDevice, NotPending, Principal
from tests.kit.files import FIGURE_5
from tests.kit.sites import MIXER, NOW, ROBOT, come, describe, say
from vipo_device.descriptions.forms import CONTENT_TYPES, FORMS, BadDescription
from vipo_device.descriptions.reader import read, write_description
from vipo_device.protocol.credentials import secret_hash
from vipo_device.protocol.description import MethodSpec, Pose
from vipo_device.protocol.messages import BadMessage

KEY = "k" * 32
JOIN = "j" * 32


def test_an_unknown_device_becomes_pending_and_is_shown(
    heard: list[Any], django_capture_on_commit_callbacks: Any
) -> None:
    with django_capture_on_commit_callbacks(execute=True):
        view = describe()
    assert (view.lifecycle, view.status, view.activity.text, view.online) == (
        "pending",
        "pending",
        "Not trusted yet",
        False,
    )
    assert services.list_devices(site="hall") == (view,)
    assert [(slug, m["type"], m["device"]["id"], m["device"]["status"]) for slug, m in heard] == [
        ("hall", "device", "mixer1", "pending")
    ]
    events = services.list_device_events(site="hall", device_id="mixer1")
    assert [e.text for e in events] == ["Described itself for the first time: Mixer One, mixer"]


def test_the_same_description_again_changes_nothing(heard: list[Any], django_capture_on_commit_callbacks: Any) -> None:
    describe()
    with django_capture_on_commit_callbacks(execute=True):
        assert describe().last_seen_at == NOW
    assert heard == []
    assert DeviceEvent.objects.count() == 1


def test_a_changed_description_is_told_by_what_changed(
    heard: list[Any], django_capture_on_commit_callbacks: Any
) -> None:
    describe()
    more = (*MIXER.methods, MethodSpec("stop", "vipo/v1/dev/mixer1/down/stop"))
    with django_capture_on_commit_callbacks(execute=True):
        describe(replace(MIXER, methods=more))
    assert sorted(heard[0][1]["device"]) == ["id", "methods"]
    told = services.list_device_events(site="hall", device_id="mixer1")[0]
    assert (told.text, [(c.path, c.before) for c in told.changes]) == ("Added method stop", [("methods/stop", "")])
    assert '"vipo/v1/dev/mixer1/down/stop"' in told.changes[0].after


def test_a_description_that_is_not_rdf_leaves_the_old_one(hall: str) -> None:
    describe()
    with pytest.raises(BadDescription):
        services.ingest_description(device_id="mixer1", payload=b"not rdf", at=NOW)
    assert services.get_device(site="hall", device_id="mixer1").name == "Mixer One"


@pytest.mark.parametrize("form", FORMS)
def test_a_device_joins_in_every_form_and_changes_nothing_by_another(hall: str, form: str) -> None:
    describe()
    payload = write_description(MIXER, form).encode()
    services.ingest_description(device_id="mixer1", payload=payload, at=NOW)
    assert services.get_device(site="hall", device_id="mixer1").canonical == MIXER
    assert Device.objects.get(pk="mixer1").source_type == CONTENT_TYPES[form]
    assert DeviceEvent.objects.count() == 1


def test_what_was_mended_is_told_once_and_news_of_values_are_no_change(hall: str) -> None:
    text = 'id: "mixer1"\nsite: hall\nlocation: [2, 2]\nsize: "small\'\n'
    text += 'done: %s\nproperties:\n  name: "job"\n  value: %s\n'
    for done, value in (("False", "1.0"), ("False", "2.0"), ("True", "2.0")):
        services.ingest_description(device_id="mixer1", payload=(text % (done, value)).encode(), at=NOW)
    events = services.list_device_events(site="hall", device_id="mixer1")
    assert [(e.kind, e.text) for e in events] == [
        (
            "mended",
            "Line 2: put the value of site in quotes: 'hall'. Line 4: put the value of size in quotes: 'small'. "
            "Left out the value of job: values come on up/state.",
        ),
        ("described", "Described itself for the first time: mixer1, machine"),
    ]


def test_all_that_was_mended_stands_in_the_history(hall: str) -> None:
    figure = FIGURE_5 + b"site: hall\n"
    services.ingest_description(device_id="paintMixer02", payload=figure, at=NOW)
    events = services.list_device_events(site="hall", device_id="paintMixer02")
    assert [e.kind for e in events] == ["mended", "mended", "mended", "described"]
    assert all(len(e.text) <= 300 for e in events)
    assert " ".join(e.text for e in events[:3]) == " ".join(note.text for note in read(figure).notes)
    told = [fault for event in events[:3] for fault in event.args["faults"]]
    assert [fault["code"] for fault in told] == [note.code for note in read(figure).notes]


def test_an_unchanged_description_is_not_parsed_again(hall: str, monkeypatch: pytest.MonkeyPatch) -> None:
    describe()
    monkeypatch.setattr(descriptions, "read", lambda *a, **k: pytest.fail("parsed again"))
    assert describe().last_seen_at == NOW


def test_a_device_without_a_known_site_comes_to_the_default_one(hall: str, settings: Any) -> None:
    settings.VIPO_DEFAULT_SITE = "hall"
    assert describe(replace(MIXER, site="elsewhere")).site == "hall"


def test_a_device_that_no_site_can_take_is_refused(hall: str, settings: Any) -> None:
    settings.VIPO_DEFAULT_SITE = "nowhere"
    with pytest.raises(BadDevice, match="no site 'elsewhere'"):
        describe(replace(MIXER, site="elsewhere"))
    assert not Device.objects.exists()


def test_presence_may_come_before_the_description(hall: str, settings: Any) -> None:
    settings.VIPO_DEFAULT_SITE = "hall"
    assert come() is None
    assert services.list_devices(site="hall") == ()
    assert describe().online is True


def test_an_approved_device_comes_works_and_goes(heard: list[Any], person: Callable[[str], User]) -> None:
    describe()
    services.approve_device(site="hall", device_id="mixer1", by=person("admin"), at=NOW)
    assert come().status == "idle"
    busy = say(seq=2, done=False, cmd="c1", props={"jobStatus": 75.0})
    assert (busy.status, busy.activity.text, busy.command) == ("busy", "Working, 75 %", "c1")
    assert services.device_to_json(busy)["properties"][0]["value"] == 75.0
    assert come(online=False).status == "offline"
    assert services.list_device_events(site="hall", device_id="mixer1")[0].text == "Left"


def test_only_what_changed_goes_to_the_browsers(heard: list[Any], django_capture_on_commit_callbacks: Any) -> None:
    describe(ROBOT)
    services.approve_device(site="hall", device_id="robot1", by=None, at=NOW)
    come("robot1")
    with django_capture_on_commit_callbacks(execute=True):
        say("robot1", loc=[1, 2, 0, 0.5], props={"load": "box:2"})
    assert heard == [
        (
            "hall",
            {
                "type": "device",
                "device": {
                    "id": "robot1",
                    "location": {"x": 1.0, "y": 2.0, "z": 0.0, "theta": 0.5},
                    "carrying": {"box": 2},
                    "doing": "Carrying 2 boxes",
                    "activity": {"code": "carrying", "args": {"box": 2}},
                },
            },
        )
    ]


def test_old_states_replays_and_old_boots_are_ignored(hall: str) -> None:
    describe()
    assert say(boot=2, seq=5, props={"jobStatus": 5}) is not None
    for boot, seq in ((2, 5), (2, 4), (1, 99)):
        assert say(boot=boot, seq=seq, props={"jobStatus": 9}) is None
    assert services.get_device(site="hall", device_id="mixer1").readings == {"jobStatus": 5}
    assert say(boot=3, seq=0, props={"jobStatus": 0}).readings == {"jobStatus": 0}


def test_a_stale_will_does_not_take_a_device_away(hall: str) -> None:
    describe()
    come(boot=2)
    assert come(boot=1, online=False) is None
    assert services.get_device(site="hall", device_id="mixer1").online is True


def test_a_retained_state_does_not_bring_a_device_back(hall: str) -> None:
    describe()
    come(online=False)
    assert say(retained=True).online is False
    assert say(seq=2).online is True


def test_coming_and_going_all_the_time_does_not_fill_the_history(hall: str) -> None:
    describe()
    for number in range(40):
        come(boot=number, online=number % 2 == 0, at=NOW + timedelta(milliseconds=number))
    assert services.get_device(site="hall", device_id="mixer1").online is False
    kinds = [e.kind for e in services.list_device_events(site="hall", device_id="mixer1")]
    assert kinds == ["flapping", *["offline", "online"] * 3, "described"]


def test_states_of_unknown_devices_are_left_aside(hall: str) -> None:
    assert say("nobody") is None
    assert not Device.objects.exists()


def test_a_malformed_state_is_refused_and_changes_nothing(hall: str) -> None:
    describe()
    with pytest.raises(BadMessage):
        say(props={"a": []})
    assert services.get_device(site="hall", device_id="mixer1").readings == {}


def test_a_silent_device_goes_offline_after_45_s(hall: str) -> None:
    describe()
    come()
    assert services.mark_stale(now=NOW + timedelta(seconds=45)) == ()
    gone = services.mark_stale(now=NOW + timedelta(seconds=46))
    assert [d.id for d in gone] == ["mixer1"]
    assert services.mark_stale(now=NOW + timedelta(seconds=99)) == ()
    assert services.get_device(site="hall", device_id="mixer1").online is False


def test_a_decision_is_taken_once(person: Callable[[str], User]) -> None:
    describe()
    decided = services.approve_device(site="hall", device_id="mixer1", by=person("admin"), at=NOW)
    assert decided.device.lifecycle == "approved"
    with pytest.raises(NotPending, match="it is approved"):
        services.reject_device(site="hall", device_id="mixer1", by=person("admin"), at=NOW)
    with pytest.raises(NoSuchDevice):
        services.approve_device(site="elsewhere", device_id="mixer1", by=person("admin"), at=NOW)
    event = services.list_device_events(site="hall", device_id="mixer1")[0]
    assert (event.text, event.by) == ("Approved", "Admin Person")


def test_a_rejected_device_is_gone_and_stays_out(heard: list[Any], django_capture_on_commit_callbacks: Any) -> None:
    services.expect_device(site="hall", device_id="mixer1", credential=KEY, approved=False)
    describe()
    with django_capture_on_commit_callbacks(execute=True):
        services.reject_device(site="hall", device_id="mixer1", by=None, at=NOW)
    assert heard == [("hall", {"type": "device_removed", "id": "mixer1"})]
    assert services.list_devices(site="hall") == ()
    assert services.check_device_password(username="mixer1", password=KEY) is None
    assert describe().lifecycle == "retired"


def test_an_expected_device_is_approved_when_it_comes(hall: str) -> None:
    services.expect_device(site="hall", device_id="mixer1", credential=KEY)
    assert services.list_devices(site="hall") == ()
    assert describe(replace(MIXER, site="elsewhere")).lifecycle == "approved"
    assert services.get_device(site="hall", device_id="mixer1").site == "hall"


def test_a_device_comes_in_with_its_own_key_only(hall: str) -> None:
    services.set_enrolment_key(site="hall", key=JOIN)
    services.expect_device(site="hall", device_id="mixer1", credential=KEY)
    check = services.check_device_password
    assert check(username="mixer1", password=KEY) == Principal("mixer1", False, secret_hash(KEY), site="hall")
    assert check(username="mixer1", password=JOIN) is None
    assert check(username="mixer2", password=KEY) is None
    assert check(username="mixer2", password="") is None


def test_the_join_key_is_for_new_devices_until_they_are_approved(hall: str) -> None:
    services.set_enrolment_key(site="hall", key=JOIN)
    check = services.check_device_password
    assert check(username="new1", password=JOIN) == Principal("new1", True, site="hall")
    assert check(username="server", password=JOIN) is None
    assert check(username="a/b", password=JOIN) is None
    describe()
    assert check(username="mixer1", password=JOIN) == Principal("mixer1", True, site="hall")
    services.approve_device(site="hall", device_id="mixer1", by=None, at=NOW)
    assert check(username="mixer1", password=JOIN) is None


def test_no_more_than_two_hundred_new_devices_come_in_with_a_join_key_alone(hall: str) -> None:
    services.set_enrolment_key(site="hall", key=JOIN)
    site = Site.objects.get(slug="hall")
    Device.objects.bulk_create(Device(pk=f"n{number}", site=site) for number in range(MOST_PENDING - 1))
    assert services.check_device_password(username="mixer1", password=JOIN)
    describe()
    assert services.check_device_password(username="mixer1", password=JOIN)
    assert services.check_device_password(username="robot1", password=JOIN) is None
    services.reject_device(site="hall", device_id="mixer1", by=None, at=NOW)
    assert services.check_device_password(username="robot1", password=JOIN)


@pytest.mark.parametrize("device_id", ["server", ".", ".."])
def test_an_id_that_no_address_can_name_is_refused(hall: str, device_id: str) -> None:
    with pytest.raises(BadDevice, match=r"not 'server', '\.' or '\.\.'"):
        come(device_id)
    with pytest.raises(BadDevice, match=r"not 'server', '\.' or '\.\.'"):
        describe(replace(MIXER, id=device_id, methods=()))
    assert not Device.objects.exists()


def test_short_keys_and_bad_ids_are_refused(hall: str) -> None:
    for device_id, key in (("mixer1", "short"), ("a/b", KEY), ("server", KEY)):
        with pytest.raises(BadDevice):
            services.expect_device(site="hall", device_id=device_id, credential=key)
    assert not Device.objects.exists()


def test_people_rename_and_place_a_machine_and_its_own_word_comes_second(person: Callable[[str], User]) -> None:
    describe()
    edit = {"site": "hall", "device_id": "mixer1", "by": person("admin"), "at": NOW}
    view = services.update_device(**edit, name="  Mixer B ", pose=Pose(5, 6, 0, 1))
    assert (view.name, view.pose) == ("Mixer B", Pose(5, 6, 0, 1))
    assert say(loc=[9, 9, 0, 0]).pose == Pose(5, 6, 0, 1)
    assert services.update_device(**edit, name="").name == "Mixer One"
    texts = [e.text for e in services.list_device_events(site="hall", device_id="mixer1")]
    assert texts[:3] == [
        "Renamed from Mixer B to Mixer One",
        "Moved to 5.00, 6.00",
        "Renamed from Mixer One to Mixer B",
    ]


def test_a_robot_knows_best_where_it_is(hall: str) -> None:
    describe(ROBOT)
    services.update_device(site="hall", device_id="robot1", pose=Pose(5, 6), by=None, at=NOW)
    assert services.get_device(site="hall", device_id="robot1").pose == Pose(5, 6)
    assert say("robot1", loc=[1, 2, 0, 0]).pose == Pose(1, 2)


def test_low_batteries_and_errors_are_seen(hall: str) -> None:
    describe(ROBOT)
    services.approve_device(site="hall", device_id="robot1", by=None, at=NOW)
    assert say("robot1", seq=2, props={"battery": 12}).status == "warning"
    failing = say("robot1", seq=3, props={"error": "Lid open"})
    assert (failing.status, failing.activity.text) == ("error", "Lid open")


def test_problems_are_noted_at_most_every_ten_seconds(hall: str) -> None:
    describe()
    note = services.record_problem
    assert [note(device_id="mixer1", text="x", at=NOW + timedelta(seconds=s)) for s in (0, 5, 11)] == [
        True,
        False,
        True,
    ]
    assert note(device_id="nobody", text="x", at=NOW) is False


def test_a_history_keeps_the_newest_100_of_what_was_refused(hall: str) -> None:
    describe()
    for second in range(205):
        services.record_problem(device_id="mixer1", text=str(second), at=NOW + timedelta(seconds=20 * second))
    assert [DeviceEvent.objects.filter(kind=kind).count() for kind in ("problem", "described")] == [100, 1]
    assert services.list_device_events(site="hall", device_id="mixer1", limit=1)[0].text == "204"
