"""The demo's accounts: the file that has their passwords, and their end."""

from __future__ import annotations

import json
from pathlib import Path

from registry.models import User

FILE = "demo-accounts.json"


def read_accounts(*, state: Path) -> list[dict[str, str]]:
    """Return e-mail address, password and role of each account; none where the demo was never made."""
    try:
        accounts: list[dict[str, str]] = json.loads((state / FILE).read_text())
    except FileNotFoundError:
        return []
    return accounts


def end_accounts(*, state: Path) -> list[str]:
    """Take the known passwords from the demo's accounts, so that nobody signs in with them and their sessions end.

    Who was given another password since keeps it. Returns the addresses; makes the file go, so that the demo, started
    again, makes new passwords.
    """
    ended = []
    for account in read_accounts(state=state):
        user = User.objects.filter(email=account["email"]).first()
        if user is not None and user.check_password(account["password"]):
            user.set_unusable_password()
            user.save(update_fields=["password"])
            ended.append(user.email)
    (state / FILE).unlink(missing_ok=True)
    return ended
