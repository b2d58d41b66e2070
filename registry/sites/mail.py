"""Mail, where the server has a way to send any: invitations at once, what waits in rows once it is due.

What waits is taken by one process, sent, tried again, and given up after a day.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from smtplib import SMTPException
from typing import Any

from django.conf import settings
from django.contrib.auth import get_user_model
from django.core.mail import EmailMessage
from django.db.models import Q, QuerySet

log = logging.getLogger(__name__)

TAKEN_FOR = timedelta(minutes=10)
"""After so long what a process has taken and not sent is taken by another one, or tried again."""
TOLD_WITHIN = timedelta(days=1)
"""What could not be sent within that is not sent any more."""
MOST_PEOPLE = 50
"""In one pass."""

_TEXT = """{by} invites you to {site} on VIPO, where people draw together on the map of a place what robots and \
machines shall do.

Open this link to come in; it is for you and ends on {until}:
{link}

Whoever has the link can come in by it, so do not pass it on. If you do not know {by}, leave it alone: nothing happens.

---

{by} lädt Sie zu {site} auf VIPO ein, wo Menschen gemeinsam auf den Plan eines Ortes zeichnen, was Roboter und \
Maschinen tun sollen.

Öffnen Sie diesen Link, um dazuzukommen; er ist für Sie und endet am {until}:
{link}

Wer den Link hat, kommt damit herein; geben Sie ihn also nicht weiter. Kennen Sie {by} nicht, so lassen Sie ihn: es \
geschieht nichts.
"""


_BY_ITSELF = {"Auto-Submitted": "auto-generated"}
"""So that nobody's absence answers (RFC 3834)."""


def can_mail() -> bool:
    """Tell whether the server's settings name a way to send mail (`VIPO_MAIL_HOST`)."""
    return bool(settings.EMAIL_HOST)


def mail_invitation(*, to: str, link: str, by: str, site: str, until: str) -> bool:
    """Send an invitation, and tell whether the mail server took it; waits ten seconds for it at most."""
    text = _TEXT.format(by=by, site=site, until=until, link=link)
    return send_mail(to=to, subject=f"{by}: {site} (VIPO)", text=text)


def send_mail(*, to: str, subject: str, text: str) -> bool:
    """Send a message, and tell whether the mail server took it; waits ten seconds for it at most."""
    try:
        return EmailMessage(subject=subject, body=text, to=[to], headers=_BY_ITSELF).send() == 1
    except (SMTPException, OSError, ValueError) as error:  # the last: an address that cannot be written
        log.warning("Mail could not be sent: %s", error)
        return False


@dataclass(frozen=True, slots=True, kw_only=True)
class MailQueue:
    """Mail of one kind; whoever has some to send makes a row in the transaction of what it tells of.

    `list_rows` gives the rows of all people, of any app's model that has `person` (a foreign key), `made_at`, and
    `taken_at`, which is null until a process takes the row. A row waits for `waits`, so that what comes in meanwhile
    goes into the same message. `write_letter` makes the message of one person's rows, the oldest first, and of the
    person's id: its subject and its text, in both languages; None where nothing of it is worth telling any more. Rows
    are gone once they are sent or not worth it.
    """

    list_rows: Callable[[], QuerySet[Any]]
    waits: timedelta
    write_letter: Callable[[Sequence[Any], int], tuple[str, str] | None]

    def is_due(self, *, now: datetime) -> bool:
        """Tell whether something has waited long enough."""
        return self._due(now).exists()

    def send_due(self, *, now: datetime) -> int:
        """Send each person who has waited long enough all that waits for them in one message; return how many.

        Several processes may do this at once: each person is taken by one of them. What cannot be sent is tried again;
        a process whose settings name no way to send leaves it to others, and gives it up after a day as they do.
        """
        if not can_mail():
            self.list_rows().filter(made_at__lte=now - TOLD_WITHIN).delete()
            return 0
        waiting = self._due(now).values_list("person", flat=True).distinct()[:MOST_PEOPLE]
        return sum(self._send_to(person, now) for person in list(waiting))

    def _due(self, now: datetime) -> QuerySet[Any]:
        return self._free(now).filter(made_at__lte=now - self.waits)

    def _free(self, now: datetime) -> QuerySet[Any]:
        return self.list_rows().filter(Q(taken_at=None) | Q(taken_at__lte=now - TAKEN_FOR))

    def _send_to(self, person: int, now: datetime) -> bool:
        if not self._free(now).filter(person=person).update(taken_at=now):
            return False  # another process was first
        mine = self.list_rows().filter(person=person, taken_at=now)
        mine.filter(made_at__lte=now - TOLD_WITHIN).delete()
        found = list(mine.order_by("made_at", "pk"))
        user = get_user_model().objects.get(pk=person)
        letter = self.write_letter(found, person) if found and user.is_active and user.wants_mail else None
        if letter and not send_mail(to=user.email, subject=letter[0], text=letter[1]):
            return False  # it stays taken for a while, and is tried again
        self.list_rows().filter(pk__in=[row.pk for row in found]).delete()
        return letter is not None
