"""People and their signing in."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from datetime import datetime, timedelta

from django.contrib.auth import authenticate
from django.core.exceptions import ValidationError
from django.core.validators import validate_email
from django.db import IntegrityError, transaction
from django.db.models import F

from registry.audit.record import note_act
from registry.errors import RegistryError
from registry.live.fanout import EVERY_SITE, publish
from registry.models import Membership, User
from registry.models.people import initials_of
from registry.people.passwords import check_new_password
from registry.people.second_factor import check_code
from registry.people.throttle import Attempt, counted

MOST_NAME = 100
FRESH = timedelta(minutes=10)


class WrongPassword(RegistryError):
    """The address or the password is wrong; which one is not said."""

    code = "wrong_password"
    status = 401


class WrongOldPassword(RegistryError):
    """Somebody who is signed in does not know the password that they want to change."""

    code = "wrong_old_password"
    status = 422


class SignOnAgain(RegistryError):
    """Somebody without a password, who proves themselves by having signed in by their provider just now."""

    code = "sign_on_again"
    status = 403


class NoPassword(RegistryError):
    """Somebody without a password who would change it."""

    code = "no_password"
    status = 409


class BadPerson(RegistryError):
    """A person that cannot be added."""

    code = "bad_person"
    status = 422


def create_user(*, email: str, password: str, display_name: str) -> User:
    """Add a person. Raises BadPerson, BadPassword."""
    check_new_password(password, User(email=email.strip().lower(), display_name=display_name))
    return _create(email, password, display_name)


def create_person(*, email: str, display_name: str) -> User:
    """Add a person without a password, who signs in by a provider. Raises BadPerson."""
    return _create(email, None, display_name)


def _create(email: str, password: str | None, display_name: str) -> User:
    email = email.strip().lower()
    if not 0 < len(display_name) <= MOST_NAME or not display_name.isprintable():
        raise BadPerson(f"A person's name has 1 to {MOST_NAME} characters, all of which can be printed.")
    try:
        validate_email(email)
        with transaction.atomic():
            return User.objects.create_user(email=email, password=password, display_name=display_name)
    except ValidationError as error:
        raise BadPerson(" ".join(error.messages)) from error
    except IntegrityError as error:
        raise BadPerson(f"There is already somebody with the address {email}.") from error


def is_known(*, email: str) -> bool:
    """Tell whether somebody signs in with this address, or did until the account was closed."""
    return User.objects.filter(email=email.strip().lower()).exists()


def change_password(*, email: str, password: str) -> None:
    """Give a known person another password; their sessions end. Raises BadPerson, BadPassword."""
    user = find_person(email=email)
    check_new_password(password, user)
    user.set_password(password)
    user.save(update_fields=["password"])
    _tell_sessions()


def rename_person(*, user: User, name: str) -> None:
    """Give a person another name, which those who see them are told from then on; the record of their sites has both.

    What was written down before (runs, versions, records) keeps the name that it has.
    """
    before = user.display_name
    if name == before:
        return
    user.display_name, user.initials = name, initials_of(name)
    with transaction.atomic():
        user.save(update_fields=["display_name", "initials"])
        for site in Membership.objects.filter(user=user).values_list("site_id", flat=True):
            note_act(site_id=site, code="renamed", facts={"before": before, "person": name}, by=name)


def close_account(*, email: str) -> None:
    """Let a person sign in no more; their sessions end for good, and what they made stays. Raises BadPerson."""
    user = find_person(email=email)
    user.is_active = False
    user.set_unusable_password()
    user.save(update_fields=["is_active", "password"])
    _tell_sessions()


def reopen_account(*, email: str, password: str) -> None:
    """Let a person sign in again, with another password. Raises BadPerson, BadPassword."""
    change_password(email=email, password=password)
    User.objects.filter(email=email.strip().lower()).update(is_active=True)


def check_own_password(*, user: User, password: str, address: str, now: datetime) -> None:
    """Make sure that somebody who is signed in knows their password.

    Raises NoPassword, WrongOldPassword, TooManyAttempts.
    """
    if not user.has_usable_password():
        raise NoPassword(
            "You have no password here, so it cannot be changed. Whoever runs this VIPO server can give you one "
            "(vipo account EMAIL --new-password)."
        )
    with checking_own_password(user=user, password=password, address=address, now=now):
        pass


@contextmanager
def checking_own_password(
    *, user: User, password: str, address: str, now: datetime, signed_on_at: datetime | None = None
) -> Iterator[None]:
    """Do something that asks for the own password; what fails within counts as an attempt, as a wrong code does.

    Who has none has to have signed in by their provider (`signed_on_at`) within the last minutes.
    Raises WrongOldPassword, SignOnAgain, TooManyAttempts.
    """
    with counted(Attempt(user.email, address, f"own:{user.pk}"), now):
        if not user.has_usable_password():
            if signed_on_at is None or now - signed_on_at > FRESH:
                raise SignOnAgain("You have no password here. Sign out, sign in again, and do this within 10 minutes.")
        elif not user.check_password(password):
            raise WrongOldPassword("The password that you have now is another one. Try again.", {"why": "old"})
        yield


def sign_out_everywhere(*, user: User) -> None:
    """End all sessions of a person."""
    User.objects.filter(pk=user.pk).update(session_generation=F("session_generation") + 1)
    _tell_sessions()


def check_sign_in(*, email: str, password: str, address: str, now: datetime, device: str = "", code: str = "") -> User:
    """Return the person whose password this is; `code` is of their second factor, if they have one.

    Attempts are counted, those without a needed code, too. `device` is a browser from which this person has signed in
    before; such are counted for themselves.

    Raises WrongPassword, SecondFactorNeeded, WrongCode, TooManyAttempts.
    """
    email = email.strip().lower().replace("\0", "")[:254]
    with counted(Attempt(email, address, device), now):
        user = authenticate(username=email, password=password)
        if not isinstance(user, User):
            raise WrongPassword("The e-mail address or the password is wrong. Check both and try again.")
        check_code(user=user, code=code, now=now)
        return user


def find_person(*, email: str) -> User:
    """Return who signs in with this address. Raises BadPerson."""
    user = User.objects.filter(email=email.strip().lower()).first()
    if user is None:
        raise BadPerson(f"Nobody signs in as {email[:100]!r}. Check the address.")
    return user


def _tell_sessions() -> None:
    """Have the watches of all processes look at once."""
    transaction.on_commit(lambda: publish(EVERY_SITE, {"type": "members"}))
