"""Mosquitto's password file, written without its tool: PBKDF2 with SHA-512, 101 rounds, as Mosquitto 2 reads it."""

from __future__ import annotations

import base64
import hashlib
import secrets
from collections.abc import Mapping

ROUNDS = 101
SALT_BYTES = 12


def password_line(username: str, password: str, salt: bytes) -> str:
    """Return one line of the file; `salt` is 12 random bytes."""
    digest = hashlib.pbkdf2_hmac("sha512", password.encode(), salt, ROUNDS)
    return f"{username}:$7${ROUNDS}${base64.b64encode(salt).decode()}${base64.b64encode(digest).decode()}"


def password_file(accounts: Mapping[str, str]) -> str:
    """Return the file's text for {user name: password}."""
    lines = [password_line(name, word, secrets.token_bytes(SALT_BYTES)) for name, word in sorted(accounts.items())]
    return "\n".join([*lines, ""])
