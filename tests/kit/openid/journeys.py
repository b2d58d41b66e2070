"""Going to a provider and coming back, as a browser does, and what the record tells of it."""

from __future__ import annotations

from typing import Any

from django.test import Client

from registry.models import AuditLine
from tests.kit.openid import OpenId, answer_of, visit
from tests.kit.sign_in import PASSWORD, post_json, signed_in

AT = "/api/sign-in/providers/acme"


def begin(client: Client, **wanted: str) -> str:
    """Begin a sign-on; return the provider's address that it leads to."""
    answer = post_json(client, AT, wanted)
    assert answer.status_code == 200, answer.content
    return str(answer.json()["address"])


def finish(client: Client, given: dict[str, str], **more: str) -> Any:
    """Bring the provider's answer back."""
    return post_json(client, f"{AT}/finish", {**answer_of(given), **more})


def come(
    client: Client, name: str, *, next: str = "", amr: str = "", acr: str = "", do: str = "in", **wanted: str
) -> Any:
    """Go the whole way as a browser does."""
    return finish(client, visit(begin(client, next=next, **wanted), name, amr=amr, acr=acr, do=do))


def link(name: str, subject: str, openid: OpenId) -> Client:
    """Link a person who is signed in with an account of the provider, and return their browser."""
    client = signed_in(name)
    address = post_json(client, "/api/me/sign-ons", {"provider": "acme", "password": PASSWORD}).json()["address"]
    assert finish(client, visit(address, subject)).status_code == 200
    return client


def why(answer: Any) -> tuple[int, str]:
    """Return the status and the reason of a refusal."""
    told = answer.json()
    assert told["code"] == "sign_on_failed", told
    return answer.status_code, told["args"]["why"]


def refusals() -> list[tuple[str, str]]:
    """Return whom the record tells of, and why they were refused."""
    lines = AuditLine.objects.filter(code="sign_on_refused").order_by("pk")
    return [(line.facts.get("person", ""), line.facts["why"]) for line in lines]


def who_is(client: Client) -> str | None:
    """Return the address of who is signed in, if anybody is."""
    user = client.get("/api/me").json()["user"]
    return user["email"] if user else None
