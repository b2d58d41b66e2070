"""Requests with an Idempotency-Key: the first is carried out, its answer kept for a day and given again.

It is given to who may still do what was asked then. The row is written before anything happens and is unique, so of
two requests at once one goes on. Whatever ends the process between the effect and the answer leaves a row without one:
the request is never carried out a second time.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import astuple, dataclass
from datetime import datetime, timedelta

from django.db import IntegrityError, transaction

from registry.errors import RegistryError
from registry.models import KeyedRequest
from registry.people.access import Need

KEPT_FOR = timedelta(hours=24)
LONGEST = timedelta(minutes=5)
"""A request that has had no answer for so long was cut off."""
MOST_OF_OWNER = 1000
MOST_BYTES = 262_144


class KeyUsedOtherwise(RegistryError):
    """The key came with another request before."""

    code = "key_used_otherwise"
    status = 422


class UnderWay(RegistryError):
    """The first request with this key has not been answered yet."""

    code = "under_way"
    status = 409
    retry_after_s = 1


class OutcomeUnknown(RegistryError):
    """The first request with this key was cut off, or failed."""

    code = "outcome_unknown"
    status = 409


class AnswerNotKept(RegistryError):
    """The request was carried out; its answer held a secret, or was too long to be kept."""

    code = "answer_not_kept"
    status = 409


class TooManyKeys(RegistryError):
    """So many requests of one person are under way that no more can be kept."""

    code = "too_many_keys"
    status = 429


@dataclass(frozen=True, slots=True)
class KeptAnswer:
    """What the first request with a key was answered; `needs` is what it required of who asked."""

    status: int
    headers: Mapping[str, str]
    body: bytes
    needs: Sequence[Need] = ()


def begin_request(*, owner: str, key: str, fingerprint: str, now: datetime) -> KeptAnswer | None:
    """Return what the request was answered before; None when this is the first, which is now to be carried out.

    Raises KeyUsedOtherwise, UnderWay, OutcomeUnknown, AnswerNotKept, TooManyKeys.
    """
    mine = KeyedRequest.objects.filter(owner=owner, key=key)
    mine.filter(begun_at__lt=now - KEPT_FOR).delete()
    try:
        with transaction.atomic():
            KeyedRequest.objects.create(owner=owner, key=key, fingerprint=fingerprint, begun_at=now)
            _make_room(owner)
    except IntegrityError:
        row = mine.first()
        if row is None:
            raise UnderWay(_BUSY) from None
        return _answer_of(row, fingerprint, now)
    return None


_BUSY = "The first request with this Idempotency-Key is not answered yet. Ask again in a moment, with the same key."


def _answer_of(row: KeyedRequest, fingerprint: str, now: datetime) -> KeptAnswer:
    if row.fingerprint != fingerprint:
        raise KeyUsedOtherwise(
            "This Idempotency-Key came with another request before. Make a new key for each thing to be done."
        )
    if row.status == 0 and now - row.begun_at < LONGEST:
        raise UnderWay(_BUSY)
    if row.status in (0, 500):
        raise OutcomeUnknown(
            "The first request with this Idempotency-Key was cut off; it may have taken effect, and is not carried out "
            "again. Look what holds now, then send what is left with a new key."
        )
    if row.body is None or row.needs is None:
        raise AnswerNotKept(
            "This was done when the key first came; what it was answered was not kept, since it held a secret or was "
            "long. Look what holds now."
        )
    return KeptAnswer(row.status, row.headers, bytes(row.body), tuple(Need(*need) for need in row.needs))


def _make_room(owner: str) -> None:
    """Forget the oldest answers of who has many; what is under way stays."""
    mine = KeyedRequest.objects.filter(owner=owner)
    over = mine.count() - MOST_OF_OWNER
    if over > 0:
        oldest = list(mine.exclude(status=0).order_by("begun_at").values_list("pk", flat=True)[:over])
        if len(oldest) < over:
            raise TooManyKeys(
                f"{MOST_OF_OWNER} requests with an Idempotency-Key are under way. Wait for their answers."
            )
        KeyedRequest.objects.filter(pk__in=oldest).delete()


def end_request(*, owner: str, key: str, answer: KeptAnswer, is_secret: bool) -> None:
    """Keep the answer of a request that was carried out, or its failure; a refusal has changed nothing and frees it."""
    mine = KeyedRequest.objects.filter(owner=owner, key=key, status=0)
    if 400 <= answer.status < 600 and answer.status != 500:
        mine.delete()
        return
    body = None if is_secret or len(answer.body) > MOST_BYTES else answer.body
    needs = [astuple(need) for need in dict.fromkeys(answer.needs)]
    mine.update(status=answer.status, headers=dict(answer.headers), body=body, needs=needs)


def prune_keyed_requests(*, now: datetime) -> int:
    """Forget requests of the day before; returns how many."""
    return KeyedRequest.objects.filter(begun_at__lt=now - KEPT_FOR).delete()[0]
