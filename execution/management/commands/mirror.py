"""Run the mirror of all sites until SIGTERM or Ctrl-C."""

from __future__ import annotations

from execution.management.listener_command import ListenerCommand
from execution.mirror.mirror import Mirror


class Command(ListenerCommand):
    """`manage.py mirror`; one is enough."""

    help = __doc__ or ""
    kind = "mirror"
    listener = Mirror
