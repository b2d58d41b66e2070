"""`vipo account`."""

from __future__ import annotations

import secrets

import pytest
from django.test import Client

from registry import services
from registry.models import Membership, User
from tests.kit.command_line import run_vipo

NEW = "reader@vipo.example"


def status_of_signing_in(password: str) -> int:
    return (
        Client().post("/api/sign-in", {"email": NEW, "password": password}, content_type="application/json").status_code
    )


def role() -> list[str]:
    return list(Membership.objects.filter(user__email=NEW).values_list("role", flat=True))


def test_an_account_is_made_gets_a_role_and_another_password(hall: str, capsys: pytest.CaptureFixture[str]) -> None:
    code, out, err = run_vipo(capsys, "account", "Reader@vipo.example", "--name", "Line Display", "--site", "hall")
    first, second, third = out.splitlines()
    assert (code, err, first, third) == (0, "", f"{NEW} may sign in.", f"{NEW} is viewer of hall.")
    password = second.removeprefix("The password, shown this once: ")
    assert status_of_signing_in(password) == 200
    assert (role(), User.objects.get(email=NEW).initials) == (["viewer"], "LD")
    assert run_vipo(capsys, "account", NEW, "--site", "hall", "--role", "author") == (
        0,
        f"{NEW} is author of hall.\n",
        "",
    )
    assert role() == ["author"]
    _, out, _ = run_vipo(capsys, "account", NEW, "--new-password")
    assert status_of_signing_in(password) == 401
    assert status_of_signing_in(out.strip().removeprefix(f"The new password of {NEW}, shown this once: ")) == 200
    assert run_vipo(capsys, "account", NEW, "--site", "hall", "--role", "none")[1] == f"{NEW} is no member of hall.\n"
    assert role() == []
    assert run_vipo(capsys, "account", NEW)[1].startswith(f"{NEW} may sign in already. Name what to change: ")


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ((NEW, "--site", "nowhere"), "There is no site 'nowhere'."),
        ((NEW, "--site", "nowhere", "--role", "none"), "There is no site 'nowhere'."),
        (("no-address",), "Enter a valid email address."),
        ((NEW, "--name", "A" * 101), "A person's name has 1 to 100 characters, all of which can be printed."),
    ],
)
def test_what_cannot_be_changes_nothing(
    hall: str, capsys: pytest.CaptureFixture[str], arguments: tuple[str, ...], says: str
) -> None:
    before = User.objects.count()
    assert run_vipo(capsys, "account", *arguments) == (2, "", f"{says}\n")
    assert User.objects.count() == before


def test_a_password_that_is_drawn_is_no_other_word_for_the_name(monkeypatch: pytest.MonkeyPatch) -> None:
    drawn = iter(["otto-brandt-", "qX2_v9Lm-4Rt"])
    monkeypatch.setattr(secrets, "token_urlsafe", lambda _: next(drawn))
    assert services.draw_password(email="author@vipo.example", display_name="Otto Brandt") == "qX2_v9Lm-4Rt"
