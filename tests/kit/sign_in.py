"""People of each role, and how they come in: by a session of Django's test client, or over HTTP with the token."""

from __future__ import annotations

from typing import Any

import httpx
from django.test import Client

from registry import services
from registry.models import User

PASSWORD = "correct-horse-9"
ROLES = ("viewer", "commenter", "operator", "author", "admin")
EVERYBODY = (*ROLES, "stranger", "nobody")


def from_role(least: str) -> tuple[str, ...]:
    """Return the roles that may do all that this one may."""
    return ROLES[ROLES.index(least) :]


def below_role(least: str) -> tuple[str, ...]:
    """Return the roles that may not all that this one may."""
    return ROLES[: ROLES.index(least)]


def find_person(name: str) -> User:
    """Return the person of this name."""
    return User.objects.get(email=f"{name}@vipo.example")


def add_person(name: str, site: str = "") -> User:
    """Make a person; at a site they have the role that they are named after."""
    user = services.create_user(email=f"{name}@vipo.example", password=PASSWORD, display_name=f"{name.title()} Person")
    if site:
        services.set_member(site=site, email=user.email, role=name)
    return User.objects.get(pk=user.pk)


def signed_in(name: str, **options: Any) -> Client:
    """Return the browser of a person; `nobody` is not signed in."""
    client = Client(**options)
    if name != "nobody":
        client.force_login(find_person(name))
    return client


def join_and_sign_in(role: str, site: str) -> Client:
    """Make a person of this role at the site, a `stranger` of none, and return their browser."""
    add_person(role, site if role in ROLES else "")
    return signed_in(role)


def post_json(client: Client, path: str, body: Any = None) -> Any:
    """Send JSON to the interface, an empty object unless there is something to say."""
    return client.post(path, {} if body is None else body, content_type="application/json")


def patch_json(client: Client, path: str, body: Any) -> Any:
    """Change something, as the pages do."""
    return client.patch(path, body, content_type="application/json")


def open_page(base_url: str) -> httpx.Client:
    """Return a browser of a running server that has loaded the page, with the token that changes need."""
    client = httpx.Client(base_url=base_url, timeout=60, headers={"Origin": base_url, "Referer": base_url})
    client.headers["X-CSRFToken"] = client.get("/api/me").json()["csrf"]
    return client


def sign_in(client: httpx.Client, email: str, password: str) -> httpx.Client:
    """Sign in with a browser of a running server, and return it."""
    answer = client.post("/api/sign-in", json={"email": email, "password": password})
    assert answer.status_code == 200, answer.text
    client.headers["X-CSRFToken"] = answer.json()["csrf"]
    return client
