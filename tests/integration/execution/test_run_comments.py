"""Comments on a moment of a run: begun at the run, read among those of its program by whoever may."""

from __future__ import annotations

import json
from datetime import UTC, datetime, timedelta
from typing import Any
from uuid import UUID, uuid4

import pytest
from django.test import Client

from editor import services as editor
from editor.comments.threads import MOST_THREADS, RATE
from editor.models import CommentThread
from execution.models import Run
from registry import services as registry
from registry.models import Site
from tests.kit.programs import document, step
from tests.kit.sign_in import add_person, find_person, signed_in

pytestmark = pytest.mark.django_db
START = datetime(2026, 3, 1, 9, 0, tzinfo=UTC)


@pytest.fixture
def program() -> UUID:
    registry.create_site(name="Hall", slug="hall")
    for role in ("viewer", "commenter", "author"):
        add_person(role, "hall")
    drawn = document({"a": step("wait", order="A", duration=1)})
    return editor.create_program(site="hall", name="Carry", document=drawn).id


@pytest.fixture
def run(program: UUID) -> UUID:
    return add_run(program, started_at=START, ended_at=START + timedelta(seconds=90), status="finished")


def add_run(program: UUID, **more: Any) -> UUID:
    site = Site.objects.get(slug="hall")
    run = Run.objects.create(
        id=uuid4(), site=site, number=Run.objects.count() + 7, program=program, created_at=START, **more
    )
    return UUID(str(run.id))


def begin(run: UUID, who: str = "commenter", **body: Any) -> Any:
    client = signed_in(who)
    told = {"text": "Why does it stand?", "t_s": 34.24, **body}
    return client.post(f"/api/runs/{run}/threads", json.dumps(told), content_type="application/json")


def threads(program: UUID, who: str = "viewer") -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = signed_in(who).get(f"/api/programs/{program}/threads").json()
    return found


def test_a_comment_on_a_moment_stands_among_those_of_the_program_and_is_answered_there(
    run: UUID, program: UUID
) -> None:
    author = find_person("author").pk
    begun = begin(run, label="2 Wait", mentions=[author])
    assert begun.status_code == 201, begun.content
    (thread,) = threads(program)
    assert begun.json() == {"thread": thread["id"], "program": str(program)}
    nowhere = dict.fromkeys(("root", "id", "to", "x", "y"))
    assert thread["anchor"] == {**nowhere, "kind": "moment", "run": str(run), "number": 7, "t_s": 34.2}
    assert (thread["label"], thread["stands"], thread["comments"][0]["mentions"][0]["id"]) == ("2 Wait", True, author)
    path = f"/api/programs/{program}/threads/{thread['id']}"
    answered = signed_in("author").post(f"{path}/comments", {"text": "A door."}, content_type="application/json")
    assert len(answered.json()["comments"]) == 2
    assert [threads(program, who)[0]["unread"] for who in ("viewer", "commenter", "author")] == [2, 1, 0]


def test_a_moment_after_the_last_one_is_the_last_one(run: UUID, program: UUID) -> None:
    begin(run, t_s=5000)
    assert threads(program)[0]["anchor"]["t_s"] == 90.0
    going = add_run(program, started_at=datetime.now(UTC) - timedelta(seconds=20), status="running")
    begin(going, t_s=9999)
    (newest, _) = threads(program)
    assert newest["anchor"]["run"] == str(going)
    assert 20 <= newest["anchor"]["t_s"] < 90


@pytest.mark.parametrize(
    "body",
    [
        {"t_s": -1},
        {"t_s": "34"},
        {"t_s": 1e300},
        {"t_s": True},
        {"text": " "},
        {"text": "x" * 2001},
        {"label": "a\nb"},
        {"mentions": [10**6]},
        {"mentions": list(range(21))},
        {"step": "a"},
    ],
)
def test_what_is_no_comment_on_a_moment_is_refused(run: UUID, program: UUID, body: dict[str, Any]) -> None:
    refused = begin(run, **body)
    assert 400 <= refused.status_code < 500, refused.content
    assert refused.json()["detail"]
    assert threads(program) == []


def test_who_may_not_comment_and_who_does_not_know_the_site_are_refused(run: UUID, program: UUID) -> None:
    registry.create_site(name="Other", slug="other")
    add_person("admin", "other")
    assert begin(run, "viewer").status_code == 403
    absent = begin(uuid4(), "admin")
    assert begin(run, "admin").json() == absent.json()
    assert absent.status_code == 404
    body = {"text": "Why?", "t_s": 1}
    assert Client().post(f"/api/runs/{run}/threads", body, content_type="application/json").status_code == 401
    assert threads(program) == []


def test_a_run_without_moments_and_one_whose_program_is_gone_say_so(run: UUID, program: UUID) -> None:
    waiting = begin(add_run(program))
    assert (waiting.status_code, waiting.json()["detail"]) == (
        409,
        "Run 8 has not begun, so it has no moments yet. Comment on the program.",
    )
    editor.delete_program(program_id=program)
    gone = begin(run)
    assert (gone.status_code, gone.json()["detail"]) == (
        404,
        "The program of this run has been deleted, and its comments with it.",
    )


def test_moments_are_bounded_with_all_other_comments(run: UUID, program: UUID) -> None:
    made = [begin(run).status_code for _ in range(RATE + 1)]
    assert made == [201] * RATE + [429]
    rows = [
        CommentThread(program_id=program, anchor={"kind": "program"}, started_at=START, last_at=START)
        for _ in range(MOST_THREADS - RATE)
    ]
    CommentThread.objects.bulk_create(rows)
    full = begin(run, "author")
    assert (full.status_code, full.json()["args"]["why"]) == (409, "threads")


def test_the_editor_takes_no_moment_that_nobody_looked_up(program: UUID) -> None:
    anchor = {"kind": "moment", "run": str(uuid4()), "t_s": 1}
    client = signed_in("commenter")
    path = f"/api/programs/{program}/threads"
    asked = client.post(path, json.dumps({"text": "?", "anchor": anchor}), content_type="application/json")
    assert asked.status_code == 422
