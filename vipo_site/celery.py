"""The Celery application; tasks live in each app's tasks.py."""

import os
from typing import Any

from celery import Celery
from celery.signals import worker_ready
from django.conf import settings

from vipo_device.kit.pulse import EVERY_S, Pulse

os.environ.setdefault("DJANGO_SETTINGS_MODULE", "vipo_site.settings")
app = Celery("vipo")
app.config_from_object("django.conf:settings", namespace="CELERY")
app.autodiscover_tasks()


@worker_ready.connect  # type: ignore[untyped-decorator]
def show_pulse(sender: Any, **_more: Any) -> None:
    """Beat from the loop that takes tasks in."""
    sender.timer.call_repeatedly(EVERY_S, Pulse(settings.VIPO_PULSE).beat)
