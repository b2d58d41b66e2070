"""People, and sign-ins that failed."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

from django.contrib.auth.base_user import AbstractBaseUser, BaseUserManager
from django.db import models
from django.db.models.functions import Lower
from django.utils.crypto import salted_hmac


@dataclass(frozen=True, slots=True)
class Grant:
    """What a token lets its bearer do of what its person may: at one site, and only within its scopes."""

    token_id: int
    site_id: int
    scopes: frozenset[str]


class UserManager(BaseUserManager["User"]):
    """Makes users; e-mail addresses are kept in lower case."""

    def create_user(self, *, email: str, password: str | None, display_name: str, initials: str = "") -> User:
        """Make and save a user; without a password nobody can sign in as them."""
        user = self.model(
            email=email.strip().lower(),
            display_name=display_name,
            initials=initials or initials_of(display_name),
        )
        user.set_password(password)
        user.save(using=self._db)
        return user


class User(AbstractBaseUser):
    """A person; signs in by e-mail, and may make so many sites as `site_quota` says.

    `wants_mail` is whether they want mail of any `MailQueue`.
    """

    email = models.EmailField(unique=True)
    display_name = models.CharField(max_length=100)
    initials = models.CharField(max_length=4)
    is_active = models.BooleanField(default=True)
    site_quota = models.PositiveSmallIntegerField(default=0)
    session_generation = models.PositiveIntegerField(default=0)
    wants_mail = models.BooleanField(default=True, db_default=True)
    created_at = models.DateTimeField(auto_now_add=True)

    grant: Grant | None = None
    """Set where a program asks with one of the person's tokens; None where they have signed in themselves."""

    has_two_factors = False
    """Set where a session was begun by a provider that vouched for a second factor (registry/people/backends.py)."""

    objects: ClassVar[UserManager] = UserManager()
    USERNAME_FIELD = "email"
    EMAIL_FIELD = "email"
    REQUIRED_FIELDS: ClassVar[list[str]] = ["display_name"]

    class Meta:
        """One person for each address, however it is spelt."""

        constraints = [models.UniqueConstraint(Lower("email"), name="user_email_any_case")]

    def __str__(self) -> str:
        return self.email

    def get_session_auth_hash(self) -> str:
        """Return what this person's sessions are known by; another password or generation ends all of them."""
        return self._of_generation(super().get_session_auth_hash())

    def get_session_auth_fallback_hash(self) -> Iterator[str]:
        """Yield the same by the server's former keys."""
        yield from map(self._of_generation, super().get_session_auth_fallback_hash())

    def _of_generation(self, proof: str) -> str:
        if not self.session_generation:
            return proof
        return salted_hmac(f"generation {self.session_generation}", proof).hexdigest()


class SignInFailure(models.Model):
    """A sign-in that failed or is under way, counted to slow down guessing."""

    email = models.CharField(max_length=254)
    address = models.CharField(max_length=64)
    device = models.CharField(max_length=64, default="")
    at = models.DateTimeField()

    class Meta:
        """Found by address and by e-mail within the last minutes."""

        indexes = [models.Index(fields=["address", "at"]), models.Index(fields=["email", "at"])]

    def __str__(self) -> str:
        return f"{self.email} from {self.address}"


class OpenSession(models.Model):
    """Whose a session is, and from where it is used; Django keeps the session itself, by the same key.

    `issuer`, `subject` and `sid` are of the provider by which it began, as its ID token says them; empty otherwise.
    """

    user = models.ForeignKey(User, models.CASCADE, related_name="open_sessions")
    key = models.CharField(max_length=40, unique=True)
    browser = models.CharField(max_length=40, blank=True)
    system = models.CharField(max_length=40, blank=True)
    begun_at = models.DateTimeField()
    seen_at = models.DateTimeField()
    issuer = models.CharField(max_length=255, blank=True, default="")
    subject = models.CharField(max_length=255, blank=True, default="")
    sid = models.CharField(max_length=255, blank=True, default="")

    class Meta:
        """Listed for one person, the newest first; found by what a provider calls its person or its session."""

        indexes = [
            models.Index(fields=["user", "-begun_at"]),
            models.Index(fields=["issuer", "subject"], name="session_of_provider_person"),
            models.Index(fields=["issuer", "sid"], name="session_of_provider_session"),
        ]

    def __str__(self) -> str:
        return f"{self.user_id}: {self.browser}"


def initials_of(name: str) -> str:
    """Return up to two capital letters that stand for a name; of a letter that several stand for, their first."""
    words = name.split()
    return "".join(w[0].upper()[:1] for w in (words[:1] + words[-1:] if len(words) > 1 else words))
