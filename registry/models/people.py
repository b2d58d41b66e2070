"""People, and sign-ins that failed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from django.contrib.auth.base_user import AbstractBaseUser, BaseUserManager
from django.db import models
from django.db.models.functions import Lower


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
    """A person; signs in by e-mail, and may make so many sites as `site_quota` says."""

    email = models.EmailField(unique=True)
    display_name = models.CharField(max_length=100)
    initials = models.CharField(max_length=4)
    is_active = models.BooleanField(default=True)
    site_quota = models.PositiveSmallIntegerField(default=0)
    created_at = models.DateTimeField(auto_now_add=True)

    grant: Grant | None = None
    """Set where a program asks with one of the person's tokens; None where they have signed in themselves."""

    objects: ClassVar[UserManager] = UserManager()
    USERNAME_FIELD = "email"
    EMAIL_FIELD = "email"
    REQUIRED_FIELDS: ClassVar[list[str]] = ["display_name"]

    class Meta:
        """One person for each address, however it is spelt."""

        constraints = [models.UniqueConstraint(Lower("email"), name="user_email_any_case")]

    def __str__(self) -> str:
        return self.email


class SignInFailure(models.Model):
    """A sign-in that failed, counted to slow down guessing."""

    email = models.CharField(max_length=254)
    address = models.CharField(max_length=64)
    at = models.DateTimeField()

    class Meta:
        """Found by address and by e-mail within the last minutes."""

        indexes = [models.Index(fields=["address", "at"]), models.Index(fields=["email", "at"])]

    def __str__(self) -> str:
        return f"{self.email} from {self.address}"


def initials_of(name: str) -> str:
    """Return up to two capital letters that stand for a name."""
    words = [w for w in name.split() if w]
    return "".join(w[0] for w in (words[:1] + words[-1:] if len(words) > 1 else words)).upper()
