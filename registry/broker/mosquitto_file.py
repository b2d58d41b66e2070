"""Mosquitto's accounts as its dynamic security plugin reads them: one role with literal topics for each of them.

The plugin of Mosquitto 2.0 puts no user's name into a topic, so each account has a role of its own.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

from vipo_device.protocol.topics import (
    MIRROR,
    MIRROR_FILTERS,
    READER,
    STAND_IN_FILTERS,
    STAND_IN_KINDS,
    STAND_INS,
    is_reader,
    stop_topic,
    things_prefix,
)

Acl = dict[str, object]
Role = dict[str, Any]
ENROLMENT = "join:"
"""Before a site's name: the user name with which devices enrol that have no key of their own (docs/protocol.md)."""
SERVER_STATUS = "vipo/v1/srv/status"
EVERY_SITE = "+"
"""In the place of a site: the device hears the stops of all; only tests and bridges without a registry use it."""
_DEVICE = "device "
DEFAULTS = {"publishClientSend": False, "publishClientReceive": False, "subscribe": False, "unsubscribe": True}


def device_role(device_id: str, site: str, topics: Sequence[str] = ()) -> Role:
    """Return what a device may do: speak for itself, hear its own commands, its own site's stop and the server.

    `topics` are legacy ones that an admin has confirmed for it.
    """
    own = f"vipo/v1/dev/{device_id}"
    heard = (f"{own}/down/#", stop_topic(site), SERVER_STATUS, *topics)
    return {"rolename": f"{_DEVICE}{device_id}", "acls": [_allow("publishClientSend", f"{own}/up/#"), *_hears(heard)]}


def reader_role(name: str, site: str) -> Role:
    """Return what a member's program may do by a token: hear how its site's Things are, and its stop; say nothing."""
    acls = _hears((f"{things_prefix(site)}#", stop_topic(site)))
    return {"rolename": f"reader {name.removeprefix(READER)}", "acls": acls}


def mirror_role() -> Role:
    """Return what VIPO's mirror may do: hear what devices are told and say, but no new key; say nothing."""
    no_key = _deny("publishClientReceive", "vipo/v1/dev/+/down/credential")
    return {"rolename": "mirror", "acls": [*_hears(MIRROR_FILTERS), no_key]}


def stand_ins_role() -> Role:
    """Return what the process of stand-ins may do: speak for these alone, hear what they and real robots are told."""
    says = [_allow("publishClientSend", f"vipo/v1/sim/+/up/{kind}") for kind in STAND_IN_KINDS]
    return {"rolename": "stand-ins", "acls": [*says, *_hears(STAND_IN_FILTERS)]}


def _hears(topics: Sequence[str]) -> list[Acl]:
    return [_allow(act, topic) for topic in topics for act in ("publishClientReceive", "subscribePattern")]


def find_hearing_all_stops(roles: Sequence[Role]) -> frozenset[str]:
    """Return the devices among these roles that hear the stops of all sites."""
    wide = [role["rolename"] for role in roles if any(acl["topic"] == stop_topic(EVERY_SITE) for acl in role["acls"])]
    return frozenset(name.removeprefix(_DEVICE) for name in wide if name.startswith(_DEVICE))


def enrolment_role(name: str) -> Role:
    """Return what somebody with a site's enrolment key may do: enrol, and hear nothing."""
    site = name.removeprefix(ENROLMENT)
    # brokers that run know the role by this name
    return {"rolename": f"door {site}", "acls": [_allow("publishClientSend", f"vipo/v1/join/{site}/+")]}


def server_role() -> Role:
    """Return what VIPO's own processes may do: say everything, hear what is below `vipo/`, and keep the accounts.

    To give it each confirmed legacy topic by itself would end all its connections every time.
    """
    acls = [
        _allow(act, topic)
        for topic in ("vipo/#", "$CONTROL/dynamic-security/#")
        for act in ("publishClientSend", "publishClientReceive", "subscribePattern")
    ]
    more = [_allow("publishClientSend", "#"), _allow("subscribePattern", "$share/#")]
    return {"rolename": "server", "acls": [*acls, *more]}


def _allow(act: str, topic: str) -> Acl:
    return {"acltype": act, "topic": topic, "priority": 0, "allow": True}


def _deny(act: str, topic: str) -> Acl:
    """Refuse what another rule allows."""
    return {"acltype": act, "topic": topic, "priority": 1, "allow": False}


def account_file(
    hashes: Mapping[str, str],
    sites: Mapping[str, str],
    topics: Mapping[str, Sequence[str]] | None = None,
    *,
    server: str,
) -> str:
    """Return the plugin's file for {name: `$7$rounds$salt$hash`}, {name: its site} and {device: confirmed topics}.

    `server` is the name of VIPO's own account.
    """
    granted = topics or {}
    roles = [
        server_role() if name == server else role_of(name, sites.get(name, ""), granted.get(name, ()))
        for name in sorted(hashes)
    ]
    clients = [_client(name, role, hashes[name]) for name, role in zip(sorted(hashes), roles, strict=True)]
    return json.dumps({"defaultACLAccess": DEFAULTS, "roles": roles, "clients": clients}, indent=1)


def role_of(name: str, site: str = "", topics: Sequence[str] = ()) -> Role:
    """Return the role of an account by its name: a device's, a token's, one of VIPO's own, a site's for enrolment."""
    if name == MIRROR:
        return mirror_role()
    if name == STAND_INS:
        return stand_ins_role()
    if is_reader(name):
        return reader_role(name, site)
    return enrolment_role(name) if name.startswith(ENROLMENT) else device_role(name, site, topics)


def _client(name: str, role: Role, hashed: str) -> dict[str, object]:
    _, _, rounds, salt, digest = hashed.split("$")
    return {
        "username": name,
        "roles": [{"rolename": role["rolename"], "priority": 0}],
        "password": digest,
        "salt": salt,
        "iterations": int(rounds),
    }
