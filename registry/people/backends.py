"""By which of Django's ways a session was begun, which it keeps: with a second factor of the provider's, or without."""

from __future__ import annotations

from typing import Any

from django.contrib.auth.backends import ModelBackend
from django.http import HttpRequest

from registry.models import User

PASSWORDS = "django.contrib.auth.backends.ModelBackend"
TWO_FACTORS = "registry.people.backends.TwoFactors"


class TwoFactors(ModelBackend):
    """Sessions whose provider vouched for a second factor; it lets nobody in by itself."""

    def authenticate(
        self, request: HttpRequest | None, username: str | None = None, password: str | None = None, **_more: Any
    ) -> None:
        """Let nobody in by a password."""

    def get_user(self, user_id: int) -> User | None:
        """Return the person of such a session, marked."""
        user = super().get_user(user_id)
        if isinstance(user, User):
            user.has_two_factors = True
            return user
        return None
