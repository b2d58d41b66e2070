"""The Celery application; tasks live in each app's tasks.py."""

import os
from typing import Any

from celery import Celery
from celery.signals import task_postrun, worker_ready, worker_shutdown
from django.conf import settings

from vipo_device.kit.liveness_file import EVERY_S

os.environ.setdefault("DJANGO_SETTINGS_MODULE", "vipo_site.settings")
# Django's checks load all pages, which a worker does not serve; `manage.py prepare` runs them for every version.
os.environ.setdefault("CELERY_SKIP_CHECKS", "true")


def make_app(*, is_current: bool = False) -> Celery:
    """Return an application with the settings and all tasks; by the current one of a process tasks are sent.

    Importing this makes it; others are for a second worker in the same process.
    """
    made = Celery("vipo", set_as_current=is_current)
    made.config_from_object("django.conf:settings", namespace="CELERY")
    made.autodiscover_tasks()
    return made


app = make_app(is_current=True)


_heartbeats: list[Any] = []


@worker_ready.connect  # type: ignore[untyped-decorator]
def begin_to_beat(sender: Any, **_more: Any) -> None:
    """Beat from the loop that takes tasks in."""
    from registry.services import HeartbeatWriter

    heartbeat = HeartbeatWriter("worker", liveness_file=settings.VIPO_PULSE).start()
    _heartbeats.append(heartbeat)
    sender.timer.call_repeatedly(EVERY_S, heartbeat.beat)


@worker_shutdown.connect  # type: ignore[untyped-decorator]
def say_goodbye(**_more: Any) -> None:
    """End the beats in order."""
    while _heartbeats:
        _heartbeats.pop().stop()


@task_postrun.connect  # type: ignore[untyped-decorator]
def count_task(sender: Any, state: str | None = None, **_more: Any) -> None:
    """Count what this worker has finished."""
    from registry.services import count

    count(name="tasks", labels=(sender.name, state or "unknown"))
