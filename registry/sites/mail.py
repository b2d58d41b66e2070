"""Mail, where the server has a way to send any: invitations, and what other apps have to tell."""

from __future__ import annotations

import logging
from smtplib import SMTPException

from django.conf import settings
from django.core.mail import EmailMessage

log = logging.getLogger(__name__)

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
