"""The WoT directory at the standard's addresses, as a client of Things that knows nothing of VIPO goes about it."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from typing import Any
from urllib.parse import quote, urlencode, urlsplit

import pytest
from django.test import Client

from registry import services
from registry.models import Device
from tests.kit.sign_in import PASSWORD, ROLES, below_role
from tests.kit.sites import MIXER, describe
from vipo_device.descriptions.td_schema import check_thing

URN = "urn:vipo:device:"
PATCH = "application/merge-patch+json"


class ThingsClient:
    """Reads a directory's Thing Description and does what its forms say, with the secrets that it has been given."""

    def __init__(self, client: Client) -> None:
        self.http = client
        self.thing = client.get("/.well-known/wot").json()

    def do(self, kind: str, name: str, body: Any = None, headers: dict[str, str] | None = None, **values: Any) -> Any:
        """Do an affordance's first form with values for its variables."""
        form = self.thing[kind][name]["forms"][0]
        address = urlsplit(self.thing["base"].rstrip("/") + self._filled(form["href"], values))
        method = getattr(self.http, form["htv:methodName"].lower())
        data = {"data": json.dumps(body), "content_type": form["contentType"]} if body is not None else {}
        return method(f"{address.path}?{address.query}", **data, headers={**self._secrets(), **(headers or {})})

    def _secrets(self) -> dict[str, str]:
        """Return what a session needs besides its cookie, which is taken in place of the token that is asked for."""
        schemes = self.thing["securityDefinitions"]
        assert (self.thing["security"], schemes["token"]["scheme"]) == (["token"], "bearer")
        assert schemes["session"]["name"] in self.http.cookies
        return {"X-CSRFToken": self.http.cookies["csrftoken"].value}

    @staticmethod
    def _filled(template: str, values: dict[str, Any]) -> str:
        """Fill in the two kinds of variables (RFC 6570) that the standard's directory uses."""

        def query(match: re.Match[str]) -> str:
            given = {name: values[name] for name in match[1].split(",") if name in values}
            return f"?{urlencode(given)}" if given else ""

        found = re.sub(r"\{\?([a-z_,]+)\}", query, template)
        return re.sub(r"\{([a-z_]+)\}", lambda match: quote(values[match[1]], safe=""), found)


@pytest.fixture
def two_sites(hall: str) -> None:
    """Mixer a at the hall and mixer b at a shed, which only the admin and the author know."""
    services.create_site(name="Shed", slug="shed")
    for name in ("admin", "author"):
        services.set_member(site="shed", email=f"{name}@vipo.example", role="admin")
    for name, site in (("b", "shed"), ("a", "hall"), ("c", "hall")):
        topic = f"vipo/v1/dev/{name}/down/mix"
        methods = (replace(MIXER.methods[0], topic=topic),)
        services.expect_device(site=site, device_id=name, credential=name * 32, approved=False)
        describe(replace(MIXER, id=name, site=site, name=f"Mixer {'zba'['abc'.index(name)]}", methods=methods))
    Device.objects.exclude(pk="c").update(lifecycle="approved")


def signed_in(name: str) -> Client:
    """Sign in as docs/api.md tells programs to."""
    client = Client(enforce_csrf_checks=True)
    token = client.get("/api/me").json()["csrf"]
    body = {"email": f"{name}@vipo.example", "password": PASSWORD}
    answer = client.post("/api/sign-in", body, content_type="application/json", headers={"X-CSRFToken": token})
    assert answer.status_code == 200
    return client


def test_the_directory_describes_itself_to_everybody(db: None) -> None:
    answer = Client().get("/.well-known/wot")
    assert (answer.status_code, answer["Content-Type"]) == (200, "application/td+json")
    thing = answer.json()
    check_thing(thing)
    assert (thing["@type"], thing["base"], set(thing["events"])) == (
        "ThingDirectory",
        "http://testserver/",
        {"thingCreated", "thingUpdated", "thingDeleted"},
    )
    head = Client().head("/.well-known/wot")
    assert (head.status_code, head.content, head["Content-Length"]) == (200, b"", str(len(answer.content)))


def test_a_client_that_reads_the_directorys_own_description_finds_reads_and_names_things(two_sites: None) -> None:
    client = ThingsClient(signed_in("admin"))
    listed = client.do("properties", "things", limit=1, format="collection", sort_by="title", sort_order="desc").json()
    assert (listed["total"], [thing["id"] for thing in listed["members"]]) == (2, [f"{URN}a"])
    following = client.http.get(listed["next"]).json()
    assert [thing["id"] for thing in following["members"]] == [f"{URN}b"]
    assert "next" not in following

    answer = client.do("actions", "retrieveThing", id=f"{URN}b")
    check_thing(answer.json())
    renamed = client.do("actions", "partiallyUpdateThing", {"title": "Left"}, {"If-Match": answer["ETag"]}, id="b")
    assert (renamed.status_code, services.get_device(site="shed", device_id="b").name) == (204, "Left")
    assert client.do("actions", "retrieveThing", id="b")["ETag"] == renamed["ETag"]


def test_two_who_change_the_same_thing_do_not_lose_what_the_first_said(two_sites: None) -> None:
    client = ThingsClient(signed_in("admin"))
    tag = client.do("actions", "retrieveThing", id="a")["ETag"]
    assert (
        client.do("actions", "partiallyUpdateThing", {"title": "First"}, {"If-Match": tag}, id="a").status_code == 204
    )
    second = client.do("actions", "partiallyUpdateThing", {"title": "Second"}, {"If-Match": tag}, id="a")
    assert (second.status_code, second.json()["code"]) == (412, "changed")
    assert services.get_device(site="hall", device_id="a").name == "First"


def test_who_has_a_thing_already_is_not_sent_it_again(two_sites: None) -> None:
    client = signed_in("viewer")
    first = client.get("/things/a")
    again = client.get("/things/a", headers={"If-None-Match": first["ETag"]})
    assert (first.status_code, again.status_code, again.content) == (200, 304, b"")
    head = client.head("/things/a")
    assert (head.status_code, head["ETag"], head.content) == (200, first["ETag"], b"")


def test_the_lists_tag_is_another_when_a_thing_changes(two_sites: None) -> None:
    client = signed_in("admin")
    before = client.get("/things")["Link"]
    assert client.get("/things")["Link"] == before
    ThingsClient(client).do("actions", "partiallyUpdateThing", {"title": "Left"}, id="a")
    assert client.get("/things")["Link"] != before


@pytest.mark.parametrize("role", [*ROLES, "stranger", "nobody"])
def test_everybody_sees_the_things_of_their_own_sites_only(two_sites: None, role: str) -> None:
    client = Client() if role == "nobody" else signed_in(role)
    answer = client.get("/things")
    if role == "nobody":
        assert (answer.status_code, answer.json()["code"]) == (401, "signed_out")
        assert "/.well-known/wot" in answer.json()["detail"]
        assert [client.get(path).status_code for path in ("/things/a", "/events")] == [401, 401]
        return
    seen = {"stranger": [], **{each: ["a"] for each in below_role("author")}}.get(role, ["a", "b"])
    assert [thing["id"].removeprefix(URN) for thing in answer.json()] == seen
    for name in ("a", "b", "c", "d"):
        listed = name in seen or (name == "c" and role == "admin")
        assert client.get(f"/things/{quote(name)}").status_code == (200 if listed else 404)
    assert client.head("/events").status_code == 200
    token = client.cookies["csrftoken"].value
    patched = client.patch("/things/b", {"title": "Mine"}, content_type=PATCH, headers={"X-CSRFToken": token})
    assert patched.status_code == (204 if "b" in seen else 404)
    unsigned = client.patch("/things/a", {"title": "Mine"}, content_type=PATCH)
    assert unsigned.status_code == 403


@pytest.mark.parametrize(
    ("path", "status", "code"),
    [
        ("/things?limit=101", 400, "bad_request"),
        ("/things?limit=x", 400, "bad_request"),
        ("/things?format=rdf", 400, "bad_request"),
        ("/things?sort_by=colour", 501, "not_sorted"),
        ("/events/thing_eaten", 400, "bad_request"),
        ("/things/nothing", 404, "no_such_device"),
        ("/search/jsonpath?query=$", 501, "not_searched_here"),
    ],
)
def test_what_cannot_be_answered_is_a_problem_as_the_standard_has_it(
    two_sites: None, path: str, status: int, code: str
) -> None:
    answer = signed_in("viewer").get(path)
    assert (answer.status_code, answer["Content-Type"]) == (status, "application/problem+json")
    assert answer.json()["code"] == code


def test_things_are_not_made_or_deleted_over_http(two_sites: None) -> None:
    client = signed_in("admin")
    headers = {"X-CSRFToken": client.cookies["csrftoken"].value}
    for method, path, allowed in (
        ("DELETE", "/things/a", "GET, HEAD, OPTIONS, PATCH"),
        ("PUT", "/things/a", "GET, HEAD, OPTIONS, PATCH"),
        ("POST", "/things", "GET, HEAD, OPTIONS"),
        ("PUT", "/things", "GET, HEAD, OPTIONS"),
    ):
        answer = client.generic(method, path, headers=headers)
        assert (answer.status_code, answer.json()["code"]) == (405, "not_made_here")
        assert answer["Allow"] == allowed
        told = client.options(path)
        assert (told.status_code, told["Allow"], told.content) == (204, allowed, b"")
    assert client.options("/things/a")["Accept-Patch"] == PATCH
    wrong = client.patch("/things/a", {"title": "X"}, content_type="application/json", headers=headers)
    assert (wrong.status_code, wrong.json()["code"]) == (415, "not_merge_patch")
    long = client.patch("/things/a", {"title": "X" * 101}, content_type=PATCH, headers=headers)
    assert (long.status_code, long.json()["status"], long.json()["code"]) == (400, 400, "bad_device")
    assert services.get_device(site="hall", device_id="a").name == "Mixer z"
