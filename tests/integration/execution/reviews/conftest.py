"""A site that demands approvals, its people, and a program that starts by hand and by itself."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any
from uuid import UUID

import pytest
from django.test import Client

from editor import services as editor
from editor.documents.shared_document import SharedDocument
from editor.documents.store import Change, append_changes, load_document
from editor.reviews.rules import LeastRole, set_rule
from registry import services as registry
from tests.kit.programs import SITE, document, step
from tests.kit.sign_in import add_person, find_person, post_json, signed_in

HOT = {"op": ">", "args": [{"property": ["curingOven01", "temperature"]}, 60]}
STARTER = document(
    {
        "w": step("wait", duration=5),
        "e": step("on_event", ("program", "events"), condition=HOT, starts="run"),
        "f": step("wait", ("e", "body"), duration=1),
    }
)
PEOPLE = {"ann": "author", "bob": "author", "olga": "operator", "vera": "viewer", "root": "admin"}


@dataclass
class Team:
    """The people of the site and their program: they draw, ask, approve and start."""

    program: UUID

    def demand(self, approvals: int, least_role: LeastRole = "author") -> None:
        set_rule(site=SITE, approvals=approvals, least_role=least_role)

    def draw(self, who: str, seconds: float) -> None:
        """Let somebody make the wait of the program that long."""
        waits = {"params": {"duration": seconds}}
        self.change(who, lambda now: {"steps": {**now["steps"], "w": {**now["steps"]["w"], **waits}}})

    def change(self, who: str, news: Callable[[dict[str, Any]], dict[str, Any]]) -> None:
        """Let somebody draw: what is said of the document replaces what it had, and is stored as by a room."""
        shared = SharedDocument(load_document(self.program).updates)
        before, now = shared.state(), shared.to_json()
        shared.change_to({**now, **news(now)})
        append_changes(self.program, [Change(find_person(who).pk, shared.encode(before))], datetime.now(UTC))

    def pin(self, who: str = "ann") -> int:
        return editor.pin_version(program_id=self.program, user=find_person(who)).number

    def say(self, who: str, verdict: str, number: int | None = None, note: str = "") -> Any:
        body = {"version": number or self.pin(), "verdict": verdict, "note": note}
        return self.post(who, f"/programs/{self.program}/review", body)

    def look(self, who: str = "ann", number: int | None = None) -> Any:
        query = f"?version={number}" if number else ""
        return signed_in(who).get(f"/api/programs/{self.program}/review{query}").json()

    def start(self, who: str = "olga", **body: Any) -> Any:
        return self.post(who, f"/programs/{self.program}/runs", body)

    @staticmethod
    def post(who: str, path: str, body: Any, **options: Any) -> Any:
        return post_json(signed_in(who, **options), f"/api{path}", body)


@pytest.fixture
def team(factory: Any) -> Team:
    for name, role in PEOPLE.items():
        person = add_person(name)
        registry.set_member(site=SITE, email=person.email, role=role)
    made = editor.create_program(site=SITE, name="Heat", document=STARTER, user=find_person("ann"))
    return Team(made.id)


@pytest.fixture
def bearer() -> Callable[[str], Client]:
    """Return a program of somebody's, which comes with a token for runs."""

    def make(who: str) -> Client:
        token = registry.create_token(
            user=find_person(who), site=SITE, name="Line", scopes=["run"], days=1, now=datetime.now(UTC)
        )[1]
        return Client(enforce_csrf_checks=True, headers={"Authorization": f"Bearer {token}"})

    return make
