"""Write Mosquitto's accounts from the registry: those of VIPO's processes, the sites' for enrolment, the devices'."""

from __future__ import annotations

import os
from argparse import ArgumentParser
from pathlib import Path
from typing import Any

from django.conf import settings
from django.core.management.base import BaseCommand

from registry import services
from vipo_device.protocol.credentials import broker_hash, own_key
from vipo_device.protocol.topics import OWN_ACCOUNTS


class Command(BaseCommand):
    """`manage.py broker_accounts FILE`; run it before the broker starts, which reads the file then only."""

    help = __doc__ or ""
    requires_system_checks = ()  # it serves no pages, and starts a second sooner

    def add_arguments(self, parser: ArgumentParser) -> None:
        """Declare the arguments."""
        parser.add_argument("file", type=Path)

    def handle(self, *_args: Any, **options: Any) -> None:
        """Write the file whole or not at all, readable for its owner only."""
        server, password = str(settings.VIPO_MQTT["username"]), str(settings.VIPO_MQTT["password"])
        own = {name: broker_hash(own_key(name, password)) for name in OWN_ACCOUNTS}
        hashes = {**services.list_broker_hashes(), **own, server: broker_hash(password)}
        path: Path = options["file"]
        part = path.with_name(path.name + ".part")
        part.unlink(missing_ok=True)
        with os.fdopen(os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w") as file:
            file.write(
                services.account_file(
                    hashes, services.list_account_sites(), services.list_granted_topics(), server=server
                )
            )
        part.replace(path)
        self.stdout.write(f"{len(hashes)} accounts written to {path}.")
