"""Secrets that the database alone does not tell: sealed with the server's key, and read by its former ones, too."""

from __future__ import annotations

from base64 import urlsafe_b64encode
from collections.abc import Callable
from contextlib import suppress

from cryptography.fernet import Fernet, InvalidToken
from django.conf import settings


def server_keys() -> tuple[str, ...]:
    """Return the key that signs and seals, and behind it those that were renewed."""
    return (settings.SECRET_KEY, *settings.VIPO_FORMER_KEYS)


class Sealing:
    """Seals texts for one purpose; `derive` makes 32 bytes of a key of the server, others for each purpose."""

    def __init__(self, derive: Callable[[str], bytes]) -> None:
        self._derive = derive

    def seal(self, text: str) -> str:
        """Seal a text with the server's key."""
        return self._with(settings.SECRET_KEY).encrypt(text.encode()).decode()

    def unseal(self, sealed: str) -> tuple[str, bool]:
        """Return a text, and whether it was sealed with the server's key of today. Raises InvalidToken."""
        for number, key in enumerate(server_keys()):
            with suppress(InvalidToken):
                return self._with(key).decrypt(sealed.encode()).decode(), number == 0
        raise InvalidToken

    def _with(self, key: str) -> Fernet:
        return Fernet(urlsafe_b64encode(self._derive(key)))
