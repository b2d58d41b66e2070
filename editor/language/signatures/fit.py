"""Who of a site can do what a function or program needs, and what nobody there can. Pure."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from editor.language.site.signature import ABILITIES, Need
from editor.language.site.surroundings import DeviceFacts
from vipo_device.protocol.description import Description

_HUMP = re.compile(r"(?<=[^\W\d_A-Z])(?=[A-Z])")
_LETTERS = re.compile(r"[^\W\d_]+")


@dataclass(frozen=True, slots=True)
class Match:
    """A device that may do what is needed, and what of it that one cannot."""

    device: str
    name: str
    lacks: tuple[tuple[str, str], ...]


def find_lacks(needs: Iterable[Need], devices: Mapping[str, DeviceFacts]) -> tuple[Need, ...]:
    """Return what nobody of the site can: of each need that no device fits, what is missing of the one that fits best.

    A need of which everything is left is one for which there is no robot, or no machine, at all.
    """
    found: dict[Need, None] = {}
    for need in needs:
        matches = find_matches(need, devices)
        if not matches:
            found[need] = None
        elif matches[0].lacks:
            found[_of_that(need, matches[0].lacks)] = None
    return tuple(found)


def demands_of(needs: Iterable[Need]) -> str:
    """Return what decides whether anybody lacks anything, as one text: the needs without names, sorted."""
    demands = {(need.of, tuple(sorted(need.abilities))) for need in needs}
    return json.dumps(sorted(demands), ensure_ascii=False, separators=(",", ":"))


def are_met(demands: str, devices: Mapping[str, DeviceFacts]) -> bool:
    """Tell whether the devices of a site lack nothing of what `demands_of` wrote."""
    needs = (
        Need(of, "", "", *(_named(kind, abilities) for kind in ABILITIES)) for of, abilities in json.loads(demands)
    )
    return not find_lacks(needs, devices)


def _named(kind: str, abilities: Iterable[tuple[str, str]]) -> tuple[str, ...]:
    return tuple(name for of, name in abilities if of == kind)


def _of_that(need: Need, abilities: tuple[tuple[str, str], ...]) -> Need:
    return Need(need.of, need.name, "", *(tuple(name for of, name in abilities if of == kind) for kind in ABILITIES))


def find_matches(need: Need, devices: Mapping[str, DeviceFacts]) -> list[Match]:
    """Return the devices of a site that may stand for a need, the best first: who can all, then who is called alike.

    Who is named itself comes before others that can as much.
    """
    wanted = need.abilities
    called = _words(f"{need.name} {need.device}")
    rated: list[tuple[int, bool, int, str, Match]] = []
    for device, facts in devices.items():
        description = facts.description
        if facts.lifecycle != "approved" or need.of not in ("parameter", description.kind):
            continue
        lacks = tuple(sorted(wanted - _abilities(description)))
        alike = len(called & _words(f"{description.name} {description.id} {description.device_class}"))
        match = Match(device, description.name, lacks)
        rated.append((len(lacks), device != need.device, -alike, device, match))
    return [match for *_, match in sorted(rated, key=lambda each: each[:4])]


def _abilities(description: Description) -> frozenset[tuple[str, str]]:
    lists = {
        "methods": [method.name for method in description.methods],
        "gives": description.gives,
        "takes": description.takes,
        "readings": [spec.name for spec in description.properties],
    }
    return frozenset((kind, name) for kind in ABILITIES for name in lists[kind])


def _words(text: str) -> set[str]:
    return {word.lower() for word in _LETTERS.findall(_HUMP.sub(" ", text))}
