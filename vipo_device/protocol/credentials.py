"""The keys of devices: how they are made, and in which two forms they are kept, neither of which gives the key back.

`credential_hash` is what the embedded broker compares; `broker_hash` is the form that Mosquitto keeps itself, so that
its accounts can be written anew from the registry alone. Keys are random and long and need no slow hash as passwords
do.
"""

from __future__ import annotations

import base64
import hashlib
import hmac
import secrets

KEY_BYTES = 24
LEAST_CHARACTERS = 20
MOST_CHARACTERS = 128
ROUNDS = 101
SALT_BYTES = 12
"""Mosquitto 2.0 takes salts of this length only."""


def make_credential() -> str:
    """Return a new key of 192 random bits, as 32 characters of `A-Za-z0-9_-`."""
    return secrets.token_urlsafe(KEY_BYTES)


def secret_hash(secret: str) -> str:
    """Return the SHA-256 of a key in hexadecimal."""
    return hashlib.sha256(secret.encode()).hexdigest()


def broker_hash(secret: str, salt: bytes | None = None) -> str:
    """Return `$7$rounds$salt$hash`: PBKDF2 with SHA-512 as Mosquitto 2 reads it; the salt is 12 bytes."""
    salt = salt or secrets.token_bytes(SALT_BYTES)
    digest = hashlib.pbkdf2_hmac("sha512", secret.encode(), salt, ROUNDS)
    return f"$7${ROUNDS}${base64.b64encode(salt).decode()}${base64.b64encode(digest).decode()}"


def own_key(account: str, server_password: str) -> str:
    """Return the key of one of `OWN_ACCOUNTS`: it follows from the server's, which does not follow from it."""
    named = f"vipo {account.removesuffix(':')}"
    return hmac.new(server_password.encode(), named.encode(), hashlib.sha256).hexdigest()


def is_strong(secret: str) -> bool:
    """Tell whether a key that somebody brings has 20 to 128 printable ASCII characters."""
    return LEAST_CHARACTERS <= len(secret) <= MOST_CHARACTERS and secret.isascii() and secret.isprintable()
