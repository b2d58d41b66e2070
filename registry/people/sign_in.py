"""People and their signing in."""

from __future__ import annotations

from datetime import datetime, timedelta

from django.contrib.auth import authenticate
from django.contrib.auth.password_validation import validate_password
from django.core.exceptions import ValidationError
from django.core.validators import validate_email
from django.db import IntegrityError, transaction

from registry.errors import RegistryError
from registry.models import SignInFailure, User

WINDOW = timedelta(minutes=15)
MOST_NAME = 100
MOST_FOR_PAIR, MOST_FOR_EMAIL, MOST_FOR_ADDRESS = 8, 50, 200


class WrongPassword(RegistryError):
    """The address or the password is wrong; which one is not said."""

    code = "wrong_password"
    status = 401


class TooManyAttempts(RegistryError):
    """Too many sign-ins failed within a short time."""

    code = "too_many_attempts"
    status = 429


class BadPerson(RegistryError):
    """A person that cannot be added."""

    code = "bad_person"
    status = 422


def create_user(*, email: str, password: str, display_name: str) -> User:
    """Add a person. Raises BadPerson."""
    email = email.strip().lower()
    if not 0 < len(display_name) <= MOST_NAME or not display_name.isprintable():
        raise BadPerson(f"A person's name has 1 to {MOST_NAME} characters, all of which can be printed.")
    try:
        validate_email(email)
        validate_password(password)
        with transaction.atomic():
            return User.objects.create_user(email=email, password=password, display_name=display_name)
    except ValidationError as error:
        raise BadPerson(" ".join(error.messages)) from error
    except IntegrityError as error:
        raise BadPerson(f"There is already somebody with the address {email}.") from error


def is_known(*, email: str) -> bool:
    """Tell whether somebody signs in with this address."""
    return User.objects.filter(email=email.strip().lower()).exists()


def change_password(*, email: str, password: str) -> None:
    """Give a known person another password; their sessions end. Raises BadPerson."""
    user = User.objects.filter(email=email.strip().lower()).first()
    if user is None:
        raise BadPerson(f"Nobody signs in as {email[:100]!r}. Check the address.")
    user.set_password(password)
    user.save(update_fields=["password"])


def check_sign_in(*, email: str, password: str, address: str, now: datetime) -> User:
    """Return the person whose password this is; failures are counted. Raises WrongPassword, TooManyAttempts."""
    email = email.strip().lower().replace("\0", "")[:254]
    if _is_throttled(email, address, now):
        raise TooManyAttempts("Too many sign-ins failed. Wait 15 minutes, then try again.")
    user = authenticate(username=email, password=password)
    if not isinstance(user, User):
        SignInFailure.objects.filter(at__lt=now - WINDOW).delete()
        SignInFailure.objects.create(email=email, address=address[:64], at=now)
        raise WrongPassword("The e-mail address or the password is wrong. Check both and try again.")
    SignInFailure.objects.filter(email=email, address=address[:64]).delete()
    return user


def _is_throttled(email: str, address: str, now: datetime) -> bool:
    recent = SignInFailure.objects.filter(at__gte=now - WINDOW)
    return (
        recent.filter(email=email, address=address[:64]).count() >= MOST_FOR_PAIR
        or recent.filter(email=email).count() >= MOST_FOR_EMAIL
        or recent.filter(address=address[:64]).count() >= MOST_FOR_ADDRESS
    )
