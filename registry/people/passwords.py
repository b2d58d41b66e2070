"""Which passwords are taken, and the sentence for those that are not."""

from __future__ import annotations

import secrets
from collections.abc import Callable
from contextlib import suppress
from typing import Any

from django.contrib.auth.password_validation import validate_password
from django.core.exceptions import ValidationError

from registry.errors import RegistryError
from registry.models import User

MOST_CHARACTERS = 1000
DRAWN_BYTES = 12
MOST_DRAWN = 100
_SENTENCES: dict[str, Callable[[dict[str, Any]], str]] = {
    "password_too_short": lambda facts: (
        f"The password is too short. Take one of at least {facts['min_length']} characters, such as four words."
    ),
    "password_too_common": lambda _: (
        "The password is one of those that are tried first. Take another one, such as four words that belong to you "
        "alone."
    ),
    "password_too_similar": lambda _: (
        "The password is too much like the name or the e-mail address. Take one that nobody can read off from them."
    ),
    "password_entirely_numeric": lambda _: "The password has digits only. Add letters, or take four words.",
}


class BadPassword(RegistryError):
    """A password that is not taken; `why` says it in other languages."""

    code = "bad_password"
    status = 422


def check_new_password(password: str, person: User) -> None:
    """Take a password for somebody, or say how to mend it. Raises BadPassword."""
    if not password.isprintable() or len(password) > MOST_CHARACTERS:
        raise BadPassword(
            f"A password has at most {MOST_CHARACTERS} characters, all of which can be printed. Take another one.",
            {"why": "unprintable", "most": MOST_CHARACTERS},
        )
    try:
        validate_password(password, person)
    except ValidationError as error:
        first = error.error_list[0]
        why, facts = str(first.code), dict(first.params or {})
        sentence = _SENTENCES[why](facts) if why in _SENTENCES else " ".join(error.messages)
        raise BadPassword(sentence, {"why": why.removeprefix("password_"), "least": facts.get("min_length")}) from error


def draw_password(*, email: str, display_name: str = "") -> str:
    """Return a password that nobody guesses and that is taken for this person: a drawn one may be like their name."""
    person = User(email=email.strip().lower(), display_name=display_name)
    for _ in range(MOST_DRAWN):
        password = secrets.token_urlsafe(DRAWN_BYTES)
        with suppress(BadPassword):
            check_new_password(password, person)
            break
    return password
