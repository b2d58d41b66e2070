"""Comments: begun at what is drawn, answered, read, resolved, edited and deleted by whoever may."""

from __future__ import annotations

import json
from datetime import UTC, datetime
from typing import Any

import pytest
from django.test import Client

from editor import services
from editor.comments.threads import MOST_COMMENTS, MOST_IN_THREAD, MOST_THREADS, RATE
from editor.models import Comment, CommentThread
from registry import services as registry
from registry.models import AuditLine
from tests.kit.programs import document, step
from tests.kit.sign_in import add_person, find_person, signed_in

pytestmark = pytest.mark.django_db
NOTHING = dict.fromkeys(("root", "id", "to", "x", "y", "run", "number", "t_s"))
STEP = {"kind": "construct", "root": "steps", "id": "a", "x": 1.5, "y": 2.0}


@pytest.fixture
def program() -> str:
    registry.create_site(name="Hall", slug="hall")
    for role in ("viewer", "commenter", "author", "admin"):
        add_person(role, "hall")
    drawn = document({"a": step("wait", order="A", duration=1)})
    return str(services.create_program(site="hall", name="Carry", document=drawn).id)


def send(method: str, client: Client, path: str, body: Any) -> Any:
    return getattr(client, method)(f"/api/programs/{path}", json.dumps(body), content_type="application/json")


def start(program: str, who: str = "commenter", **body: Any) -> Any:
    return send("post", signed_in(who), f"{program}/threads", {"text": "Why wait?", "anchor": STEP, **body})


def threads(program: str, who: str) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = signed_in(who).get(f"/api/programs/{program}/threads").json()
    return found


def test_a_commenter_begins_a_thread_and_an_author_answers_it(program: str) -> None:
    begun = start(program, label="1 Wait").json()
    path = f"{program}/threads/{begun['id']}/comments"
    assert send("post", signed_in("author"), path, {"text": "For the paint."}).status_code == 201
    (thread,) = threads(program, "viewer")
    assert [(each["author"]["name"], each["text"]) for each in thread["comments"]] == [
        ("Commenter Person", "Why wait?"),
        ("Author Person", "For the paint."),
    ]
    assert (thread["label"], thread["stands"], thread["anchor"]) == ("1 Wait", True, {**NOTHING, **STEP})


def test_what_others_wrote_is_unread_until_it_is_read(program: str) -> None:
    begun = start(program).json()
    assert [threads(program, who)[0]["unread"] for who in ("commenter", "author")] == [0, 1]
    path = f"{program}/threads/{begun['id']}"
    assert send("post", signed_in("author"), f"{path}/read", {}).status_code == 204
    assert threads(program, "author")[0]["unread"] == 0
    send("post", signed_in("commenter"), f"{path}/comments", {"text": "And?"})
    assert threads(program, "author")[0]["unread"] == 1


def test_a_thread_is_resolved_and_opened_again(program: str) -> None:
    path = f"{program}/threads/{start(program).json()['id']}"
    resolved = send("patch", signed_in("author"), path, {"resolved": True}).json()
    assert resolved["resolved_by"]["name"] == "Author Person"
    opened = send("patch", signed_in("commenter"), path, {"resolved": False}).json()
    assert (opened["resolved_at"], opened["resolved_by"]) == (None, None)


def test_only_who_wrote_a_comment_edits_it(program: str) -> None:
    path = f"{program}/comments/{start(program).json()['comments'][0]['id']}"
    assert send("patch", signed_in("admin"), path, {"text": "Hm."}).json()["code"] == "not_theirs"
    edited = send("patch", signed_in("commenter"), path, {"text": "Why so long?"}).json()["comments"][0]
    assert edited["text"] == "Why so long?"
    assert edited["edited_at"] is not None


def test_a_comment_is_deleted_by_its_writer_or_an_admin_who_leaves_a_line(program: str) -> None:
    path = f"/api/programs/{program}/comments/{start(program).json()['comments'][0]['id']}"
    assert signed_in("author").delete(path).status_code == 409
    assert signed_in("admin").delete(path).status_code == 204
    assert threads(program, "admin") == []
    assert AuditLine.objects.get(code="comment_deleted").facts == {"program": "Carry", "author": "Commenter Person"}
    mine = start(program).json()["comments"][0]["id"]
    assert signed_in("commenter").delete(f"/api/programs/{program}/comments/{mine}").status_code == 204
    assert AuditLine.objects.filter(code="comment_deleted").count() == 1


def test_what_a_comment_is_about_has_to_be_there(program: str) -> None:
    for anchor in ({**STEP, "id": "gone"}, {"kind": "construct"}, {"kind": "arrow", "id": "a"}, {"kind": "place"}):
        assert start(program, anchor=anchor).json()["code"] == "bad_request"
    assert start(program, anchor={"kind": "place", "x": 1, "y": 2}).status_code == 201


def test_a_thread_on_a_deleted_step_says_so_and_stays(program: str) -> None:
    start(program)
    CommentThread.objects.update(anchor={**STEP, "id": "deleted"})
    (thread,) = threads(program, "viewer")
    assert (thread["stands"], thread["anchor"]["x"], thread["anchor"]["y"]) == (False, 1.5, 2.0)


def test_members_alone_are_mentioned(program: str) -> None:
    stranger, author = add_person("stranger"), find_person("author")
    assert start(program, mentions=[stranger.pk]).json()["code"] == "bad_request"
    mentioned = {"id": author.pk, "name": "Author Person", "initials": "AP"}
    assert start(program, mentions=[author.pk]).json()["comments"][0]["mentions"] == [mentioned]
    registry.remove_member(site="hall", email=author.email)
    assert threads(program, "viewer")[0]["comments"][0]["mentions"] == [mentioned]
    people = signed_in("commenter").get(f"/api/programs/{program}/people").json()
    assert [each["name"] for each in people] == ["Admin Person", "Commenter Person", "Viewer Person"]


def test_who_writes_too_fast_is_told_to_wait(program: str) -> None:
    thread = CommentThread.objects.get(pk=start(program).json()["id"])
    now, writer = datetime.now(UTC), find_person("commenter")
    Comment.objects.bulk_create(
        Comment(thread=thread, author=writer, text="!", written_at=now) for _ in range(RATE - 1)
    )
    refused = start(program)
    assert (refused.status_code, refused.json()["code"], refused["Retry-After"]) == (429, "too_many_comments", "60")
    assert start(program, "author").status_code == 201


def why_full(refused: Any) -> tuple[str, int]:
    told = refused.json()
    assert (refused.status_code, told["code"]) == (409, "comments_full")
    assert str(told["args"]["most"]) in told["detail"]
    return told["args"]["why"], told["args"]["most"]


def test_a_program_and_a_thread_hold_so_many_and_the_refusal_says_how_many(program: str) -> None:
    begun = start(program).json()
    thread = CommentThread.objects.get(pk=begun["id"])
    answers = f"{program}/threads/{thread.pk}/comments"
    then = datetime(2026, 1, 2, tzinfo=UTC)

    def fill(of: CommentThread, count: int) -> None:
        Comment.objects.bulk_create(Comment(thread=of, text="!", written_at=then) for _ in range(count))

    fill(thread, MOST_IN_THREAD - 1)
    assert why_full(send("post", signed_in("author"), answers, {"text": "One more"})) == ("thread", MOST_IN_THREAD)
    another = {"program": thread.program, "anchor": {"kind": "program"}, "started_at": then, "last_at": then}
    CommentThread.objects.bulk_create(CommentThread(**another) for _ in range(MOST_THREADS - 1))
    assert why_full(start(program)) == ("threads", MOST_THREADS)
    fill(CommentThread.objects.exclude(pk=thread.pk)[0], MOST_COMMENTS - MOST_IN_THREAD)
    assert why_full(send("post", signed_in("author"), answers, {"text": "One more"})) == ("program", MOST_COMMENTS)


def test_an_empty_or_endless_comment_is_refused(program: str) -> None:
    assert [start(program, text=text).status_code for text in ("", "  \n", "a" * 2001)] == [422, 422, 422]


def test_comments_go_with_their_program_and_stay_when_their_writer_leaves(program: str) -> None:
    start(program)
    registry.remove_member(site="hall", email="commenter@vipo.example")
    assert threads(program, "viewer")[0]["comments"][0]["author"]["name"] == "Commenter Person"
    services.delete_program(program_id=program)
    assert Comment.objects.count() == 0


def test_who_watches_the_site_is_told(program: str, django_capture_on_commit_callbacks: Any) -> None:
    heard: list[Any] = []
    end = registry.listen(lambda site, message: heard.append((site, dict(message))))
    try:
        with django_capture_on_commit_callbacks(execute=True):
            start(program)
    finally:
        end()
    assert heard == [("hall", {"type": "comments", "program": program})]


def test_two_threads_and_two_members_are_lists_as_any_others(program: str) -> None:
    for person in ("viewer", "admin"):
        registry.remove_member(site="hall", email=find_person(person).email)
    start(program), start(program)
    assert len(threads(program, "author")) == 2
    people = signed_in("author").get(f"/api/programs/{program}/people").json()
    assert [each["name"] for each in people] == ["Author Person", "Commenter Person"]
