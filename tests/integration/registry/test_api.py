from __future__ import annotations

import gzip
import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from django.core.files.uploadedfile import SimpleUploadedFile
from django.core.management import call_command
from django.test import Client

from registry import services
from registry.models import DeviceEvent, Membership, Site, User
from tests.kit.sign_in import PASSWORD, ROLES, below_role, signed_in
from tests.kit.sites import MIXER, NOW, ROBOT, approve, come, describe, say
from vipo_device.descriptions.forms import CONTENT_TYPES, FORMS
from vipo_device.descriptions.reader import read_description

YAML = b"image: a.pgm\nresolution: 0.05\norigin: [-1, -2, 0]\n"
IMAGE = b"P5 2 2 255\n" + bytes([254, 0, 205, 254])
EVERYBODY = (*ROLES, "stranger", "nobody")


def sign_in(client: Client, email: str, password: str, **headers: str) -> Any:
    body = json.dumps({"email": email, "password": password})
    return client.post("/api/sign-in", body, content_type="application/json", headers=headers)


def test_a_person_signs_in_and_out_with_the_token(hall: str) -> None:
    client = Client(enforce_csrf_checks=True)
    me = client.get("/api/me").json()
    assert (me["user"], me["demo_accounts"]) == (None, [])
    assert sign_in(client, "admin@vipo.example", PASSWORD).status_code == 403
    answer = sign_in(client, " Admin@VIPO.example ", PASSWORD, **{"X-CSRFToken": me["csrf"]})
    assert answer.status_code == 200
    person = answer.json()["user"]
    assert (person["name"], person["initials"], person["email"]) == ("Admin Person", "AP", "admin@vipo.example")
    assert client.get("/api/me").json()["user"] == person
    assert client.post("/api/sign-out").status_code == 403
    assert client.post("/api/sign-out", headers={"X-CSRFToken": answer.json()["csrf"]}).json()["user"] is None
    assert client.get("/api/sites").status_code == 401


@pytest.mark.parametrize(
    ("email", "password"), [("admin@vipo.example", "wrong"), ("who@vipo.example", PASSWORD), ("", "")]
)
def test_a_wrong_address_and_a_wrong_password_look_the_same(hall: str, email: str, password: str) -> None:
    answer = sign_in(Client(), email, password)
    assert answer.status_code == 401
    assert answer["Content-Type"] == "application/problem+json"
    assert answer.json()["code"] == "wrong_password"
    assert answer.json()["detail"] == "The e-mail address or the password is wrong. Check both and try again."


def test_guessing_is_slowed_down_and_does_not_lock_out_others(hall: str) -> None:
    for _ in range(8):
        assert sign_in(Client(), "admin@vipo.example", "wrong").status_code == 401
    blocked = sign_in(Client(), "admin@vipo.example", PASSWORD)
    assert (blocked.status_code, blocked.json()["code"]) == (429, "too_many_attempts")
    assert sign_in(Client(), "author@vipo.example", PASSWORD).status_code == 200
    assert sign_in(Client(REMOTE_ADDR="10.0.0.9"), "admin@vipo.example", PASSWORD).status_code == 200


def test_somebody_who_was_deactivated_cannot_sign_in(hall: str) -> None:
    User.objects.filter(email="admin@vipo.example").update(is_active=False)
    assert sign_in(Client(), "admin@vipo.example", PASSWORD).status_code == 401


@pytest.fixture
def demo_file(settings: Any, tmp_path: Path) -> dict[str, str]:
    account = {"email": "admin@vipo.example", "password": PASSWORD, "role": "admin"}
    (tmp_path / "demo-accounts.json").write_text(json.dumps([account]))
    settings.VIPO_STATE_DIR = tmp_path
    return account


def offered(**about: str) -> list[dict[str, str]]:
    found: list[dict[str, str]] = Client(**about).get("/api/me").json()["demo_accounts"]
    return found


def test_the_demo_offers_its_accounts_and_nothing_else_does(
    hall: str, settings: Any, demo_file: dict[str, str]
) -> None:
    assert offered() == []
    settings.VIPO_DEMO = True
    assert offered() == []
    settings.VIPO_DEMO_SIGN_IN = True
    assert offered() == [demo_file]


def test_the_demo_offers_its_accounts_to_browsers_of_its_machine_alone(
    hall: str, settings: Any, demo_file: dict[str, str]
) -> None:
    settings.VIPO_DEMO_SIGN_IN = True
    assert offered(REMOTE_ADDR="::1") == [demo_file]
    assert [offered(REMOTE_ADDR=address) for address in ("10.0.0.9", "", "nonsense")] == [[], [], []]
    passed_on = ("HTTP_X_FORWARDED_FOR", "HTTP_FORWARDED", "HTTP_VIA")
    assert [offered(**{name: "127.0.0.1"}) for name in passed_on] == [[], [], []]


def test_the_accounts_of_the_demo_end_with_it(
    hall: str, settings: Any, demo_file: dict[str, str], capsys: pytest.CaptureFixture[str]
) -> None:
    open_page = Client()
    assert sign_in(open_page, "admin@vipo.example", PASSWORD).status_code == 200
    call_command("end_demo")
    assert capsys.readouterr().out == "admin@vipo.example was an account of the demo and cannot sign in any more.\n"
    assert open_page.get("/api/me").json()["user"] is None
    assert sign_in(Client(), "admin@vipo.example", PASSWORD).status_code == 401
    assert sign_in(Client(), "author@vipo.example", PASSWORD).status_code == 200
    assert not (settings.VIPO_STATE_DIR / "demo-accounts.json").exists()


def test_who_was_given_another_password_outlives_the_demo(hall: str, settings: Any, demo_file: dict[str, str]) -> None:
    services.change_password(email="admin@vipo.example", password="a password of my own")
    call_command("end_demo")
    assert sign_in(Client(), "admin@vipo.example", "a password of my own").status_code == 200


DEVICE = "/devices/mixer1"
READ = (
    *("", "/map", "/map/cells", "/map.yaml", "/map.pgm", "/devices"),
    *(DEVICE, f"{DEVICE}/events", f"{DEVICE}/rdf"),
)


@pytest.mark.parametrize("path", READ)
def test_every_member_may_look_and_strangers_learn_nothing(hall: str, path: str) -> None:
    describe()
    answers = {name: signed_in(name).get(f"/api/sites/hall{path}").status_code for name in EVERYBODY}
    assert answers == {**dict.fromkeys(ROLES, 200), "stranger": 404, "nobody": 401}
    hidden = signed_in("stranger").get(f"/api/sites/hall{path}").json()["detail"]
    assert hidden == signed_in("stranger").get(f"/api/sites/missing{path}").json()["detail"]


@pytest.mark.parametrize(("method", "path"), [("post", "/approve"), ("post", "/reject"), ("patch", "")])
def test_only_admins_decide_about_devices(hall: str, method: str, path: str) -> None:
    describe()
    address, body = f"/api/sites/hall/devices/mixer1{path}", json.dumps({"name": "Mine"})
    answers = {}
    for name in ("stranger", "nobody", *below_role("admin")):
        call = getattr(signed_in(name), method)
        answers[name] = call(address, body, content_type="application/json").status_code
    assert answers == {"stranger": 404, "nobody": 401, **dict.fromkeys(below_role("admin"), 403)}
    device = services.get_device(site="hall", device_id="mixer1")
    assert (device.lifecycle, device.name) == ("pending", "Mixer One")
    assert getattr(signed_in("admin"), method)(address, body, content_type="application/json").status_code == 200


def test_a_refusal_says_which_role_is_needed(hall: str) -> None:
    describe()
    answer = signed_in("viewer").post("/api/sites/hall/devices/mixer1/approve")
    assert answer.json()["code"] == "not_allowed"
    assert answer.json()["detail"] == "You are viewer of this site; this needs the role admin. Ask an admin for it."


def test_a_member_sees_their_sites_with_counts(hall: str) -> None:
    describe()
    services.create_site(name="Other")
    expected = {
        "slug": "hall",
        "name": "Hall",
        "role": "author",
        "machines": 0,
        "robots": 0,
        "online": 0,
        "pending": 1,
        "has_map": True,
        "stop": {"active": False, "by": "", "at": None},
        "simulated": False,
        "held_role": None,
    }
    assert signed_in("author").get("/api/sites").json() == [expected]
    assert signed_in("stranger").get("/api/sites").json() == []
    services.approve_device(site="hall", device_id="mixer1", by=None, at=NOW)
    come()
    services.set_site_stop(site="hall", active=True, by="Ada", at=NOW)
    now = signed_in("author").get("/api/sites/hall").json()
    assert (now["machines"], now["online"], now["pending"], now["simulated"]) == (1, 1, 0, True)
    assert now["stop"] == {"active": True, "by": "Ada", "at": "2026-11-21T12:00:00+00:00"}


def test_a_site_is_simulated_only_where_no_approved_device_is_real(hall: str) -> None:
    """Whoever starts a run is told that nothing real moves."""

    def is_simulated() -> bool:
        return bool(signed_in("viewer").get("/api/sites/hall").json()["simulated"])

    assert not is_simulated()
    approve(replace(MIXER, simulated=True))
    describe(replace(ROBOT, simulated=False))
    assert is_simulated()
    services.approve_device(site="hall", device_id=ROBOT.id, by=None, at=NOW)
    assert not is_simulated()
    services.retire_device(site="hall", device_id=ROBOT.id, by=None, at=NOW)
    assert is_simulated()


def test_the_map_comes_as_facts_cells_and_ros_files(hall: str) -> None:
    services.save_places(site="hall", places=[services.PlaceView("dock1", "Dock 1", "dock", 1.0, 2.0, 0.5)])
    client = signed_in("viewer")
    cells = client.get("/api/sites/hall/map/cells")
    assert client.get("/api/sites/hall/map").json() == {
        "version": 1,
        "tag": cells["ETag"],
        "width": 4,
        "height": 3,
        "resolution_m": 1.0,
        "origin": {"x": 0.0, "y": 0.0, "yaw": 0.0},
        "places": [{"id": "dock1", "name": "Dock 1", "kind": "dock", "x": 1.0, "y": 2.0, "theta": 0.5, "label": None}],
        "walls": [[0.0, 2.0, 3.0, 3.0]],
        "zones": [],
        "obstacles": [],
    }
    assert gzip.decompress(cells.content) == bytes([0] * 8 + [100] * 3 + [255])
    again = client.get("/api/sites/hall/map/cells", headers={"If-None-Match": cells["ETag"]})
    assert (again.status_code, again.content) == (304, b"")
    assert b"image: hall.pgm" in client.get("/api/sites/hall/map.yaml").content
    assert client.get("/api/sites/hall/map.pgm").content.startswith(b"P5\n4 3\n255\n")


def upload(client: Client, **files: Any) -> Any:
    return client.post("/api/sites", {"name": "Second  Hall", **files})


def test_a_site_is_made_from_a_ros_map_and_its_maker_is_admin(hall: str) -> None:
    for name, slug in (("stranger", "second-hall"), ("author", "second-hall-2")):
        services.set_site_quota(email=f"{name}@vipo.example", sites=1)
        client = signed_in(name)
        answer = upload(client, yaml=SimpleUploadedFile("m.yaml", YAML), image=SimpleUploadedFile("a.pgm", IMAGE))
        assert answer.status_code == 201
        assert (answer.json()["slug"], answer.json()["role"], answer.json()["name"]) == (slug, "admin", "Second Hall")
        assert client.get(f"/api/sites/{slug}/map").json()["width"] == 2
    assert signed_in("admin").get("/api/sites/second-hall").status_code == 404


def test_a_broken_map_makes_no_site(hall: str) -> None:
    services.set_site_quota(email="author@vipo.example", sites=1)
    client, before = signed_in("author"), Site.objects.count()
    bad = upload(client, yaml=SimpleUploadedFile("m.yaml", YAML), image=SimpleUploadedFile("a.pgm", b"P5 9 9 255\n1"))
    assert (bad.status_code, bad.json()["code"]) == (422, "bad_map")
    assert bad.json()["detail"] == "The PGM ends early: 1 of 81 cells. Copy the whole file again."
    alone = upload(client, yaml=SimpleUploadedFile("m.yaml", YAML))
    assert alone.json()["detail"] == ("The map's image 'a.pgm' is missing. Choose it together with the .yaml file.")
    big = upload(client, yaml=SimpleUploadedFile("m.yaml", b"#" * 70000), image=SimpleUploadedFile("a.pgm", IMAGE))
    assert big.status_code == 422
    files = {"yaml": SimpleUploadedFile("m.yaml", YAML), "image": SimpleUploadedFile("a.pgm", IMAGE)}
    nameless = client.post("/api/sites", {"name": " ", **files})
    assert (nameless.status_code, nameless.json()["code"]) == (422, "bad_name")
    half = client.post("/api/sites", {"name": "x", "image": SimpleUploadedFile("a.pgm", IMAGE)})
    assert (half.status_code, half.json()["code"]) == (422, "bad_map")
    assert (Site.objects.count(), Membership.objects.filter(user__email="author@vipo.example").count()) == (before, 1)


def test_nobody_uploads_without_a_session(hall: str) -> None:
    answer = upload(Client(), yaml=SimpleUploadedFile("m.yaml", YAML), image=SimpleUploadedFile("a.pgm", IMAGE))
    assert answer.status_code == 401
    assert Site.objects.count() == 1


def test_a_device_is_shown_as_the_contract_says(hall: str) -> None:
    describe()
    come()
    say(seq=3, props={"jobStatus": 10})
    body = signed_in("viewer").get("/api/sites/hall/devices").json()[0]
    assert body == signed_in("viewer").get("/api/sites/hall/devices/mixer1").json()
    assert body["status"] == "pending"
    assert body["location"] == {"x": 2.0, "y": 2.0, "z": 0.0, "theta": 0.0}
    assert body["properties"][0]["value"] == 10
    assert body["methods"][0]["topic"] == "vipo/v1/dev/mixer1/down/mix"
    assert body["last_seen_at"] == "2026-11-21T12:00:00+00:00"
    contract = {
        *(
            "id",
            "name",
            "kind",
            "device_class",
            "icon",
            "lifecycle",
            "status",
            "doing",
            "location",
            "is_placed",
            "size",
            "radius_m",
        ),
        *("properties", "methods", "gives", "takes", "capacity", "carrying", "last_seen_at", "done", "simulated"),
        *("image", "description", "stand_in", "stands_at", "has_key", "dropped", "activity", "asks"),
    }
    assert set(body) == contract


def test_a_device_is_renamed_and_moved(hall: str) -> None:
    describe()
    client = signed_in("admin")
    body = {"name": "New name", "location": {"x": 1, "y": 2}}
    answer = client.patch("/api/sites/hall/devices/mixer1", json.dumps(body), content_type="application/json")
    assert (answer.json()["name"], answer.json()["location"]["y"]) == ("New name", 2.0)
    events = client.get("/api/sites/hall/devices/mixer1/events").json()
    assert [(e["text"], e["by"]) for e in events[:2]] == [
        ("Moved to 1.00, 2.00", "Admin Person"),
        ("Renamed from Mixer One to New name", "Admin Person"),
    ]
    far = client.patch(
        "/api/sites/hall/devices/mixer1", json.dumps({"location": {"x": 1e9, "y": 0}}), content_type="application/json"
    )
    assert far.status_code == 422


def test_a_decided_device_is_not_decided_again(hall: str) -> None:
    describe()
    client = signed_in("admin")
    assert client.post("/api/sites/hall/devices/mixer1/approve").json()["lifecycle"] == "approved"
    assert client.post("/api/sites/hall/devices/mixer1/reject").status_code == 409
    assert client.post("/api/sites/hall/devices/nothing/approve").status_code == 404


@pytest.mark.parametrize("form", sorted(FORMS))
def test_a_description_can_be_had_in_every_form(hall: str, form: str) -> None:
    describe()
    path = f"/api/sites/hall/devices/mixer1/rdf?format={form}"
    answer = signed_in("viewer").get(path)
    assert read_description(answer.content) == MIXER
    assert answer["Content-Type"] == f"{CONTENT_TYPES[form]}; charset=utf-8"
    assert answer["X-Content-Type-Options"] == "nosniff"
    codes = {name: signed_in(name).get(path).status_code for name in EVERYBODY}
    assert codes == {**dict.fromkeys(ROLES, 200), "stranger": 404, "nobody": 401}


def test_a_form_that_there_is_not_is_refused(hall: str) -> None:
    describe()
    answer = signed_in("viewer").get("/api/sites/hall/devices/mixer1/rdf?format=xml")
    assert (answer.status_code, answer.json()["code"]) == (422, "bad_request")
    assert signed_in("stranger").get("/api/sites/hall/devices/mixer1/rdf?format=xml").status_code in (404, 422)


def test_a_thing_links_to_the_broker(hall: str, settings: Any) -> None:
    describe()
    settings.VIPO_BROKER_URL = "mqtts://broker.example:8883/"
    thing = signed_in("viewer").get("/api/sites/hall/devices/mixer1/rdf?format=td").json()
    assert thing["actions"]["mix"]["forms"][0]["href"] == "mqtts://broker.example:8883/vipo/v1/dev/mixer1/down/mix"


def test_a_site_without_a_map_says_so(hall: str, person: Callable[[str], User]) -> None:
    services.create_site(name="Bare", slug="bare", admin=person("author"))
    answer = signed_in("author").get("/api/sites/bare/map")
    assert (answer.status_code, answer.json()["code"]) == (404, "no_map")


TAKE_OUT_NUL = "This text holds U+0000, which is no text: take that character out, or type the text anew"


def test_characters_that_no_name_has_are_refused(hall: str) -> None:
    describe()
    services.set_site_quota(email="admin@vipo.example", sites=1)
    client = signed_in("admin")
    for path in ("/sites/ha%00ll", "/sites/hall/devices/mixer1%00", "/sites/hall/devices/a%00/events"):
        assert client.get(f"/api{path}").status_code == 404
    assert client.post("/api/sites/hall/devices/mixer%00/approve").status_code == 404
    named = client.patch("/api/sites/hall/devices/mixer1", json.dumps({"name": "a\0"}), content_type="application/json")
    assert (named.status_code, named.json()["code"]) == (422, "bad_request")
    assert named.json()["fields"] == [{"field": "body.name", "message": TAKE_OUT_NUL}]
    files = {"yaml": SimpleUploadedFile("m.yaml", YAML), "image": SimpleUploadedFile("a.pgm", IMAGE)}
    assert client.post("/api/sites", {"name": "a\0b", **files}).json()["code"] == "bad_name"


@pytest.mark.parametrize("path", ["/api/nothing", "/api/runs/x/events", "/ws/nothing"])
def test_a_call_that_does_not_exist_is_told_as_a_problem(hall: str, path: str) -> None:
    answer = signed_in("viewer").get(path)
    assert (answer.status_code, answer.headers["Content-Type"]) == (404, "application/problem+json")
    assert answer.json()["detail"] == "There is no such call. See docs/api.md."


def test_a_devices_whole_history_can_be_had(hall: str) -> None:
    describe()
    before = DeviceEvent.objects.filter(device="mixer1").count()
    lines = [DeviceEvent(device_id="mixer1", at=NOW, kind="note", text=f"{number}") for number in range(120)]
    DeviceEvent.objects.bulk_create(lines)
    address, viewer = "/api/sites/hall/devices/mixer1/events", signed_in("admin")
    newest, whole = viewer.get(address).json(), viewer.get(f"{address}?limit=1000").json()
    assert ([line["text"] for line in newest], len(whole)) == ([str(n) for n in range(119, 69, -1)], 120 + before)
    assert [viewer.get(f"{address}?limit={limit}").status_code for limit in (0, 1001)] == [422, 422]
