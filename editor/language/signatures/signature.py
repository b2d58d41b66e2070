"""The signature of a function that was cut out of a program. Pure."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from editor.language.document.outline import mapping
from editor.language.signatures.needs import find_needs
from editor.language.site.signature import Port, Signature
from editor.language.site.surroundings import DeviceFacts
from vipo_device.protocol.units import unit_code


def signature_of(definition: Mapping[str, Any], devices: Mapping[str, DeviceFacts]) -> Signature:
    """Return what a function {id, function, functions, steps, roles} is to who calls it."""
    function = mapping(definition.get("function"))
    main = str(definition.get("id", ""))
    body = {**definition, "functions": {**mapping(definition.get("functions")), main: function}}
    listed = function.get("parameters")
    parameters = listed if isinstance(listed, list | tuple) else ()
    result = mapping(function.get("result"))
    return Signature(
        tuple(_port(mapping(each)) for each in parameters),
        _port(result) if result.get("type") else None,
        find_needs(body, devices, main),
    )


def _port(body: Mapping[str, Any]) -> Port:
    unit, default = body.get("unit"), body.get("default")
    return Port(
        str(body.get("name", "")),
        str(body.get("type", "")),
        unit_code(unit) if isinstance(unit, str) else "",
        None if default is None else json.dumps(default, sort_keys=True, ensure_ascii=False),
    )
