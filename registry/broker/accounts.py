"""The broker's accounts: whoever may come in, told to the broker that runs.

Mosquitto keeps accounts of its own, in its dynamic security plugin, and is told of every change; a connection whose
account changes or goes is ended by it at once. The embedded broker asks the registry itself and is only woken.
"""

from __future__ import annotations

import json
import logging
import secrets
import threading
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Protocol

from django.conf import settings
from django.db import transaction
from django.utils.module_loading import import_string

from registry.broker.mosquitto_file import find_hearing_all_stops, role_of
from registry.errors import RegistryError
from registry.live.fanout import wait_wake, wake
from vipo_device.protocol.mqtt_client import MqttClient
from vipo_device.protocol.topics import reader_name

log = logging.getLogger(__name__)
CONTROL = "$CONTROL/dynamic-security/v1"
BROKER_CHANNEL = "broker"
ANSWER_LIMIT_S = 10.0
PAGE = 200
Command = Mapping[str, Any]


class BrokerAway(RegistryError):
    """The broker does not take a change of its accounts."""

    code = "broker_away"
    status = 503


@dataclass(frozen=True, slots=True)
class Account:
    """Who may come in, and with which key: a device by its id, `join:<site>` to enrol there, `token:<id>` to hear.

    `site` is a device's or a token's, `topics` are a device's legacy ones.
    """

    name: str
    key: str
    topics: tuple[str, ...] = ()
    site: str = ""


class BrokerAccounts(Protocol):
    """What a broker can be told."""

    def put(self, account: Account) -> None:
        """Let somebody in with this key and no other; ends their connections. Raises BrokerAway."""

    def allow(self, name: str, site: str, topics: tuple[str, ...]) -> None:
        """Let a device hear this site's stop and these legacy topics only; ends its connections. Raises BrokerAway."""

    def remove(self, name: str) -> None:
        """Let somebody in no more; ends their connections. Raises BrokerAway."""

    def names(self) -> frozenset[str] | None:
        """Return who has an account, None for a broker that keeps none. Raises BrokerAway."""

    def find_outdated(self) -> frozenset[str]:
        """Return which devices may hear the stops of all sites, as accounts of earlier versions do. Raises BrokerAway.

        They are to be allowed anew.
        """


class AskedAccounts:
    """For a broker that asks the registry: it looks again at who is connected once the change is kept."""

    def put(self, account: Account) -> None:
        """See BrokerAccounts."""
        self.remove(account.name)

    def allow(self, name: str, _site: str, _topics: tuple[str, ...]) -> None:
        """See BrokerAccounts."""
        self.remove(name)

    def remove(self, _name: str) -> None:
        """See BrokerAccounts."""
        transaction.on_commit(lambda: wake(BROKER_CHANNEL))

    def names(self) -> frozenset[str] | None:
        """See BrokerAccounts."""
        return None

    def find_outdated(self) -> frozenset[str]:
        """See BrokerAccounts."""
        return frozenset()


class DynamicSecurity:
    """Mosquitto's plugin of that name, over a connection of the server's account that lives for one change."""

    def put(self, account: Account) -> None:
        """See BrokerAccounts."""
        role = role_of(account.name, account.site, account.topics)
        name = str(role["rolename"])
        self._tell(
            ("createRole", role, "already exists"),
            ("modifyRole", role, ""),
            ("createClient", {"username": account.name, "roles": [{"rolename": name}]}, "already exists"),
            ("setClientPassword", {"username": account.name, "password": account.key}, ""),
        )

    def allow(self, name: str, site: str, topics: tuple[str, ...]) -> None:
        """See BrokerAccounts."""
        self._tell(
            ("modifyRole", role_of(name, site, topics), ""),
            # a changed role leaves connections alone: this ends them, so that the device asks for its topics anew
            ("disableClient", {"username": name}, ""),
            ("enableClient", {"username": name}, ""),
        )

    def remove(self, name: str) -> None:
        """See BrokerAccounts."""
        self._tell(
            ("deleteClient", {"username": name}, "not found"),
            ("deleteRole", {"rolename": role_of(name)["rolename"]}, "not found"),
        )

    def names(self) -> frozenset[str] | None:
        """See BrokerAccounts."""
        return frozenset(str(name) for name in self._list("clients", verbose=False))

    def find_outdated(self) -> frozenset[str]:
        """See BrokerAccounts."""
        return find_hearing_all_stops(self._list("roles", verbose=True))

    def _list(self, what: str, *, verbose: bool) -> list[Any]:
        """Return all clients or roles, page by page."""
        found: list[Any] = []
        while True:
            asked = {"verbose": verbose, "count": PAGE, "offset": len(found)}
            (answer,) = self._tell((f"list{what.title()}", asked, ""))
            data = answer.get("data", {})
            found += data.get(what, [])
            if not data.get(what) or len(found) >= data.get("totalCount", 0):
                return found

    def _tell(self, *commands: tuple[str, Command, str]) -> Sequence[Mapping[str, Any]]:
        """Send (command, arguments, harmless refusal) and return the answers in their order."""
        answers = _ask([{"command": command, **arguments} for command, arguments, _ in commands])
        for (command, _, harmless), answer in zip(commands, answers, strict=True):
            error = str(answer.get("error", ""))
            if error and not (harmless and harmless in error.lower()):
                raise BrokerAway(f"The broker refused {command}: {error}. Nothing was changed.")
        return answers


def _ask(commands: Sequence[Command]) -> Sequence[Mapping[str, Any]]:
    """Publish commands to the plugin and wait for its answers, one for each.

    Whoever asks at the same time hears these answers, too; the marks tell whose they are.
    """
    marks = [secrets.token_hex(8) for _ in commands]
    body = [{**command, "correlationData": mark} for command, mark in zip(commands, marks, strict=True)]
    heard = threading.Event()
    answers: dict[str, Mapping[str, Any]] = {}

    def hear(_topic: str, text: bytes, _retained: bool) -> None:
        answers.update({str(answer.get("correlationData")): answer for answer in json.loads(text)["responses"]})
        if answers.keys() >= set(marks):
            heard.set()

    client = MqttClient.from_settings(settings.VIPO_MQTT, client_id=f"accounts-{secrets.token_hex(6)}")
    client.subscribe(f"{CONTROL}/response", 1, hear)
    client.start()
    try:
        if not client.wait_subscribed(ANSWER_LIMIT_S):
            raise BrokerAway("The MQTT broker does not answer, so nothing was changed. Try again in a moment.")
        client.publish(CONTROL, json.dumps({"commands": body}).encode())
        if not heard.wait(ANSWER_LIMIT_S):
            raise BrokerAway(
                "The MQTT broker does not manage accounts, so nothing was changed. "
                "Check that it runs with deploy/mosquitto/mosquitto.conf."
            )
        return [answers[mark] for mark in marks]
    finally:
        client.stop()


@lru_cache(maxsize=1)
def accounts() -> BrokerAccounts:
    """Return this mode's implementation."""
    made: BrokerAccounts = import_string(settings.VIPO_BROKER_ACCOUNTS)()
    return made


def close_readers(token_ids: Iterable[str]) -> None:
    """Let nobody in by tokens that have ended; what a broker is not told now, the gateway tells it within seconds."""
    for token_id in token_ids:
        try:
            accounts().remove(reader_name(token_id))
        except BrokerAway as error:
            log.warning("The account of %s is still at the broker; the gateway takes it away: %s", token_id, error)
            return


def wait_account_change(*, timeout_s: float) -> bool:
    """Wait until a broker that asks the registry should look again at who is connected; tell whether it should."""
    return wait_wake(BROKER_CHANNEL, timeout_s)
