from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from editor.language import UnreadableSite, surroundings_from_json, surroundings_to_json
from editor.language.site.signature import Need, Port, Signature
from editor.language.site.surroundings import LibraryFacts
from editor.language.tree.zones import area_m2, is_in, read_zones
from tests.kit.demo_site import factory

SQUARE = [[0, 0], [2, 0], [2, 2], [0, 2]]


def zone(**changes: Any) -> dict[str, Any]:
    return {"zones": {"z": {"name": "Wet floor", "rule": "keep_out", "points": SQUARE, **changes}}}


def test_a_site_keeps_what_its_library_has() -> None:
    need = Need("machine", "Oven", "oven1", methods=("curePaint",), takes=("box",))
    minutes = Port("minutes", "number", "MIN", default="3")
    versions = {1: Signature(), 2: Signature((minutes,), Port("", "boolean"), (need,))}
    library = {"lib1": LibraryFacts("mixPaint", versions)}
    site = replace(factory(), library=library)
    assert surroundings_from_json(surroundings_to_json(site)) == site
    assert surroundings_from_json(surroundings_to_json(factory())).library is None


@pytest.mark.parametrize(
    "function",
    [
        {"name": "without an id", "versions": []},
        {"id": "a", "versions": [{"number": "one", "parameters": []}]},
        {"id": "a", "versions": [{"number": 1}]},
    ],
)
def test_a_library_that_cannot_be_read_is_told(function: dict[str, Any]) -> None:
    with pytest.raises(UnreadableSite):
        surroundings_from_json({"library": [function]})


def test_a_zone_is_a_polygon_with_a_rule() -> None:
    (read,) = read_zones(zone(speed_m_s=0.3))
    assert (read.id, read.name, read.rule, read.speed_m_s) == ("z", "Wet floor", "keep_out", 0.3)
    assert read.points == ((0, 0), (2, 0), (2, 2), (0, 2))


@pytest.mark.parametrize(
    "changes",
    [
        {"rule": "forbidden"},
        {"points": SQUARE[:2]},
        {"points": [[0, 0], [1, 1], [2, 2]]},
        {"points": "none"},
        {"points": [[0, 0], None, ["x", 1]]},
    ],
)
def test_a_zone_that_is_nonsense_is_left_out(changes: dict[str, Any]) -> None:
    assert read_zones(zone(**changes)) == ()


def test_zones_of_nonsense_are_none() -> None:
    documents: list[object] = [None, {}, {"zones": []}, {"zones": {"z": 5}}]
    assert [read_zones(document) for document in documents] == [()] * 4


def test_points_are_inside_or_outside() -> None:
    corner = ((0.0, 0.0), (4.0, 0.0), (4.0, 1.0), (1.0, 1.0), (1.0, 4.0), (0.0, 4.0))
    assert area_m2(corner) == 7
    assert [is_in(point, corner) for point in ((0.5, 3), (3, 0.5), (3, 3), (-1, 1))] == [True, True, False, False]
