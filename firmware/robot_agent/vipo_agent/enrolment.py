"""How a robot that nobody gave a key brings its own: by the site's enrolment key (docs/protocol.md, Keys)."""

from __future__ import annotations

import logging
import random
import secrets
import threading
import time

from vipo_agent.config import Config
from vipo_agent.link import make_client, wait_until
from vipo_agent.messages import write

log = logging.getLogger("vipo_agent")
KEY_BYTES = 24
ANSWER_S = 10
LEAST_PAUSE_S, MOST_PAUSE_S = 5.0, 30.0


def make_key() -> str:
    """Return a key that nobody can guess."""
    return secrets.token_urlsafe(KEY_BYTES)


class Enrolment:
    """Enrols again and again, at times that differ from other robots', for as long as it is asked to."""

    def __init__(self, config: Config) -> None:
        self._config = config
        self._next_s = 0.0
        self._thread: threading.Thread | None = None

    def try_again(self) -> None:
        """Enrol, if it is time to; returns at once."""
        if time.monotonic() < self._next_s or (self._thread is not None and self._thread.is_alive()):
            return
        # All who enrol at a site are one client there, so they must not do it in step.
        self._next_s = time.monotonic() + random.uniform(LEAST_PAUSE_S, MOST_PAUSE_S)  # noqa: S311 - not a secret
        self._thread = threading.Thread(target=self._enrol, name="enrolment", daemon=True)
        self._thread.start()

    def _enrol(self) -> None:
        name = f"join:{self._config.site}"
        client = make_client(self._config, name, self._config.join_key)
        client.connect_async(self._config.host, self._config.port, ANSWER_S)
        client.loop_start()
        if wait_until(client.is_connected, ANSWER_S):
            topic = f"vipo/v1/join/{self._config.site}/{self._config.id}"
            said = client.publish(topic, write({"key": self._config.password}), 1)
            wait_until(said.is_published, ANSWER_S)
        else:
            log.warning("The broker does not let this robot enrol at %s.", self._config.site)
        client.disconnect()
        client.loop_stop()
