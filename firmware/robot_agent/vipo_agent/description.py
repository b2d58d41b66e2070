"""What the robot says of itself: its description in Turtle."""

from __future__ import annotations

import json

from vipo_agent.config import Config

_PREFIXES = """@prefix dct: <http://purl.org/dc/terms/> .
@prefix qudt: <http://qudt.org/schema/qudt/> .
@prefix schema: <https://schema.org/> .
@prefix td: <https://www.w3.org/2019/wot/td#> .
@prefix unit: <http://qudt.org/vocab/unit/> .
@prefix vipo: <urn:vipo:ns#> .
"""


def describe(config: Config) -> bytes:
    """Return the description as bytes of Turtle."""
    width = 2 * config.radius_m
    facts = [
        "a td:Thing, vipo:Robot",
        f"dct:identifier {_text(config.id)}",
        f"dct:title {_text(config.name)}",
        f"vipo:deviceClass {_text(config.device_class)}",
        f"vipo:site {_text(config.site)}",
        f"vipo:location ( {config.home[0]:f} {config.home[1]:f} 0.0 {config.home[2]:f} )",
        f"vipo:size ( {width:f} {width:f} {config.height_m:f} )",
        f"vipo:radius {config.radius_m:f}",
        f"vipo:speed {config.speed_m_s:f}",
        f"vipo:capacity {config.capacity}",
        "td:hasPropertyAffordance " + ",\n        ".join(_properties(config)),
        "td:hasActionAffordance " + ",\n        ".join(_methods(config)),
    ]
    said = " ;\n    ".join(facts)
    return f"{_PREFIXES}\n<urn:vipo:device:{config.id}> {said} .\n".encode()


def _properties(config: Config) -> list[str]:
    battery = (
        '[ td:name "battery" ; dct:title "Battery" ; vipo:type "number" ; qudt:hasUnit unit:PERCENT ; '
        "schema:minValue 0.0 ; schema:maxValue 100.0 ; schema:position 1 ]"
    )
    load = '[ td:name "load" ; dct:title "Load" ; vipo:type "text" ; schema:position 2 ]'
    return [battery, load] if config.capacity else [battery]


def _methods(config: Config) -> list[str]:
    move = _method(config, "move", "location", 1, '[ td:name "path" ; vipo:type "location" ]')
    if not config.capacity:
        return [move]
    hand = (
        '[ td:name "device" ; vipo:type "device" ; vipo:required false ] [ td:name "object" ; vipo:type "object" ] '
        f'[ td:name "value" ; vipo:type "number" ; schema:minValue 1.0 ; schema:maxValue {config.capacity}.0 ]'
    )
    return [move, _method(config, "pick", "object", 2, hand), _method(config, "drop", "object", 3, hand)]


def _method(config: Config, name: str, kind: str, position: int, parameters: str) -> str:
    topic = _text(f"vipo/v1/dev/{config.id}/down/{name}")
    return (
        f'[ td:name "{name}" ; dct:title "{name.capitalize()}" ; vipo:messageType "{kind}" ; vipo:topic {topic} ; '
        f"schema:position {position} ; vipo:parameters ( {parameters} ) ]"
    )


def _text(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)
