"""Which changes of a signature are breaking for who calls it, and what is told of each."""

from __future__ import annotations

from dataclasses import replace

import pytest

from editor.language.signatures.compatibility import breaks, find_reasons
from editor.language.site.signature import Need, Port, Signature, signature_from_json, signature_to_json

OVEN = Need("machine", "Oven", "oven1", methods=("cure",), takes=("box",))
CARRIER = Need("robot", "Carrier", methods=("drop", "pick"))
GIVEN = Need("parameter", "mixer", methods=("mix",))
BEFORE = Signature(
    (Port("minutes", "number", "MIN"), Port("mixer", "device"), Port("times", "integer", default="2")),
    Port("", "number", "DEG_C"),
    (OVEN, CARRIER, GIVEN),
)
MINUTES, MIXER, TIMES = BEFORE.parameters


def with_parameters(*parameters: Port) -> Signature:
    return replace(BEFORE, parameters=parameters)


def with_needs(*needs: Need) -> Signature:
    return replace(BEFORE, needs=needs)


@pytest.mark.parametrize(
    ("after", "told"),
    [
        (BEFORE, []),
        (with_parameters(TIMES, MIXER, MINUTES), []),
        (with_parameters(MINUTES, MIXER, TIMES, Port("shade", "text", default='"teal"')), ["parameter_added"]),
        (with_parameters(MINUTES, MIXER, replace(TIMES, type="number")), []),
        (with_parameters(MINUTES, MIXER, replace(TIMES, default="3")), ["default_changed"]),
        (with_parameters(replace(MINUTES, default="5"), MIXER, TIMES), ["default_added"]),
        (replace(BEFORE, result=Port("", "integer", "DEG_C")), []),
        (with_needs(CARRIER, GIVEN), ["needs_gone"]),
        (with_needs(replace(OVEN, takes=()), CARRIER, GIVEN), ["needs_less"]),
        (with_needs(replace(OVEN, name="Kiln", device="kiln1"), CARRIER, GIVEN), ["needs_instead"]),
        (with_needs(OVEN, replace(CARRIER, name="Porter"), GIVEN), []),
    ],
)
def test_what_calls_may_leave_as_they_are_is_compatible(after: Signature, told: list[str]) -> None:
    assert [reason.code for reason in find_reasons(BEFORE, after)] == told
    assert not breaks(BEFORE, after)


@pytest.mark.parametrize(
    ("after", "told"),
    [
        (with_parameters(MINUTES, MIXER, TIMES, Port("shade", "text")), ["parameter_wanted"]),
        (with_parameters(MIXER, TIMES), ["parameter_gone"]),
        (with_parameters(replace(MINUTES, name="seconds"), MIXER, TIMES), ["parameter_wanted", "parameter_gone"]),
        (with_parameters(replace(MINUTES, type="text"), MIXER, TIMES), ["parameter_type"]),
        (with_parameters(replace(MINUTES, unit="SEC"), MIXER, TIMES), ["parameter_unit"]),
        (with_parameters(MINUTES, MIXER, replace(TIMES, default=None)), ["default_gone"]),
        (replace(BEFORE, result=None), ["result_gone"]),
        (replace(BEFORE, result=Port("", "text")), ["result_type"]),
        (replace(BEFORE, result=Port("", "number", "K")), ["result_unit"]),
        (with_needs(replace(OVEN, methods=("cool", "cure")), CARRIER, GIVEN), ["needs_more"]),
        (with_needs(OVEN, replace(CARRIER, methods=("drop", "lift", "pick")), GIVEN), ["needs_more"]),
        (with_needs(OVEN, CARRIER, replace(GIVEN, methods=("heat", "mix"))), ["needs_more"]),
        (with_needs(OVEN, CARRIER, GIVEN, Need("robot", "Second", methods=("move",))), ["needs_new"]),
        (
            with_needs(Need("machine", "Press", "press1", methods=("press",)), CARRIER, GIVEN),
            ["needs_new", "needs_gone"],
        ),
    ],
)
def test_what_calls_or_devices_may_not_fit_is_breaking(after: Signature, told: list[str]) -> None:
    assert [reason.code for reason in find_reasons(BEFORE, after)] == told
    assert breaks(BEFORE, after)


def test_a_first_result_is_compatible() -> None:
    reasons = find_reasons(replace(BEFORE, result=None), BEFORE)
    assert [(reason.code, reason.breaks) for reason in reasons] == [("result_added", False)]


def test_reasons_name_what_was_and_what_is_and_what_breaks_comes_first() -> None:
    after = replace(
        with_parameters(replace(MINUTES, unit="SEC"), MIXER, replace(TIMES, default="3")),
        needs=(replace(OVEN, methods=("cool", "cure")), CARRIER, GIVEN),
    )
    told = [(r.code, r.name, r.old, r.new, r.of) for r in find_reasons(BEFORE, after)]
    assert told == [
        ("parameter_unit", "minutes", "MIN", "SEC", ""),
        ("needs_more", "Oven", "", "cool", "machine"),
        ("default_changed", "times", "2", "3", ""),
    ]


def test_a_signature_comes_back_from_its_json() -> None:
    assert signature_from_json(signature_to_json(BEFORE)) == BEFORE
