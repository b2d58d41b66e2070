"""Play the devices that are simulated in place of real ones, of all sites, until SIGTERM or Ctrl-C."""

from __future__ import annotations

from execution.management.listener_command import ListenerCommand
from execution.stand_ins.stand_ins import StandIns


class Command(ListenerCommand):
    """`manage.py stand_ins`; one is enough, of several one plays."""

    help = __doc__ or ""
    kind = "stand-ins"
    listener = StandIns
