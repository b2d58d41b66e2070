"""Write Mosquitto's password file from the server's own password and the devices' credentials."""

from __future__ import annotations

import json
from argparse import ArgumentParser
from pathlib import Path
from typing import Any

from django.conf import settings
from django.core.management.base import BaseCommand, CommandError

from vipo_site.passwords import password_file


class Command(BaseCommand):
    """`manage.py mosquitto_passwords FILE [--newcomer ID …]`."""

    help = __doc__ or ""

    def add_arguments(self, parser: ArgumentParser) -> None:
        """Declare the arguments."""
        parser.add_argument("file", type=Path)
        parser.add_argument("--newcomer", action="append", default=[], help="a device that comes in with the join key")

    def handle(self, *_args: Any, **options: Any) -> None:
        """Write the file, readable for its owner's group only."""
        folder = Path(settings.VIPO_STATE_DIR) / "secrets"
        accounts: dict[str, str] = {str(settings.VIPO_MQTT["username"]): str(settings.VIPO_MQTT["password"])}
        try:
            accounts |= json.loads((folder / "devices.json").read_text())
            if options["newcomer"]:
                join_key = (folder / "join").read_text().strip()
                accounts |= {name: join_key for name in options["newcomer"] if name not in accounts}
        except OSError as error:
            raise CommandError(f"{error.filename} cannot be read. Run `manage.py seed_demo` first.") from None
        path: Path = options["file"]
        path.touch(mode=0o640)
        path.write_text(password_file(accounts))
        self.stdout.write(f"{len(accounts)} accounts written to {path}.")
