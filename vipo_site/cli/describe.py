"""`vipo describe`: what a description's file says, what is wrong with it, and the same in another form."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path
from typing import Any

from vipo_device.descriptions.forms import FORMS, BadDescription, form_of
from vipo_device.descriptions.reader import Reading, read, write_description
from vipo_device.descriptions.shacl import check_rdf, check_reading, find_validator
from vipo_device.protocol.description import Description, MethodSpec, ParameterSpec, PropertySpec, description_to_json
from vipo_device.protocol.faults import Fault
from vipo_site.cli.program_file import read_bounded
from vipo_site.cli.terminal import complain, write, write_json


def describe_file(options: argparse.Namespace) -> int:
    """Read the file and write what was asked for; return 0, or 1 when something is wrong with the description.

    Raises:
        UnreadableFile: the file cannot be read.
        ShaclMissing: the shapes were asked for, and what holds RDF against them is not installed.
    """
    if options.shacl:
        find_validator()
    payload = read_bounded(options.file, "description")
    try:
        reading = read(payload)
        faults = check_reading(reading, payload) if options.shacl else ()
    except BadDescription as error:
        return _tell_faults(options, (*error.faults, *(_faults_of_shapes(payload) if options.shacl else ())))
    if faults:
        return _tell_faults(options, faults)
    if options.json:
        write_json(_as_json(reading, options.to))
    elif options.to:
        sys.stdout.write(write_description(reading.description, options.to))
        _complain_of([f"{options.file}: {note.text}" for note in reading.notes])
    else:
        write("\n".join(_summary(options.file, reading)))
    return 0


def _faults_of_shapes(payload: bytes) -> tuple[Fault, ...]:
    """Return what the shapes add about RDF that cannot be believed; nothing about what is no RDF at all."""
    try:
        return check_rdf(payload) if FORMS[form_of(payload)].is_rdf else ()
    except BadDescription:
        return ()


def _tell_faults(options: argparse.Namespace, faults: tuple[Fault, ...]) -> int:
    if options.json:
        write_json({"faults": [asdict(fault) for fault in faults]})
    else:
        _complain_of([f"{_place(options.file, fault)}: {fault.text}" for fault in faults])
    return 1


def _place(path: Path, fault: Fault) -> str:
    if fault.line:
        return f"{path}:{fault.line}:{fault.column}"
    return f"{path}: {fault.path}" if fault.path else str(path)


def _as_json(reading: Reading, form: str | None) -> dict[str, Any]:
    body = {
        "form": reading.form,
        "notes": [note.text for note in reading.notes],
        "faults": [],
        "description": description_to_json(reading.description),
    }
    return {**body, "text": write_description(reading.description, form)} if form else body


def _summary(path: Path, reading: Reading) -> Iterator[str]:
    d = reading.description
    form = FORMS[reading.form].name.removeprefix("a ")
    yield f"{path}: {form}. It describes the {d.kind} {d.id}, “{d.name}”{_class_of(d)}."
    yield (
        f"place: {d.pose.x:g}, {d.pose.y:g}, {d.pose.z:g} m, {d.pose.theta:g} rad; "
        f"size: {d.size.x:g} x {d.size.y:g} x {d.size.z:g} m"
    )
    yield from (f"property: {_value(spec)}" for spec in d.properties)
    yield from (f"method: {_method(method)}" for method in d.methods)
    yield from (f"mended: {note.text}" for note in reading.notes)


def _class_of(d: Description) -> str:
    return f" of class {d.device_class}" if d.device_class else ""


def _method(method: MethodSpec) -> str:
    return f"{method.name}({', '.join(_value(parameter) for parameter in method.parameters)})"


def _value(spec: PropertySpec | ParameterSpec) -> str:
    low, high = spec.minimum, spec.maximum
    limits = "" if low is None and high is None else f"{'' if low is None else f'{low:g}'}…{_high(high)}"
    words = (spec.type, limits, spec.unit, " | ".join(spec.options))
    return f"{spec.name}: {' '.join(word for word in words if word)}"


def _high(value: float | None) -> str:
    return "" if value is None else f"{value:g}"


def _complain_of(lines: list[str]) -> None:
    for line in lines:
        complain(line)
