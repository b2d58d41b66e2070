"""What the steps of a program or function want of the devices, roles and parameters that they name. Pure."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Final, Literal

from editor.language.constructs.table import CONSTRUCTS
from editor.language.document.outline import mapping, place_of
from editor.language.site.signature import ABILITIES, Need, NeedOf
from editor.language.site.surroundings import DeviceFacts

Json = Mapping[str, Any]
Kind = Literal["device", "role", "param"]
Key = tuple[Kind, str, str]
"""A device's or role's id with nothing; the function's id and the parameter's name."""
Wants = dict[str, dict[str, None]]
DEFAULT_ROLE: Final = "robot"
_ALSO_CALLED: Final = {"location": "place"}
_PLACES_OF: Final = {"source": "gives", "target": "takes"}


def find_needs(body: Json, devices: Mapping[str, DeviceFacts], main: str = "") -> tuple[Need, ...]:
    """Return what {steps, functions, roles} need, by whom it is of and name: steps are in no order of their own.

    `main` is the function whose parameters are open; those of others are followed to what they are called with. Of
    devices that are not known here it is told by their steps whether they are robots. Without `main` it is a program's
    body, and devices that defaults of parameters name are needed, too.
    """
    return tuple(sorted(_Needs(body).needs(devices, main), key=lambda need: (need.of, need.name, need.device)))


def find_places(body: Json, devices: Mapping[str, DeviceFacts]) -> tuple[str, ...]:
    """Return the ids of the named places that {steps, functions, roles, parameters} name.

    What a place's default names is one unless it is one of the devices.
    """
    named = (default for _, each in list_parameters(body) if (default := default_of(each, "place")))
    found = dict.fromkeys(default for default in named if default not in devices)
    left: list[object] = [mapping(step).get("params") for step in mapping(body.get("steps")).values()]
    left += [mapping(body.get(root)) for root in ("functions", "parameters", "roles")]
    while left:
        value = left.pop()
        if isinstance(value, Mapping):
            if isinstance(value.get("place"), str):
                found[value["place"]] = None
            left.extend(value.values())
        elif isinstance(value, list):
            left.extend(value)
    return tuple(sorted(found))


def list_parameters(body: Json) -> Iterator[tuple[str, Json]]:
    """Yield all parameters, each with the function that has it; the program's own with nothing."""
    for name, item in mapping(body.get("parameters")).items():
        yield "", {**mapping(item), "name": _text(mapping(item).get("name")) or name}
    for function, item in mapping(body.get("functions")).items():
        listed = mapping(item).get("parameters")
        for each in listed if isinstance(listed, list | tuple) else ():
            yield function, mapping(each)


def default_of(parameter: Json, *types: str) -> str:
    """Return the id that a parameter of one of these types has by default: there it is a text; empty where none is."""
    kind = _text(parameter.get("type"))
    return _text(parameter.get("default")) if _ALSO_CALLED.get(kind, kind) in types else ""


class _Needs:
    def __init__(self, body: Json) -> None:
        self._steps, self._functions = mapping(body.get("steps")), mapping(body.get("functions"))
        self._roles, self._parameters = mapping(body.get("roles")), list(list_parameters(body))
        self._wants: dict[Key, Wants] = {}
        self._robots: set[str] = set()
        self._given: list[tuple[Key, Key]] = []
        """Parameters of functions, each with what a call gives for it."""

    def needs(self, devices: Mapping[str, DeviceFacts], main: str) -> Iterator[Need]:
        for name, step in self._steps.items():
            self._look_at(mapping(step), self._owner_of(name))
        if not main:
            self._look_at_defaults(devices)
        self._follow_calls()
        for key, wants in self._wants.items():
            methods, *others = (tuple(sorted(wants.get(kind, ()))) for kind in ABILITIES)
            if key[0] == "device":
                yield Need(*self._device(key[1], devices), methods, *others)
            elif key[0] == "role":
                role = mapping(self._roles.get(key[1]))
                name, device = _text(role.get("name")) or key[1], _text(role.get("device"))
                yield Need("robot", name, device, _of_robot({*methods, *_texts(role.get("can"))}), *others)
            elif key[1] == main and self._is_device(main, key[2]):
                yield Need("parameter", key[2], "", methods, *others)

    def _device(self, device: str, devices: Mapping[str, DeviceFacts]) -> tuple[NeedOf, str, str]:
        known = devices.get(device)
        if known is not None:
            return known.description.kind, known.description.name, device
        return ("robot" if device in self._robots else "machine"), device, device

    def _is_device(self, function: str, name: str) -> bool:
        parameters = mapping(self._functions.get(function)).get("parameters")
        listed = parameters if isinstance(parameters, list | tuple) else ()
        return any(mapping(each).get("name") == name and mapping(each).get("type") == "device" for each in listed)

    def _owner_of(self, step: str) -> str:
        """Return the function in which a step stands, or nothing."""
        seen: set[str] = set()
        here = step
        while here in self._steps and here not in seen:
            seen.add(here)
            place = place_of(mapping(self._steps[here]).get("place"))
            here = place[0] if place else ""
        return here if here in self._functions else ""

    def _look_at(self, step: Json, owner: str) -> None:
        kind, params = _text(step.get("kind")), mapping(step.get("params"))
        construct = CONSTRUCTS.get(kind)
        if construct is not None and construct.drives:
            self._look_at_role(kind, params)
        thing = [_text(params.get("object"))] if _text(params.get("object")) else []
        places = dict(_PLACES_OF) if kind == "pick_and_drop" else {"at": "gives" if kind == "pick" else "takes"}
        if kind in {"pick", "drop", "pick_and_drop"}:
            for name, ability in places.items():
                self._want(_key(params.get(name), owner), ability, thing)
        if kind == "operate":
            method = _text(params.get("method"))
            self._want(_key(params.get("device"), owner), "methods", [method] if method else [])
        if kind == "call":
            called = _text(params.get("function"))
            for name, value in mapping(params.get("args")).items():
                given = _key(value, owner)
                if given is not None:
                    self._given.append((("param", called, str(name)), given))
        self._look_inside(params, owner)

    def _look_at_role(self, kind: str, params: Json) -> None:
        role = _text(params.get("role")) or DEFAULT_ROLE
        method = {"cover": ["move"], "release": []}.get(kind, [kind])
        self._want(("role", role, ""), "methods", ["pick", "drop"] if kind == "pick_and_drop" else method)
        device = _text(mapping(self._roles.get(role)).get("device"))
        self._robots.update([device] if device else [])

    def _look_at_defaults(self, devices: Mapping[str, DeviceFacts]) -> None:
        for owner, each in self._parameters:
            device = default_of(each, "device") or default_of(each, "place")
            if device and (device in devices or default_of(each, "device")):
                self._want(("device", device, ""), "methods", [])
                self._given.append((("param", owner, _text(each.get("name"))), ("device", device, "")))

    def _look_inside(self, value: object, owner: str) -> None:
        """Look for devices and readings wherever they stand in a step's values."""
        left = [value]
        while left:
            here = left.pop()
            if isinstance(here, Mapping):
                reading = here.get("property")
                if isinstance(reading, list) and len(reading) == 2:
                    of = {"device": reading[0]} if isinstance(reading[0], str) else reading[0]
                    self._want(_key(of, owner), "readings", [_text(reading[1])])
                elif isinstance(here.get("device"), str):
                    self._want(_key({"device": here["device"]}, owner), "methods", [])
                left.extend(here.values())
            elif isinstance(here, list):
                left.extend(here)

    def _want(self, key: Key | None, ability: str, names: list[str]) -> None:
        if key is not None:
            wants = self._wants.setdefault(key, {})
            wants.setdefault(ability, {}).update(dict.fromkeys(filter(None, names)))

    def _follow_calls(self) -> None:
        """Let what a function wants of its parameters be wanted of what it is called with."""
        for _ in range(len(self._functions) + 1):
            for inner, given in self._given:
                for ability, names in self._wants.get(inner, {}).items():
                    self._want(given, ability, [*names])


def _key(value: object, owner: str) -> Key | None:
    named = mapping(value)
    if isinstance(named.get("device"), str) and named["device"]:
        return "device", str(named["device"]), ""
    if isinstance(named.get("role"), str) and named["role"]:
        return "role", str(named["role"]), ""
    if isinstance(named.get("param"), str) and named["param"]:
        return "param", owner, str(named["param"])
    return None


def _of_robot(methods: set[str]) -> tuple[str, ...]:
    """Return the methods in order; that a robot moves goes without saying where it does more."""
    return tuple(sorted(methods - {"move"} or methods))


def _text(value: object) -> str:
    return value if isinstance(value, str) else ""


def _texts(value: object) -> list[str]:
    return [each for each in value if isinstance(each, str) and each] if isinstance(value, list | tuple) else []
