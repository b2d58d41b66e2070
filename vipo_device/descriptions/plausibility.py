"""Whether a description may be believed: what is implausible in it, each as a fault; pure."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from math import isfinite
from typing import get_args

from vipo_device.protocol.description import (
    MOST_METHODS,
    MOST_PARAMETERS,
    MOST_PROPERTIES,
    SLOWEST_M_S,
    Description,
    MethodSpec,
    ParameterSpec,
    PropertySpec,
    ValueType,
)
from vipo_device.protocol.faults import Fault, fault
from vipo_device.protocol.texts import find_unfit
from vipo_device.protocol.topics import find_duplicate, find_topic_fault, list_legacy_methods

_IMAGE = re.compile(r"https?://[^\s<>\"{}|\\^`]+")
_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]{0,63}")
_WORD = re.compile(r"[A-Za-z0-9_.-]{0,64}")


def find_faults(description: Description) -> tuple[Fault, ...]:
    """Return what is implausible in a description; nothing when it may be believed."""
    return (
        *_faults_of_numbers(description),
        *_faults_of_words(description),
        *_faults_of_properties(description),
        *(each for method in description.methods for each in _faults_of_method(description.id, method)),
    )


def _faults_of_numbers(d: Description) -> Iterator[Fault]:
    if not all(isfinite(v) and abs(v) <= 1e6 for v in (d.pose.x, d.pose.y, d.pose.z, d.pose.theta)):
        yield fault("location_far", said=f"{d.pose.x:g}, {d.pose.y:g}, {d.pose.z:g}, {d.pose.theta:g}")
    if not all(isfinite(v) and 0 < v <= 100 for v in (d.size.x, d.size.y, d.size.z)):
        yield fault("size_range", said=f"{d.size.x:g}, {d.size.y:g}, {d.size.z:g}")
    if not 0 <= d.capacity <= 1000:
        yield fault("capacity_range")
    if not 0 <= d.radius_m <= 10:
        yield fault("radius_range")
    if d.speed_m_s != 0 and not SLOWEST_M_S <= d.speed_m_s <= 20:
        yield fault("speed_range")
    if d.kind == "robot" and not d.radius_m:
        yield fault("robot_radius")


def _faults_of_words(d: Description) -> Iterator[Fault]:
    if not d.id or not _WORD.fullmatch(d.id):
        yield fault("bad_id", id=d.id[:64])
    if not d.name.strip() or len(d.name) > 100:
        yield fault("name_length")
    if len(d.description) > 1000:
        yield fault("description_length")
    if len(d.image) > 500:
        yield fault("image_length")
    if find_unfit(d.name, is_line=True) or any(find_unfit(text) for text in (d.description, *_titles(d))):
        yield fault("control_characters")
    if d.image and not _IMAGE.fullmatch(d.image):
        yield fault("image_address")
    if not _WORD.fullmatch(d.device_class):
        yield fault("class_word")
    if not _WORD.fullmatch(d.site):
        yield fault("site_word")
    if len(d.gives) + len(d.takes) > 64 or not all(w and _WORD.fullmatch(w) for w in (*d.gives, *d.takes)):
        yield fault("objects_words")


def _titles(d: Description) -> Iterator[str]:
    yield from (spec.title for spec in d.properties)
    yield from (method.title for method in d.methods)


def _faults_of_properties(d: Description) -> Iterator[Fault]:
    if len(d.properties) > MOST_PROPERTIES:
        yield fault("many_properties", most=MOST_PROPERTIES)
    if len(d.methods) > MOST_METHODS:
        yield fault("many_methods", most=MOST_METHODS)
    yield from _faults_of_names([p.name for p in d.properties], "property")
    yield from _faults_of_names([m.name for m in d.methods], "method")
    if twice := find_duplicate([m.topic for m in list_legacy_methods(d)]):
        yield fault("topic_twice", topic=twice)
    for spec in d.properties:
        yield from _faults_of_value(spec, spec.name[:64])
        if len(spec.title) > 100:
            yield fault("property_title", name=spec.name[:64])


def _faults_of_method(device_id: str, method: MethodSpec) -> Iterator[Fault]:
    name = method.name[:64]
    if len(method.parameters) > MOST_PARAMETERS:
        yield fault("many_parameters", method=name, most=MOST_PARAMETERS)
    if method.name == "credential":
        yield fault("method_credential")
    if _NAME.fullmatch(method.name) and (found := find_topic_fault(device_id, method.name, method.topic)):
        yield found
    if len(method.title) > 100:
        yield fault("method_title", method=name)
    if not _WORD.fullmatch(method.message_type):
        yield fault("message_type", method=name)
    yield from _faults_of_names([p.name for p in method.parameters], "parameter")
    for spec in method.parameters:
        yield from _faults_of_value(spec, f"{name}({spec.name[:64]})")


def _faults_of_names(names: list[str], what: str) -> Iterator[Fault]:
    for name in names:
        if not name:
            yield fault(f"{what}_nameless")
        elif not _NAME.fullmatch(name):
            yield fault(f"{what}_name", name=name[:64])
    for name, count in Counter(names).items():
        if count > 1 and name:
            yield fault(f"{what}_twice", name=name[:64])


def _faults_of_value(spec: PropertySpec | ParameterSpec, name: str) -> Iterator[Fault]:
    if spec.type not in get_args(ValueType):
        yield fault("unknown_type", name=name, type=spec.type[:64], types=", ".join(get_args(ValueType)))
    if not _WORD.fullmatch(spec.unit):
        yield fault("no_unit", name=name, unit=spec.unit[:64])
    limits = [v for v in (spec.minimum, spec.maximum) if v is not None]
    if not all(isfinite(v) for v in limits) or limits != sorted(limits):
        yield fault("limits_order", name=name)
    if len(spec.options) > 64 or any(len(o) > 64 for o in spec.options):
        yield fault("many_options", name=name)
    if len(set(spec.options)) != len(spec.options) or any(not o or find_unfit(o) for o in spec.options):
        yield fault("odd_option", name=name)
