"""What a robot says that it carries."""

from __future__ import annotations

import pytest

from tests.kit.work import within_processor_time
from vipo_device.protocol.loads import read_load


@pytest.mark.parametrize(
    ("said", "carried"),
    [
        ("box:1,can:2", {"box": 1, "can": 2}),
        (" box = 1 ; can:0", {"box": 1}),
        ("box:1 can:2", {"box": 1, "can": 2}),
        ("Euro pallet:2,KLT/6428:1,Gitterbox Größe 2:1", {"Euro pallet": 2, "KLT/6428": 1, "Gitterbox Größe 2": 1}),
        ("box:1234567", {}),
        (" :1", {}),
        ("nothing", {}),
        (3, {}),
    ],
)
def test_loads_are_read_with_their_whole_names(said: object, carried: dict[str, int]) -> None:
    assert read_load(said) == carried


def test_no_text_takes_long() -> None:
    with within_processor_time(1.0):
        read_load("a " * 50_000)
