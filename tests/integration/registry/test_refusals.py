"""What a program meets that does not know how to go about it: each refusal is a problem that says how to mend it."""

from __future__ import annotations

import pytest
from django.test import Client

from tests.kit.sign_in import signed_in

PROBLEM = "application/problem+json"


@pytest.fixture
def admin(hall: str) -> Client:
    return signed_in("admin", enforce_csrf_checks=True)


@pytest.mark.parametrize("path", ["/api/sites", "/api/sites/hall/mtconnect/probe", "/.well-known/wot", "/events"])
def test_a_method_that_an_address_does_not_know(path: str) -> None:
    client = Client()
    refused = client.put(path)
    assert (refused.status_code, refused["Content-Type"], refused.json()["code"]) == (405, PROBLEM, "no_such_method")
    assert refused.json()["detail"] == f"PUT is not known here; known are {refused['Allow']}."
    told = client.options(path)
    assert (told.status_code, told["Allow"]) == (204, refused["Allow"])
    assert {"GET", "OPTIONS"} <= set(told["Allow"].split(", "))


def test_who_sends_no_token_learns_which_one(hall: str) -> None:
    client = signed_in("admin", enforce_csrf_checks=True)
    for refused in (
        client.post("/api/sites/hall/stop"),
        client.patch("/things/a", {}, content_type="application/json"),
    ):
        assert (refused.status_code, refused.json()["code"]) == (403, "not_allowed")
        assert "the value of the cookie csrftoken as the header X-CSRFToken" in refused.json()["detail"]


def test_who_is_signed_out_or_sends_no_json_learns_what_to_do(db: None) -> None:
    client = Client()
    assert "POST /api/sign-in" in client.get("/api/sites").json()["detail"]
    unread = client.post("/api/sign-in", "email=a", content_type="application/x-www-form-urlencoded")
    assert (unread.status_code, "Send JSON" in unread.json()["detail"]) == (400, True)


def test_what_cannot_be_read_and_what_fails_is_told_as_a_problem(
    admin: Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    much = b" " * (4 * 1024 * 1024 + 1)
    large = admin.post("/api/sign-in", much, content_type="application/json")
    assert (large.status_code, large["Content-Type"], large.json()["code"]) == (400, PROBLEM, "bad_request")
    monkeypatch.setattr("registry.services.list_devices", lambda **asked: 1 / 0)
    admin.raise_request_exception = False
    failed = admin.get("/api/sites/hall/devices")
    assert (failed.status_code, failed["Content-Type"], failed.json()["code"]) == (500, PROBLEM, "failed")
