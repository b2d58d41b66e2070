"""Lines of a device's history: English, and what other languages are said from."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from registry.devices.history import MOST_PARTS, PARTS, SENTENCES, describe_change, history_text
from vipo_device.protocol.description import Description, MethodSpec, Pose, PropertySpec, Size

MIXER = Description("mixer", "Mixer", "machine", "mixer", Pose(0, 0), Size(1, 1, 1))
CATALOGUES = Path(__file__).parents[3] / "frontend" / "src" / "i18n"


def test_a_line_has_its_words_and_what_they_are_made_of() -> None:
    line = history_text("moved", x=1.0, y=-2.5)
    assert (line.text, line.code, line.args) == ("Moved to 1.00, -2.50", "moved", {"x": 1.0, "y": -2.5})


def test_a_changed_description_is_told_part_by_part() -> None:
    method = MethodSpec("mix", "vipo/v1/dev/mixer/down/mix")
    after = replace(
        MIXER, name="Left", pose=Pose(1, 2), methods=(method,), properties=(PropertySpec("heat", "number"),)
    )
    line = describe_change(MIXER, after)
    assert line is not None
    assert line.text == "Added method mix; added property heat; calls itself Left; says it stands at 1.00, 2.00"
    assert [part["code"] for part in line.args["parts"]] == ["added_method", "added_property", "called", "stands"]
    assert describe_change(after, replace(after, done=False)) is None
    other = describe_change(after, replace(after, description="Mixes"))
    assert other is not None
    assert (other.text, other.args) == ("Changed its description", {"parts": [{"code": "changed"}]})


def test_of_a_description_that_is_all_new_only_some_parts_are_kept_apart() -> None:
    many = tuple(PropertySpec(f"p{number}", "number") for number in range(64))
    line = describe_change(MIXER, replace(MIXER, properties=many))
    assert line is not None
    assert len(line.args["parts"]) == MOST_PARTS


@pytest.mark.parametrize("language", ["en", "de"])
def test_the_screens_have_words_for_every_line(language: str) -> None:
    texts = json.loads((CATALOGUES / language / "screens" / "device.json").read_text(encoding="utf-8"))
    assert set(SENTENCES) <= set(texts["event"])
    assert set(texts["eventPart"]) == set(PARTS)
