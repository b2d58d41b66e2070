"""Two people at once at sites, their zones and the library."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from django.core.files.uploadedfile import SimpleUploadedFile
from django.db import transaction
from django.test import Client

from editor import services as editor
from editor.models import LibraryFunction
from registry import services
from registry.models import Device, Place, Site
from tests.integration.registry.at_once.presses import (
    OF_PERSON,
    SITE,
    press_together,
    told,
)
from tests.kit.databases import Aside, one_waits
from tests.kit.programs import document
from tests.kit.sign_in import add_person, find_person, post_json, signed_in
from tests.kit.sites import MIXER, NOW, approve, describe
from tests.kit.waiting import wait_for

pytestmark = pytest.mark.servers


def make_sites(url: str, *names: str) -> list[Any]:
    """Let the author make sites of these names at once, each out of a map."""
    yaml = "image: map.pgm\nresolution: 1\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.25\n"

    def upload(client: Client, name: str) -> Any:
        files = {
            "yaml": SimpleUploadedFile("map.yaml", yaml.encode()),
            "image": SimpleUploadedFile("map.pgm", b"P5 2 2 255\n" + bytes([254] * 4)),
        }
        return client.post("/api/sites", {"name": name, **files})

    clients = [(signed_in("author"), name) for name in names]
    return press_together(url, OF_PERSON, *(lambda c=client, n=name: upload(c, n) for client, name in clients))


def test_who_may_make_one_more_site_makes_one(url: str) -> None:
    services.set_site_quota(email="author@vipo.example", sites=1)
    answers = make_sites(url, "A", "B")
    made = told(answers).index(201)
    assert told(answers)[1 - made] == (403, "site_quota_reached")
    assert list(Site.objects.exclude(slug="hall").values_list("name", flat=True)) == ["AB"[made]]


def test_who_makes_two_sites_of_one_name_at_once_makes_one(url: str) -> None:
    services.set_site_quota(email="author@vipo.example", sites=2)
    answers = make_sites(url, "Shed", "shed")
    assert sorted(told(answers), key=str) == [(409, "name_taken"), 201]
    assert Site.objects.exclude(slug="hall").count() == 1


def test_of_two_who_publish_one_name_at_once_one_is_told_to_take_another(url: str) -> None:
    services.set_member(site="hall", email=add_person("second").email, role="author")
    drawn = document({}, functions={"f": {"name": "Greet", "parameters": []}})
    body = {"program": str(editor.create_program(site="hall", name="Source", document=drawn).id), "function": "f"}
    first, second = signed_in("author"), signed_in("second")
    answers = press_together(
        url,
        "LOCK TABLE editor_libraryfunction IN EXCLUSIVE MODE",
        lambda: post_json(first, f"{SITE}/library", {**body, "name": "Greet"}),
        lambda: post_json(second, f"{SITE}/library", {**body, "name": "Greet"}),
    )
    winner = ["author", "second"][[answer.status_code for answer in answers].index(201)]  # the lock lets both go on
    assert sorted(told(answers), key=str) == [(409, "name_taken"), 201]
    function = LibraryFunction.objects.get()
    assert (function.author, function.last_version) == (find_person(winner), 1)


def test_a_zone_is_opened_while_an_admin_draws_it_anew_and_both_are_done(url: str) -> None:
    zone = services.ZoneChange(name="Gate", rule="release", points=[(0.5, 0.5), (2.5, 0.5), (2.5, 1.5)])
    services.add_zone(site="hall", zone=zone)
    operator, admin = signed_in("operator"), signed_in("admin")
    opened, drawn = press_together(
        url,
        "SELECT 1 FROM registry_sitezone FOR UPDATE",
        lambda: operator.put(f"{SITE}/zones/gate/opening", {"minutes": 5}, content_type="application/json"),
        lambda: admin.patch(f"{SITE}/zones/gate", {"name": "The gate"}, content_type="application/json"),
    )
    assert told([opened, drawn]) == [200, 200]
    assert (drawn.json()["name"], drawn.json()["open_until"]) == ("The gate", opened.json()["open_until"])


@pytest.mark.parametrize("thing", ["place", "zone"])
def test_what_is_removed_while_an_admin_changes_it_is_gone_and_the_other_is_told(url: str, thing: str) -> None:
    if thing == "place":
        services.add_place(site="hall", place=services.PlaceChange(name="Gate", x=0.5, y=0.5))
    else:
        corners = [(0.5, 0.5), (2.5, 0.5), (2.5, 1.5)]
        services.add_zone(site="hall", zone=services.ZoneChange(name="Gate", rule="keep_out", points=corners))
    first, second = signed_in("admin"), signed_in("chief")
    table = "registry_place" if thing == "place" else "registry_sitezone"
    removed, changed = press_together(
        url,
        f"SELECT 1 FROM {table} FOR UPDATE",
        lambda: first.delete(f"{SITE}/{thing}s/gate"),
        lambda: second.patch(f"{SITE}/{thing}s/gate", {"name": "The gate"}, content_type="application/json"),
    )
    assert told([removed, changed]) == [204, (404, f"no_such_{thing}")]


def add_gate() -> str:
    return services.add_place(site="hall", place=services.PlaceChange(name="Gate", x=0.5, y=0.5)).id


def ids() -> tuple[list[str], list[str]]:
    """Return the ids of places, and of devices that take part."""
    approved = Device.objects.filter(lifecycle="approved").values_list("pk", flat=True)
    return list(Place.objects.values_list("key", flat=True)), list(approved)


DEVICE = replace(MIXER, id="gate", methods=())


def test_a_device_that_comes_while_a_place_of_its_id_is_made_waits_for_it_and_is_not_approved(
    url: str, aside: Aside
) -> None:
    with transaction.atomic():
        assert add_gate() == "gate"
        later = aside(approve, DEVICE)
        wait_for("the device", lambda: later.done() or one_waits())
    with pytest.raises(services.BadDevice, match="has the id of the place"):
        later.result(60)
    assert ids() == (["gate"], [])


def test_a_place_that_is_made_while_a_device_of_its_id_comes_was_first(url: str, aside: Aside) -> None:
    with transaction.atomic():
        describe(DEVICE)
        assert aside(add_gate).result(60) == "gate"
    with pytest.raises(services.BadDevice, match="has the id of the place"):
        services.approve_device(site="hall", device_id="gate", by=None, at=NOW)
    assert ids() == (["gate"], [])


def test_a_place_that_is_made_while_a_device_of_its_id_is_approved_gets_another_one(url: str, aside: Aside) -> None:
    describe(DEVICE)
    with transaction.atomic():
        services.approve_device(site="hall", device_id="gate", by=None, at=NOW)
        assert aside(add_gate).result(60) == "gate_2"
    assert ids() == (["gate_2"], ["gate"])
