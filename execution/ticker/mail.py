"""All mail that waits, of any app: the ticker looks whether some is due, a worker of upkeep sends it."""

from __future__ import annotations

from datetime import datetime

from editor import services as editor

QUEUES = (editor.COMMENT_MAIL,)


def is_mail_due(now: datetime) -> bool:
    """Tell whether mail of any kind has waited long enough."""
    return any(queue.is_due(now=now) for queue in QUEUES)


def send_due_mail(now: datetime) -> int:
    """Send what has waited long enough, of each kind; return how many messages."""
    return sum(queue.send_due(now=now) for queue in QUEUES)
