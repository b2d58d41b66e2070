"""Two people at once at sites, their zones and the library."""

from __future__ import annotations

from typing import Any

import pytest
from django.core.files.uploadedfile import SimpleUploadedFile
from django.test import Client

from editor import services as editor
from editor.models import LibraryFunction
from registry import services
from registry.models import (
    Site,
)
from tests.integration.registry.at_once.presses import (
    OF_PERSON,
    SITE,
    press_together,
    told,
)
from tests.kit.programs import document
from tests.kit.sign_in import add_person, find_person, post_json, signed_in

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
