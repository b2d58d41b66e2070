"""The Celery application; tasks live in each app's tasks.py."""

import os
from typing import Any

from celery import Celery
from celery.signals import worker_ready
from django.conf import settings

from vipo_device.kit.pulse import EVERY_S, Pulse

os.environ.setdefault("DJANGO_SETTINGS_MODULE", "vipo_site.settings")


def make_app(*, is_current: bool = False) -> Celery:
    """Return an application with the settings and all tasks; by the current one of a process tasks are sent.

    Importing this makes it; others are for a second worker in the same process.
    """
    made = Celery("vipo", set_as_current=is_current)
    made.config_from_object("django.conf:settings", namespace="CELERY")
    made.autodiscover_tasks()
    return made


app = make_app(is_current=True)


@worker_ready.connect  # type: ignore[untyped-decorator]
def show_pulse(sender: Any, **_more: Any) -> None:
    """Beat from the loop that takes tasks in."""
    sender.timer.call_repeatedly(EVERY_S, Pulse(settings.VIPO_PULSE).beat)
