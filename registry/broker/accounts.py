"""The broker's accounts: whoever may come in, told to the broker that runs.

Mosquitto keeps accounts of its own, in its dynamic security plugin, and is told of every change; a connection whose
account changes or goes is ended by it at once. The embedded broker asks the registry itself and is only woken.
"""

from __future__ import annotations

import json
import logging
import secrets
import threading
from collections.abc import Generator, Iterable, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Protocol

from django.conf import settings
from django.db import transaction
from django.utils.module_loading import import_string

from registry.broker.mosquitto_file import Role, find_hearing_all_stops, role_of
from registry.errors import RegistryError
from registry.live.fanout import wait_wake, wake
from vipo_device.protocol.mqtt_client import MqttClient
from vipo_device.protocol.topics import reader_name

log = logging.getLogger(__name__)
CONTROL = "$CONTROL/dynamic-security/v1"
BROKER_CHANNEL = "broker"
ANSWER_LIMIT_S = 10.0
PAGE = 200
MOST_BYTES = 12_000
"""So much is said to the plugin in one message, and its ends; the broker takes packets of 16,384 bytes."""
MOST_OF_ROLE = 8_000
"""So much of a role is said in one command."""
Command = Mapping[str, Any]
Told = tuple[str, Command, str]
"""A command's name, its arguments, and the refusal that does no harm."""


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
            [("createRole", {"rolename": name}, "already exists"), *_role_commands(role)],
            ("createClient", {"username": account.name, "roles": [{"rolename": name}]}, "already exists"),
            ("setClientPassword", {"username": account.name, "password": account.key}, ""),
        )

    def allow(self, name: str, site: str, topics: tuple[str, ...]) -> None:
        """See BrokerAccounts."""
        self._tell(
            _role_commands(role_of(name, site, topics)),
            # a changed role leaves connections alone: this ends them, so that the device asks for its topics anew
            ("disableClient", {"username": name}, ""),
            ("enableClient", {"username": name}, ""),
        )

    def remove(self, name: str) -> None:
        """See BrokerAccounts."""
        self._tell(
            [],
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
            (answer,) = self._tell([], (f"list{what.title()}", asked, ""))
            data = answer.get("data", {})
            found += data.get(what, [])
            if not data.get(what) or len(found) >= data.get("totalCount", 0):
                return found

    def _tell(self, many: Sequence[Told], *together: Told) -> Sequence[Mapping[str, Any]]:
        """Send `many` commands in as many messages as they need, the last ones `together`; return all answers."""
        groups = _grouped(many)
        groups[-1] += together
        found: list[Mapping[str, Any]] = []
        with closing(_ask([[_body(told) for told in group] for group in groups])) as heard:
            for group, answers in zip(groups, heard, strict=True):
                for (command, _, harmless), answer in zip(group, answers, strict=True):
                    error = str(answer.get("error", ""))
                    if error and not (harmless and harmless in error.lower()):
                        raise BrokerAway(f"The broker refused {command}: {error}. {_outcome(found)}")
                found += answers
        return found


def _role_commands(role: Role) -> list[Told]:
    """Return what makes a role that exists this one; what one command would be too large for is added rule by rule."""
    name, rules, size = role["rolename"], list(role["acls"]), 0
    first = []
    while rules and (size := size + len(json.dumps(rules[0]))) <= MOST_OF_ROLE:
        first.append(rules.pop(0))
    added: list[Told] = [("addRoleACL", {"rolename": name, **rule}, "already exists") for rule in rules]
    return [("modifyRole", {"rolename": name, "acls": first}, ""), *added]


def _grouped(commands: Sequence[Told]) -> list[list[Told]]:
    """Part commands, in their order, so that each part is one message; there is one at least."""
    groups: list[list[Told]] = [[]]
    size = 0
    for told in commands:
        own = len(json.dumps(_body(told)))
        if groups[-1] and size + own > MOST_BYTES:
            groups.append([])
            size = 0
        groups[-1].append(told)
        size += own
    return groups


def _body(told: Told) -> dict[str, Any]:
    command, arguments, _ = told
    return {"command": command, **arguments, "correlationData": secrets.token_hex(8)}


def _outcome(answers: Sequence[object]) -> str:
    """Say what a change is like that the broker did not take, after so many answers to what came before."""
    return "The change is not complete there; try again in a moment." if answers else "Nothing was changed."


def _ask(groups: Sequence[Sequence[Command]]) -> Generator[Sequence[Mapping[str, Any]]]:
    """Publish groups of commands to the plugin, one after the other, and give its answers, one for each command.

    Whoever asks at the same time hears these answers, too; the marks tell whose they are.
    """
    changed = threading.Condition()
    heard: dict[str, Mapping[str, Any]] = {}

    def hear(_topic: str, text: bytes, _retained: bool) -> None:
        with changed:
            heard.update({str(answer.get("correlationData")): answer for answer in json.loads(text)["responses"]})
            changed.notify_all()

    client = MqttClient.from_settings(settings.VIPO_MQTT, client_id=f"accounts-{secrets.token_hex(6)}")
    client.subscribe(f"{CONTROL}/response", 1, hear)
    client.start()
    try:
        if not client.wait_subscribed(ANSWER_LIMIT_S):
            raise BrokerAway("The MQTT broker does not answer, so nothing was changed. Try again in a moment.")
        for number, group in enumerate(groups):
            marks = [str(command["correlationData"]) for command in group]
            client.publish(CONTROL, json.dumps({"commands": group}).encode())
            with changed:
                is_heard = changed.wait_for(lambda sought=marks: heard.keys() >= set(sought), ANSWER_LIMIT_S)  # type: ignore[misc]
            if not is_heard and number:
                raise BrokerAway(f"The MQTT broker does not answer any more. {_outcome(marks)}")
            if not is_heard:
                raise BrokerAway(
                    "The MQTT broker does not manage accounts, so nothing was changed. "
                    "Check that it runs with deploy/mosquitto/mosquitto.conf."
                )
            yield [heard[mark] for mark in marks]
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
