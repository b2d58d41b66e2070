"""A robot's map comes in parts and is put together again, with suspicion."""

from __future__ import annotations

import base64
import json
import zlib
from contextlib import suppress
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from registry.floorplan.map_message import join_parts, plain_grid, read_grid_part
from registry.floorplan.plan import Grid
from tests.kit.files import ROOT
from vipo_device.protocol.messages import BadMessage

CELLS = bytes([0, 100, 255, 7, 0, 100])
KEYS = ("boot", "map", "part", "parts", "size", "resolution", "origin", "cells")
JUNK = st.one_of(st.none(), st.integers(), st.text(max_size=4), st.lists(st.integers(), max_size=3))


def parts(content: bytes = CELLS, count: int = 1, **changes: Any) -> list[bytes]:
    packed = zlib.compress(content)
    step = -(-len(packed) // count)
    body = {"boot": 3, "map": 1, "parts": count, "size": [3, 2], "resolution": 0.05, "origin": [-1.0, 2.5, 0.0]}
    return [
        json.dumps(
            {**body, "part": n, "cells": base64.b64encode(packed[n * step : (n + 1) * step]).decode(), **changes}
        ).encode()
        for n in range(count)
    ]


def put_together(messages: list[bytes]) -> Grid:
    return join_parts([read_grid_part(message) for message in messages])


def test_the_protocols_example_is_read() -> None:
    text = (ROOT / "docs" / "protocol.md").read_text()
    example = text.split("vipo/v1/dev/robot01/up/map ", 1)[1].split("\n", 1)[0]
    assert put_together([example.strip().encode()]) == Grid(3, 2, 0.05, -1.0, 2.5, CELLS)


@given(st.permutations(range(4)))
def test_parts_may_come_in_any_order(order: list[int]) -> None:
    said = parts(count=4)
    assert put_together([said[n] for n in order]) == Grid(3, 2, 0.05, -1.0, 2.5, CELLS)


def test_a_part_that_came_twice_counts_once_and_one_that_is_missing_is_missed() -> None:
    said = parts(count=3)
    assert put_together([*said, said[1]]) == Grid(3, 2, 0.05, -1.0, 2.5, CELLS)
    with pytest.raises(BadMessage, match="The map has 2 of its 3 parts"):
        put_together([said[0], said[2], said[0]])


def test_shades_become_the_three_kinds_of_cells_that_maps_have() -> None:
    shades = Grid(6, 1, 0.05, 0.0, 0.0, bytes([0, 19, 20, 65, 66, 255]))
    assert plain_grid(shades).cells == bytes([0, 0, 255, 255, 100, 255])


@pytest.mark.parametrize(
    ("changes", "why"),
    [
        ({"size": [3, 3]}, "The map has not the 9 cells that its size says."),
        ({"size": [1, 1]}, "The map has not the 1 cells that its size says."),
        ({"size": [0, 2]}, "`size` must be [width, height]: cells, from 1 to 8192."),
        ({"size": [8192, 8192]}, "The map has more than 16000000 cells."),
        ({"resolution": 0}, "`resolution` must be from 0.001 to 10 metres."),
        ({"origin": [0, 0]}, "`origin` must be [x, y, theta]: metres and radians."),
        ({"origin": [0, 0, 0.5]}, "The map is turned; `origin` must have theta 0."),
        ({"part": 1}, "`part` must be a whole number from 0 to 0."),
        ({"parts": 401}, "`parts` must be a whole number from 1 to 400."),
        ({"cells": "?"}, "`cells` must be text in base64."),
        ({"cells": "AAAA"}, "The cells are not packed with zlib."),
        ({"boot": True}, "`boot` must be a whole number from 0 to 9007199254740992."),
    ],
)
def test_a_refusal_says_why(changes: dict[str, Any], why: str) -> None:
    with pytest.raises(BadMessage) as caught:
        put_together(parts(**changes))
    assert caught.value.detail == why


def test_cells_that_mean_nothing_are_refused() -> None:
    with pytest.raises(BadMessage, match="A cell must be 0 to 100, or 255 for unknown"):
        put_together(parts(bytes([0, 100, 255, 7, 0, 101])))


def test_what_unpacks_to_more_than_its_size_is_not_unpacked() -> None:
    with pytest.raises(BadMessage, match="The map has not the 6 cells"):
        put_together(parts(b"\0" * 10_000_000))


def test_what_stands_behind_the_cells_is_refused() -> None:
    packed = base64.b64encode(zlib.compress(CELLS) + b"more").decode()
    with pytest.raises(BadMessage, match="The map has not the 6 cells"):
        put_together(parts(cells=packed))


def test_parts_that_do_not_fit_together_are_refused() -> None:
    first, _ = parts(count=2)
    other = parts(count=2, resolution=0.1)[1]
    with pytest.raises(BadMessage, match="different sizes, places or numbers of parts"):
        put_together([first, other])


@given(st.dictionaries(st.sampled_from(KEYS), JUNK))
def test_anything_is_read_or_refused(changes: dict[str, Any]) -> None:
    with suppress(BadMessage):
        put_together(parts(**changes))
