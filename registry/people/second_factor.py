"""The second factor: codes of an authenticator app (TOTP, RFC 6238), and recovery codes for when it is lost.

The app's secret is kept encrypted with a key that is made of the server's own, and is told while it is set up, never
later. A code is taken once: the step that it belongs to is moved forward by one statement, so that of two who come with
the same code at once one is let in. docs/adr/0061 has the reasons.
"""

from __future__ import annotations

import hmac
import logging
import re
import secrets
from dataclasses import dataclass
from datetime import datetime

import pyotp
import segno
from cryptography.fernet import InvalidToken
from django.db import transaction
from django.db.models import F
from django.utils.crypto import salted_hmac

from registry.audit.record import note_act
from registry.errors import RegistryError
from registry.live.fanout import EVERY_SITE, publish
from registry.models import Membership, RecoveryCode, SecondFactor, User
from registry.people.sealing import Sealing, server_keys

log = logging.getLogger(__name__)
STEP_S = 30
TOLERANCE = (0, -1, 1)
"""How many steps a clock may go wrong, the likeliest first."""
RECOVERY_CODES = 10
_LETTERS = "abcdefghjkmnpqrstuvwxyz23456789"
"""Without those that look like others."""
_HALF = 5
_DIGITS = re.compile(r"\d{6}")


class SecondFactorNeeded(RegistryError):
    """The password is right, and a code of the person's app has to come with it."""

    code = "second_factor_needed"
    status = 401


class WrongCode(RegistryError):
    """A code that is not taken: a wrong one, or one that was taken before."""

    code = "wrong_code"
    status = 422


class FactorStands(RegistryError):
    """A second factor is set up already."""

    code = "second_factor_on"
    status = 409


class NoFactor(RegistryError):
    """There is no second factor, or none that waits to be confirmed."""

    code = "second_factor_off"
    status = 409


@dataclass(frozen=True, slots=True)
class NewFactor:
    """What an app is given: the secret to type, the address that the picture holds, and the picture as a data URI."""

    secret: str
    address: str
    picture: str


@dataclass(frozen=True, slots=True)
class FactorView:
    """Whether somebody has a second factor, since when, and how many recovery codes are left."""

    since: datetime | None
    recovery_codes: int


def show_factor(*, user: User) -> FactorView:
    """Return how a person's second factor stands."""
    row = SecondFactor.objects.filter(user=user).exclude(confirmed_at=None).first()
    left = RecoveryCode.objects.filter(user=user, used_at=None).count() if row else 0
    return FactorView(row.confirmed_at if row else None, left)


def has_factor(*, user: User) -> bool:
    """Tell whether signing in as this person asks for a code."""
    return SecondFactor.objects.filter(user=user).exclude(confirmed_at=None).exists()


def begin_factor(*, user: User) -> NewFactor:
    """Make a secret that counts once a code of it was shown; one that was never confirmed ends. Raises FactorStands."""
    secret = pyotp.random_base32()
    with transaction.atomic():
        User.objects.select_for_update().get(pk=user.pk)
        if has_factor(user=user):
            raise FactorStands("You have a second factor already. Turn it off before you set up another one.")
        kept = {"secret": _SEALING.seal(secret), "confirmed_at": None, "last_step": 0}
        SecondFactor.objects.update_or_create(user=user, defaults=kept)
    address = pyotp.TOTP(secret).provisioning_uri(name=user.email, issuer_name="VIPO")
    picture = segno.make(address, error="m").svg_data_uri(scale=5, border=3, dark="#171b26", light="#ffffff")
    return NewFactor(secret, address, picture)


def confirm_factor(*, user: User, code: str, now: datetime) -> tuple[str, ...]:
    """Let the second factor count from now on; return its recovery codes, which nobody can be told again.

    All sessions of the person end, since they began without it. Raises NoFactor, WrongCode.
    """
    with transaction.atomic():
        User.objects.select_for_update().get(pk=user.pk)
        row = SecondFactor.objects.filter(user=user, confirmed_at=None).first()
        if row is None:
            raise NoFactor("Nothing waits to be confirmed. Begin to set up the second factor again.")
        if not _take_step(row, code, now):
            raise WrongCode("This code is wrong. Look whether the phone's clock is right, and try the next one.")
        SecondFactor.objects.filter(pk=row.pk).update(confirmed_at=now)
        codes = _give_codes(user)
        _end_sessions(user)
        _note(user, "second_factor_on")
    return codes


def check_code(*, user: User, code: str, now: datetime) -> None:
    """Take a code of the app, or a recovery code, of somebody who has a second factor; others need none.

    Raises SecondFactorNeeded where it is missing, WrongCode where it is wrong or was taken before.
    """
    row = SecondFactor.objects.filter(user=user).exclude(confirmed_at=None).first()
    if row is None:
        return
    if not code.strip():
        raise SecondFactorNeeded("The password is right. Now send the code of your authenticator app, too.")
    if not (_take_step(row, code, now) or _take_recovery_code(user, code, now)):
        raise WrongCode(
            "This code is wrong, or was used before. Wait for the next one of your app, or use a recovery code."
        )


def renew_recovery_codes(*, user: User, code: str, now: datetime) -> tuple[str, ...]:
    """Give other recovery codes; those before end. Raises NoFactor, WrongCode."""
    with transaction.atomic():
        _require_factor(user)
        check_code(user=user, code=code or "-", now=now)
        return _give_codes(user)


def turn_off_factor(*, user: User, code: str, now: datetime) -> None:
    """Take the second factor away, with its recovery codes. Raises NoFactor, WrongCode."""
    with transaction.atomic():
        _require_factor(user)
        check_code(user=user, code=code or "-", now=now)
        _drop(user)
        _note(user, "second_factor_off")


def reset_factor(*, user: User) -> None:
    """Take the second factor away from somebody who has lost it; all their sessions end. Raises NoFactor."""
    with transaction.atomic():
        _require_factor(user)
        _drop(user)
        _end_sessions(user)
        _note(user, "second_factor_reset")


def _require_factor(user: User) -> None:
    if not has_factor(user=user):
        raise NoFactor("There is no second factor.")


def _drop(user: User) -> None:
    SecondFactor.objects.filter(user=user).delete()
    RecoveryCode.objects.filter(user=user).delete()


def _take_step(row: SecondFactor, code: str, now: datetime) -> bool:
    """Take a code of the app, if it is one of about now and of no step that was taken before."""
    digits = re.sub(r"\s", "", code)
    if not _DIGITS.fullmatch(digits) or not digits.isascii():
        return False
    try:
        secret, is_of_today = _SEALING.unseal(row.secret)
    except InvalidToken:
        log.warning("The second factor of %s was sealed with a key that VIPO_SECRET_KEY does not name.", row.user_id)
        return False
    totp = pyotp.TOTP(secret)
    here = int(now.timestamp()) // STEP_S
    found = [here + off for off in TOLERANCE if hmac.compare_digest(totp.generate_otp(here + off), digits)]
    rows = SecondFactor.objects.filter(pk=row.pk, secret=row.secret)
    sealed = row.secret if is_of_today else _SEALING.seal(secret)
    return any(rows.filter(last_step__lt=step).update(last_step=step, secret=sealed) for step in found)


def _take_recovery_code(user: User, code: str, now: datetime) -> bool:
    rows = RecoveryCode.objects.filter(user=user, used_at=None, code_hash__in=_hashes(user, code))
    return rows.update(used_at=now) == 1


def _give_codes(user: User) -> tuple[str, ...]:
    """Keep new recovery codes in the place of those that there were."""
    codes = tuple(
        "-".join("".join(secrets.choice(_LETTERS) for _ in range(_HALF)) for _ in range(2))
        for _ in range(RECOVERY_CODES)
    )
    RecoveryCode.objects.filter(user=user).delete()
    RecoveryCode.objects.bulk_create(RecoveryCode(user=user, code_hash=_hashes(user, code)[0]) for code in codes)
    return codes


def _hashes(user: User, code: str) -> list[str]:
    """Return what a recovery code is kept as, by the server's key and then by its former ones."""
    plain = re.sub(r"[\s-]", "", code).lower()
    return [
        salted_hmac(f"vipo recovery {user.pk}", plain, secret=key, algorithm="sha256").hexdigest()
        for key in server_keys()
    ]


def _sealing_key(key: str) -> bytes:
    return salted_hmac("vipo second factor", "", secret=key, algorithm="sha256").digest()


_SEALING = Sealing(_sealing_key)


def _end_sessions(user: User) -> None:
    User.objects.filter(pk=user.pk).update(session_generation=F("session_generation") + 1)
    transaction.on_commit(lambda: publish(EVERY_SITE, {"type": "members"}))


def _note(user: User, code: str) -> None:
    """Tell all sites of somebody what became of their second factor."""
    for site in Membership.objects.filter(user=user).values_list("site_id", flat=True):
        note_act(site_id=site, code=code, facts={"person": user.display_name})
