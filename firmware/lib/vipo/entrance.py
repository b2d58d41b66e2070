"""How a device comes in: with the key that it keeps, with the one it was given, or by enrolment.

The newest two keys are kept: a new one is believed only once the broker has let the device in with it.
"""

import asyncio
import os
import random
from binascii import hexlify

from vipo.portable import forget, write_file

KEY_BYTES, KEPT = 24, 2
ATTEMPTS_AFTER_ENROLMENT = 3
PAUSE_S = (5, 30)


class Entrance:
    """The keys of a client; `given` is the configuration's key, `enrolment` (site, enrolment key) or None."""

    def __init__(self, client, path, given="", enrolment=None):
        self.client, self.path, self.enrolment = client, path, enrolment
        self.known = self._read()
        if given and given not in self.known:
            self.known.append(given)
        self._left = len(self.known)
        self._enrolments = 0
        client.prepare, client.on_refused = self.prepare, self.refused

    async def prepare(self):
        """Before each connection: enrol where it is time to, and hold the likeliest key ready."""
        if self._left <= 0 and self.enrolment:
            if not self.known:
                self.take(hexlify(os.urandom(KEY_BYTES)).decode())
            if self._enrolments:
                await asyncio.sleep(PAUSE_S[0] + (PAUSE_S[1] - PAUSE_S[0]) * random.random())
            self._enrolments += 1
            await self._enrol()
            self._left = ATTEMPTS_AFTER_ENROLMENT
        self.client.password = self.known[0]

    def refused(self):
        """Learn that the broker did not let the device in with its key; the next one is tried."""
        self.known = self.known[1:] + self.known[:1]
        self._left -= 1

    def came_in(self):
        """Learn that the broker let the device in: the other keys are of no use any more."""
        if len(self.known) > 1:
            self.known = self.known[:1]
            self._keep()
        self._left, self._enrolments = 1, 0

    def take(self, key):
        """Keep a new key, and for a while the one before. Raises OSError."""
        self.known = [key] + [known for known in self.known if known != key][: KEPT - 1]
        self._left = len(self.known)
        self._keep()

    async def _enrol(self):
        from vipo.enrolment import enrol

        try:
            await enrol(self.client, self.enrolment[0], self.enrolment[1], self.known[0])
        finally:
            forget("enrolment")

    def _read(self):
        try:
            with open(self.path) as file:
                return [key for key in file.read().split("\n") if is_key(key)][:KEPT]
        except OSError:
            return []

    def _keep(self):
        write_file(self.path, "\n".join(self.known))


def is_key(key):
    """Tell whether a value can be a key: 20 to 128 printable characters of ASCII."""
    return isinstance(key, str) and 20 <= len(key) <= 128 and all("!" <= c <= "~" for c in key)
