"""Comments by e-mail: one message for all that somebody has not read within ten minutes, and none for who has."""

from __future__ import annotations

import json
import re
from concurrent.futures import ThreadPoolExecutor
from datetime import UTC, datetime, timedelta
from typing import Any

import pytest
from django.core import mail
from django.core.mail.backends.locmem import EmailBackend
from django.db import close_old_connections

from editor import services
from editor.comments.mail import MOST_COMMENTS
from editor.models import Comment, CommentNotice
from execution import tasks
from execution.ticker.ticker import Ticker
from registry import services as registry
from registry.models import User
from tests.kit.programs import document, step
from tests.kit.sign_in import add_person, find_person, signed_in

pytestmark = pytest.mark.django_db
SOON, LATER = timedelta(minutes=9), timedelta(minutes=11)
PROGRAM = {"anchor": {"kind": "program"}}


@pytest.fixture
def program(settings: Any) -> str:
    settings.EMAIL_HOST = "mail.example"
    registry.create_site(name="Hall", slug="hall")
    for role in ("viewer", "commenter", "author", "admin"):
        add_person(role, "hall")
    drawn = document({"a": step("wait", order="A", duration=1)})
    return str(services.create_program(site="hall", name="Carry", document=drawn).id)


def write(program: str, who: str, text: str = "Why?", thread: str = "", **body: Any) -> dict[str, Any]:
    path = f"/api/programs/{program}/threads" + (f"/{thread}/comments" if thread else "")
    told = {"text": text, **({} if thread else PROGRAM), **body}
    answer = signed_in(who).post(path, json.dumps(told), content_type="application/json")
    assert answer.status_code == 201, answer.content
    return dict(answer.json())


def send(after: timedelta) -> int:
    return services.COMMENT_MAIL.send_due(now=datetime.now(UTC) + after)


def told() -> list[tuple[list[str], str]]:
    return [(each.to, each.subject) for each in mail.outbox]


def test_who_is_mentioned_hears_of_all_that_waits_in_one_message(program: str) -> None:
    author = find_person("author")
    first = write(program, "commenter", "Why wait, @Author?", mentions=[author.pk])
    write(program, "admin", "And why\nhere?", mentions=[author.pk], label="1 Wait")
    write(program, "admin", "Nobody is called.")
    assert (send(SOON), told()) == (0, [])
    assert send(LATER) == 1
    assert told() == [(["author@vipo.example"], "2 comments, 2 Kommentare (VIPO)")]
    text = str(mail.outbox[0].body)
    assert text.count(f"http://testserver/programs/{program}") == 1
    assert "Carry (Hall)" in text
    assert re.search(r"Commenter Person, \d{4}-\d\d-\d\d \d\d:\d\d UTC\n  Why wait, @Author\?", text)
    assert "  And why\n  here?" in text
    assert "Nobody is called" not in text
    assert "http://testserver/account" in text
    assert (send(LATER), CommentNotice.objects.count()) == (0, 0)
    write(program, "author", "For the paint.", first["id"])
    assert send(LATER) == 1
    assert told()[1] == (["commenter@vipo.example"], "1 comment, 1 Kommentar (VIPO)")


def test_what_was_read_meanwhile_is_not_sent(program: str) -> None:
    author = find_person("author")
    read = write(program, "commenter", "Read this.", mentions=[author.pk])
    write(program, "commenter", "And this.", mentions=[author.pk])
    signed_in("author").post(f"/api/programs/{program}/threads/{read['id']}/read")
    assert send(LATER) == 1
    assert "And this." in str(mail.outbox[0].body)
    assert "Read this." not in str(mail.outbox[0].body)


def test_nobody_hears_who_does_not_want_it_has_left_or_is_gone(program: str) -> None:
    people = [find_person(who) for who in ("viewer", "author", "admin")]
    assert signed_in("viewer").get("/api/me/mail").json() == {"wanted": True, "can_mail": True}
    assert (
        signed_in("viewer").put("/api/me/mail", {"wanted": False}, content_type="application/json").status_code == 204
    )
    assert signed_in("viewer").get("/api/me/mail").json()["wanted"] is False
    write(program, "commenter", mentions=[person.pk for person in people])
    registry.remove_member(site="hall", email="author@vipo.example")
    User.objects.filter(pk=people[2].pk).update(is_active=False)
    assert (send(LATER), told(), CommentNotice.objects.count()) == (0, [], 0)


def test_a_deleted_comment_is_told_to_nobody(program: str) -> None:
    thread = write(program, "commenter", mentions=[find_person("author").pk])
    comment = thread["comments"][0]["id"]
    assert signed_in("commenter").delete(f"/api/programs/{program}/comments/{comment}").status_code == 204
    assert (send(LATER), told()) == (0, [])


def test_a_server_without_mail_keeps_nothing(program: str, settings: Any) -> None:
    settings.EMAIL_HOST = ""
    write(program, "commenter", mentions=[find_person("author").pk])
    assert not CommentNotice.objects.exists()
    assert signed_in("author").get("/api/me/mail").json() == {"wanted": True, "can_mail": False}


def test_a_worker_without_mail_leaves_what_waits_to_one_that_has_it_for_a_day(program: str, settings: Any) -> None:
    write(program, "commenter", mentions=[find_person("author").pk])
    host, settings.EMAIL_HOST = settings.EMAIL_HOST, ""
    assert (send(LATER), told(), CommentNotice.objects.count()) == (0, [], 1)
    settings.EMAIL_HOST = host
    assert (send(LATER), CommentNotice.objects.count()) == (1, 0)
    write(program, "commenter", mentions=[find_person("author").pk])
    settings.EMAIL_HOST = ""
    assert (send(timedelta(days=1, minutes=1)), CommentNotice.objects.count()) == (0, 0)


def test_what_cannot_be_sent_is_tried_again_for_a_day(program: str, monkeypatch: pytest.MonkeyPatch) -> None:
    write(program, "commenter", mentions=[find_person("author").pk])
    refuse = lambda *_: (_ for _ in ()).throw(OSError("away"))  # noqa: E731
    with monkeypatch.context() as away:
        away.setattr(EmailBackend, "send_messages", refuse)
        assert send(LATER) == 0
    assert send(LATER) == 0  # it is tried again only after a while
    assert send(LATER + timedelta(minutes=11)) == 1
    write(program, "commenter", mentions=[find_person("author").pk])
    assert send(timedelta(days=1, minutes=1)) == 0
    assert not CommentNotice.objects.exists()


def test_a_long_day_is_one_message_of_bounded_length(program: str) -> None:
    author = find_person("author").pk
    thread = write(program, "commenter", "x" * 2000, mentions=[author])["id"]
    row = Comment.objects.get()
    more = [Comment(thread_id=thread, author=row.author, text="y" * 2000, written_at=row.written_at) for _ in range(99)]
    made = Comment.objects.bulk_create(more)
    CommentNotice.objects.bulk_create(
        CommentNotice(comment=each, person_id=author, origin="https://x/", made_at=row.written_at) for each in made
    )
    assert send(LATER) == 1
    text = str(mail.outbox[0].body)
    assert mail.outbox[0].subject.startswith("100 comments")
    assert (text.count("…"), len(text) < 20_000) == (MOST_COMMENTS, True)
    assert "+ 70" in text


def test_the_ticker_asks_for_mail_that_is_due(program: str, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[str] = []
    monkeypatch.setattr("execution.mailbox.send_hint", lambda task, _name: asked.append(task))
    write(program, "commenter", mentions=[find_person("author").pk])
    ticker, now = Ticker(), datetime.now(UTC)
    ticker.tick(now)
    assert "execution.tasks.send_mail" not in asked
    ticker.tick(now + LATER)
    assert asked.count("execution.tasks.send_mail") == 1
    assert tasks.send_mail("") == 0  # by the clock nothing has waited long enough


@pytest.mark.django_db(transaction=True)
def test_of_several_processes_one_sends(program: str) -> None:
    write(program, "commenter", mentions=[find_person("author").pk])

    def once(_: int) -> int:
        try:
            return send(LATER)
        finally:
            close_old_connections()

    with ThreadPoolExecutor(4) as pool:
        assert sum(pool.map(once, range(4))) == 1
    assert len(mail.outbox) == 1


def test_who_is_mentioned_by_a_change_hears_of_it_and_the_others_not_again(program: str) -> None:
    author, admin = find_person("author").pk, find_person("admin").pk
    thread = write(program, "commenter", "Why, @Author?", mentions=[author])
    assert send(LATER) == 1
    signed_in("admin").post(f"/api/programs/{program}/threads/{thread['id']}/read")
    changed = signed_in("commenter").patch(
        f"/api/programs/{program}/comments/{thread['comments'][0]['id']}",
        json.dumps({"text": "Why, @Author and @Admin?", "mentions": [author, admin]}),
        content_type="application/json",
    )
    assert changed.status_code == 200, changed.content
    assert send(LATER) == 1
    assert told()[1] == (["admin@vipo.example"], "1 comment, 1 Kommentar (VIPO)")
    assert "Why, @Author and @Admin?" in str(mail.outbox[1].body)


def test_an_address_that_cannot_be_written_keeps_nobody_else_from_hearing(
    program: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    people = [find_person(who) for who in ("viewer", "author", "admin")]
    write(program, "commenter", mentions=[person.pk for person in people])
    sent: list[str] = []

    def send_messages(_backend: EmailBackend, messages: Any) -> int:
        (message,) = messages
        if message.to == [people[0].email]:
            raise UnicodeEncodeError("idna", message.to[0], 0, 1, "label too long")
        sent.extend(message.to)
        return 1

    monkeypatch.setattr(EmailBackend, "send_messages", send_messages)
    assert send(LATER) == 2
    assert sorted(sent) == sorted(person.email for person in people[1:])
