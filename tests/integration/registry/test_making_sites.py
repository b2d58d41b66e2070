"""Who may make a site, how many, and what it may be called."""

from __future__ import annotations

import importlib
import io
import zipfile
from typing import Any

import pytest
from django.apps import apps
from django.core.files.uploadedfile import SimpleUploadedFile
from django.test import Client

from registry import services
from registry.bounds.slots import Claim
from registry.maps import uploads
from registry.models import Site, User
from tests.kit.command_line import run_vipo
from tests.kit.sign_in import find_person, signed_in

YAML = b"image: a.pgm\nresolution: 0.05\norigin: [-1, -2, 0]\n"
IMAGE = b"P5 2 2 255\n" + bytes([254, 0, 205, 254])


def upload(client: Client, image: bytes = IMAGE, name: str = "Shed") -> Any:
    files = {"yaml": SimpleUploadedFile("m.yaml", YAML), "image": SimpleUploadedFile("a.pgm", image)}
    return client.post("/api/sites", {"name": name, **files})


def told(client: Client) -> bool:
    return bool(client.get("/api/me").json()["may_create_sites"])


@pytest.mark.parametrize("name", ["stranger", "viewer", "operator", "author", "admin"])
def test_nobody_makes_a_site_without_the_right_to(hall: str, name: str) -> None:
    client = signed_in(name)
    for image in (IMAGE, b"no image"):
        answer = upload(client, image)
        assert (answer.status_code, answer.json()["code"]) == (403, "may_not_create_sites")
    assert (told(client), Site.objects.count()) == (False, 1)


def test_one_makes_as_many_sites_as_one_may(hall: str) -> None:
    services.set_site_quota(email="stranger@vipo.example", sites=2)
    client = signed_in("stranger")
    assert (upload(client).status_code, told(client)) == (201, True)
    assert (upload(client, name="Yard").status_code, told(client)) == (201, False)
    answer = upload(client, name="Dock")
    assert (answer.status_code, answer.json()["code"]) == (403, "site_quota_reached")
    assert list(Site.objects.values_list("slug", flat=True).order_by("slug")) == ["hall", "shed", "yard"]


def test_no_two_sites_of_a_person_have_one_name(hall: str) -> None:
    for name in ("stranger", "author"):
        services.set_site_quota(email=f"{name}@vipo.example", sites=5)
    client = signed_in("stranger")
    assert upload(client, name="Große Halle").status_code == 201
    for name, image in (("Große Halle", b"no image"), ("  GROSSE   halle\n", IMAGE)):
        answer = upload(client, image, name=name)
        assert (answer.status_code, answer.json()["code"]) == (409, "name_taken")
        assert answer.json()["args"] == {"why": "site", "name": "Große Halle"}
    assert answer.json()["detail"] == (
        "You have a site 'Große Halle' already. Choose another name, so that nobody takes one for the other."
    )
    assert client.post("/api/sites", {"name": "große halle"}).json()["code"] == "name_taken", "an empty one, too"
    assert upload(client, name="Große Halle 2").status_code == 201
    assert list(Site.objects.order_by("pk").values_list("name", flat=True)) == ["Hall", "Große Halle", "Große Halle 2"]


def test_what_sites_of_others_are_called_is_not_learnt_by_making_one(hall: str) -> None:
    services.set_site_quota(email="stranger@vipo.example", sites=2)
    services.set_site_quota(email="author@vipo.example", sites=2)
    assert upload(signed_in("author")).status_code == 201
    client = signed_in("stranger")
    made = [upload(client, name=name) for name in ("Hall", "Shed")]
    assert [answer.status_code for answer in made] == [201, 201]
    services.set_member(site="shed", email="stranger@vipo.example", role="viewer")
    assert [site["name"] for site in client.get("/api/sites").json()] == ["Hall", "Shed", "Shed"], "both go on"


def test_a_name_is_free_again_to_whom_its_site_is_closed(hall: str) -> None:
    services.set_site_quota(email="viewer@vipo.example", sites=1)
    client = signed_in("viewer")
    assert upload(client, name="hall").json()["code"] == "name_taken"
    services.remove_member(site="hall", email="viewer@vipo.example")
    assert upload(client, name="hall").status_code == 201


def test_leaving_a_site_that_one_made_makes_no_room_for_another(hall: str) -> None:
    services.set_site_quota(email="stranger@vipo.example", sites=1)
    client = signed_in("stranger")
    assert upload(client).status_code == 201
    services.remove_member(site="shed", email="stranger@vipo.example")
    assert upload(client).json()["code"] == "site_quota_reached"


def test_a_stranger_is_told_of_no_right(hall: str) -> None:
    assert not told(Client())


def test_the_right_is_given_and_taken_at_the_terminal(hall: str, capsys: pytest.CaptureFixture[str]) -> None:
    email = "stranger@vipo.example"
    assert run_vipo(capsys, "account", email, "--sites", "3") == (0, f"{email} may make 3 sites in all.\n", "")
    assert find_person("stranger").site_quota == 3
    assert run_vipo(capsys, "account", email, "--sites", "0")[0] == 0
    assert find_person("stranger").site_quota == 0
    assert run_vipo(capsys, "account", email, "--sites", "1001") == (
        2,
        "",
        "A person may make 0 to 1000 sites, not 1001.\n",
    )
    assert find_person("stranger").site_quota == 0


def test_who_was_admin_of_a_site_keeps_the_right(hall: str) -> None:
    migration = importlib.import_module("registry.migrations.0011_site_quota")
    migration.keep_the_right(apps, None)
    kept = dict(User.objects.values_list("email", "site_quota"))
    assert kept.pop("admin@vipo.example") == 10
    assert set(kept.values()) == {0}


def test_one_map_of_a_person_is_read_at_a_time(hall: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(uploads, "READING_PATIENCE_S", 0.0)
    for name in ("stranger", "author"):
        services.set_site_quota(email=f"{name}@vipo.example", sites=1)
    claim = Claim(find_person("stranger").pk)
    assert uploads.reading_slots.take(claim)
    refused, other = upload(signed_in("stranger")), upload(signed_in("author"))
    uploads.reading_slots.give_back(claim)
    assert (refused.status_code, refused.json()["code"], refused["Retry-After"]) == (429, "too_many_uploads", "5")
    assert (other.status_code, upload(signed_in("stranger")).status_code) == (201, 201)


def test_a_site_may_begin_without_a_map_and_from_an_archive(hall: str) -> None:
    services.set_site_quota(email="stranger@vipo.example", sites=2)
    client = signed_in("stranger")
    empty = client.post("/api/sites", {"name": "Bare"}).json()
    assert (empty["slug"], empty["role"], empty["has_map"]) == ("bare", "admin", False)
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        archive.writestr("m/shed.yaml", YAML)
        archive.writestr("m/a.pgm", IMAGE)
    sent = {"name": "Shed", "archive": SimpleUploadedFile("shed.zip", packed.getvalue())}
    assert client.post("/api/sites", sent).json()["has_map"] is True
    assert services.get_map(site="shed").grid.cells == bytes([255, 0, 0, 100])
