"""Who may come in to the embedded broker, who must go, and who may say and hear what; the registry decides.

The rules are those that registry/broker/mosquitto_file.py gives Mosquitto.
"""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Collection, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

from django.db import close_old_connections

from vipo_device.protocol.messages import read_stand_in_topic
from vipo_device.protocol.topics import (
    MIRROR,
    MIRROR_FILTERS,
    STAND_IN_FILTERS,
    STAND_INS,
    is_reader,
    stop_topic,
    things_prefix,
)

if TYPE_CHECKING:
    from registry.services import Login

CheckPassword = Callable[[str, str], bool]
Line = tuple[str, str, Mapping[str, Any]]
"""For a device's history: its id, an English sentence, and what a screen says that from."""
ENROLMENT = "join:"
"""Before a site's name: the user name of who enrols there (docs/protocol.md)."""
LOOK_EVERY_S = 1.0
_ENROL = re.compile(r"vipo/v1/join/([a-zA-Z0-9_-]+)/[^/+#]{1,256}")
"""The id may be one that no device can have: who hears an enrolment says so to the site's admins."""
_STOP = re.compile(r"vipo/v1/site/[^/#]+/stop")
EVERY_SITE = "+"
"""In the place of a site, where there is no registry that could say which one is somebody's."""


class Admitted(NamedTuple):
    """Somebody who may come in: the hash of their own key (empty with an enrolment key), legacy topics, and site."""

    key: str = ""
    topics: frozenset[str] = frozenset()
    site: str = ""


class AccessControl(Protocol):
    """What the broker asks; every method may block and is called from a thread."""

    def admit(self, username: str, password: str) -> Admitted | None:
        """Return as whom somebody comes in, None to refuse."""

    def find_ended(self, logins: Mapping[str, Login]) -> frozenset[str]:
        """Return which connections, by user name, must end now."""

    def wait(self) -> None:
        """Return when it is time to look for ended ones: soon after a change, every second at the latest."""

    def record(self, dropped: Mapping[str, int], lines: Sequence[Line]) -> None:
        """Note how many messages of each device were dropped, and (device, line) for their histories."""


class PasswordAccess:
    """Lets in whoever a function accepts, for ever."""

    def __init__(self, check_password: CheckPassword) -> None:
        self._check_password = check_password

    def admit(self, username: str, password: str) -> Admitted | None:
        """See AccessControl."""
        return Admitted(site=EVERY_SITE) if self._check_password(username, password) else None

    def find_ended(self, _logins: Mapping[str, Login]) -> frozenset[str]:
        """See AccessControl."""
        return frozenset()

    def wait(self) -> None:
        """See AccessControl."""
        time.sleep(LOOK_EVERY_S)

    def record(self, _dropped: Mapping[str, int], _lines: Sequence[Line]) -> None:
        """See AccessControl; without a registry there is nothing to note it in."""


class RegistryAccess:
    """Asks the registry's database."""

    def admit(self, username: str, password: str) -> Admitted | None:
        """See AccessControl."""
        from registry import services

        close_old_connections()
        try:
            found = services.check_device_password(username=username, password=password)
            return Admitted(found.key, found.topics, found.site) if found else None
        finally:
            close_old_connections()

    def find_ended(self, logins: Mapping[str, Login]) -> frozenset[str]:
        """See AccessControl."""
        from registry import services

        close_old_connections()
        try:
            return services.find_ended(logins=logins)
        finally:
            close_old_connections()

    def wait(self) -> None:
        """See AccessControl."""
        from registry import services

        services.wait_account_change(timeout_s=LOOK_EVERY_S)

    def record(self, dropped: Mapping[str, int], lines: Sequence[Line]) -> None:
        """See AccessControl."""
        from registry import services

        close_old_connections()
        try:
            services.count_dropped(dropped=dropped)
            for device, line, facts in lines:
                services.record_problem(device_id=device, text=line, facts=facts)
        finally:
            close_old_connections()


def may_publish(username: str, topic: str) -> bool:
    """Say whether somebody may write to a topic: a device under its own `up/`, who enrols at its site, nobody else."""
    if is_reader(username) or username == MIRROR:
        return False
    if username == STAND_INS:
        return read_stand_in_topic(topic) is not None
    if username.startswith(ENROLMENT):
        enrolment = _ENROL.fullmatch(topic)
        return enrolment is not None and enrolment[1] == username.removeprefix(ENROLMENT)
    return topic.startswith(f"vipo/v1/dev/{username}/up/") and not {"+", "#"} & set(topic)


def may_subscribe(username: str, topic_filter: str, site: str, topics: Collection[str] = ()) -> bool:
    """Say whether somebody may ask for a filter: a device its own `down/`, its site's stop and the server's births.

    `topics` are the legacy ones that an admin has confirmed for it. A token may ask for its site's Things and stop,
    VIPO's mirror for what all devices are told and say.
    """
    if username == MIRROR:
        return topic_filter in MIRROR_FILTERS
    if username == STAND_INS:
        return topic_filter in STAND_IN_FILTERS
    if is_reader(username):
        return topic_filter.startswith(things_prefix(site)) or topic_filter == stop_topic(site)
    if username.startswith(ENROLMENT):
        return False
    if topic_filter.startswith(f"vipo/v1/dev/{username}/down/") or topic_filter in topics:
        return True
    is_stop = _STOP.fullmatch(topic_filter) and (site == EVERY_SITE or topic_filter == stop_topic(site))
    return bool(is_stop) or topic_filter == "vipo/v1/srv/status"
