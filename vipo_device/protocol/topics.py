"""Pure: which topics a device may name for its methods (its own, or a legacy one that an admin has to confirm), and
those on which programs of members hear how a site's Things are.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Mapping
from typing import TYPE_CHECKING

from vipo_device.protocol.faults import Fault, fault

if TYPE_CHECKING:
    from vipo_device.protocol.description import Description, MethodSpec

MOST_CHARACTERS = 200
FIXED_METHODS = frozenset({"pause", "resume", "cancel", "credential"})
"""Methods that every device is told on its own `down/` by the protocol itself."""
RESERVED = "vipo"
"""Everything below this first level belongs to VIPO."""
_LEVEL = re.compile(r"[A-Za-z0-9_.@=~-]+")
_METHOD = re.compile(r"[A-Za-z_][A-Za-z0-9_]{0,63}")


READER = "token:"
"""Before a token's id: the user name by which a member's program comes in to hear, and to say nothing."""


def reader_name(token_id: str) -> str:
    """Return by which user name a token comes in to the broker."""
    return f"{READER}{token_id}"


def is_reader(username: str) -> bool:
    """Tell whether this is the user name of a token."""
    return username.startswith(READER)


MIRROR = "mirror:"
"""The user name of VIPO's own mirror, which hears what devices are told and say, and may say nothing (no device's id
has a colon)."""
MIRROR_FILTERS = ("vipo/v1/dev/+/down/+", "vipo/v1/dev/+/up/ack", "vipo/v1/dev/+/up/state", "vipo/v1/site/+/stop")

STAND_INS = "stand-ins:"
"""The user name of VIPO's own process that plays devices which are simulated for a while; it speaks for their stand-ins
alone, and hears what these are told."""
OWN_ACCOUNTS = (MIRROR, STAND_INS)
"""VIPO's own processes that may do less at the broker than the server."""
HAND_OVER_FILTERS = ("vipo/v1/dev/+/down/pick", "vipo/v1/dev/+/down/drop", "vipo/v1/dev/+/up/ack")
"""By these a stand-in of a machine hears what real robots fetch from it and bring to it."""
STAND_IN_FILTERS = ("vipo/v1/sim/+/down/+", "vipo/v1/site/+/stop", "vipo/v1/srv/status", *HAND_OVER_FILTERS)
STAND_IN_KINDS = ("presence", "state", "ack")
"""What a stand-in says, of the kinds of `up` topics; it describes nothing and maps nothing."""


def stop_topic(site: str) -> str:
    """Return where a site's devices and programs hear its stop."""
    return f"vipo/v1/site/{site}/stop"


def things_prefix(site: str) -> str:
    """Return what the topics begin with on which VIPO tells how a site's Things are."""
    return f"vipo/v1/site/{site}/things/"


def property_topic(site: str, device_id: str, name: str) -> str:
    """Return where VIPO tells a property's value, alone."""
    return f"{things_prefix(site)}{device_id}/properties/{name}"


def own_prefix(device_id: str) -> str:
    """Return what the topics of a device's own commands begin with."""
    return f"vipo/v1/dev/{device_id}/down/"


def is_own(device_id: str, topic: str) -> bool:
    """Tell whether a topic is one of the device's own `down/`."""
    below = own_prefix(device_id)
    return topic.startswith(below) and _METHOD.fullmatch(topic.removeprefix(below)) is not None


def find_topic_fault(device_id: str, method: str, topic: str) -> Fault | None:
    """Say why a method can never be told on this topic; None when it might be."""
    if is_own(device_id, topic):
        return None
    named = {"method": method[:64], "own": f"{own_prefix(device_id)}{method[:64]}"}
    levels = topic.split("/")
    if levels[0].lower() == RESERVED or topic.startswith(("$", "/")):
        return fault("topic_foreign", **named)
    if method in FIXED_METHODS:
        return fault("topic_fixed", **named)
    if len(topic) > MOST_CHARACTERS:
        return fault("topic_long", most=MOST_CHARACTERS, **named)
    if not all(_LEVEL.fullmatch(level) for level in levels):
        return fault("topic_levels", **named)
    return None


def list_legacy_methods(description: Description) -> tuple[MethodSpec, ...]:
    """Return the methods that name a topic outside the device's own `down/`."""
    own = own_prefix(description.id)
    return tuple(method for method in description.methods if not method.topic.startswith(own))


def split_methods(
    description: Description, granted: Mapping[str, str]
) -> tuple[tuple[MethodSpec, ...], tuple[MethodSpec, ...]]:
    """Return the methods that may be called, and those whose topic an admin has still to confirm."""
    asked = {m.name for m in list_legacy_methods(description) if granted.get(m.name) != m.topic}
    if not asked:
        return description.methods, ()
    may = tuple(m for m in description.methods if m.name not in asked)
    return may, tuple(m for m in description.methods if m.name in asked)


def find_duplicate(topics: Collection[str]) -> str:
    """Return a topic that comes twice, or an empty text."""
    return next((topic for topic, count in Counter(topics).items() if count > 1), "")
