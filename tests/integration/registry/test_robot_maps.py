"""Maps of robots are put together in the database, from whatever gateway heard a part; hostile ones fill nothing."""

from __future__ import annotations

import random
from dataclasses import replace
from datetime import timedelta
from typing import Any

import pytest
from django.db.models import Sum

from registry import services
from registry.floorplan.plan import Grid
from registry.maps import robot_map_parts
from registry.models import Device, DeviceEvent, RobotMap, RobotMapDraft, RobotMapPart
from tests.kit.sites import MIXER, NOW, ROBOT, come, describe
from tests.unit.robot_agent.agent import RobotGrid, write_grid
from vipo_device.protocol.messages import BadMessage

pytestmark = pytest.mark.django_db
NOISE = random.Random(3).choices(range(256), k=60_000)
CELLS = bytes(cell if cell <= 100 else 255 for cell in NOISE)
KINDS = bytes(0 if cell < 20 else 100 if 65 < cell <= 100 else 255 for cell in CELLS)


def messages(number: int = 1, *, boot: int = 1, cells: bytes = CELLS, width: int = 300) -> list[bytes]:
    grid = RobotGrid(width, len(cells) // width, 0.05, (-1.0, 2.5, 0.0), cells)
    return list(write_grid(grid, boot, number))


def hear(*payloads: bytes, after_s: float = 0.0, device: str = "robot1") -> list[bool]:
    at = NOW + timedelta(seconds=after_s)
    return [services.ingest_map_part(device_id=device, payload=payload, at=at) for payload in payloads]


@pytest.fixture
def robot(hall: str) -> str:
    return approved()


def approved(name: str = "robot1") -> str:
    describe(replace(ROBOT, id=name))
    Device.objects.filter(pk=name).update(lifecycle="approved")
    return name


def kept(device: str = "robot1") -> Any:
    return services.get_robot_map(site="hall", device_id=device)


def test_a_map_is_kept_when_its_last_part_has_come_in_whatever_order(robot: str) -> None:
    said = messages()
    assert len(said) > 3
    random.Random(1).shuffle(said)
    assert hear(*said[:-1]) == [False] * (len(said) - 1)
    with pytest.raises(services.NoRobotMap, match="Robot One has sent no map yet"):
        kept()
    assert hear(said[-1], said[0], said[-1]) == [True, False, False]
    assert kept().grid == Grid(300, 200, 0.05, -1.0, 2.5, KINDS)
    facts = services.get_robot_map_facts(site="hall", device_id="robot1")
    assert (facts.version, facts.at, facts.changed_at) == (1, NOW, NOW)
    assert facts.known == pytest.approx((60_000 - kept().grid.cells.count(255)) / 60_000)
    assert RobotMapPart.objects.count() == 0


def test_a_newer_map_takes_the_place_of_one_that_is_not_whole_and_older_parts_are_left_aside(robot: str) -> None:
    old, new = messages(), messages(2, cells=CELLS[::-1])
    hear(*old[:-1])
    assert hear(new[0], old[-1], *new[1:], *old) == [False] * len(new) + [True] + [False] * len(old)
    assert kept().grid.cells == KINDS[::-1]
    assert hear(*messages(1, boot=0)) == [False] * len(old)
    assert kept().facts.version == 1


def test_what_an_older_start_of_the_robot_sent_is_left_aside(robot: str) -> None:
    come("robot1", boot=5)
    assert set(hear(*messages(9, boot=4))) == {False}
    assert hear(*messages(1, boot=5))[-1] is True


def test_only_approved_robots_that_may_come_in_are_heard(hall: str) -> None:
    assert set(hear(*messages(), device="nobody")) == {False}
    describe(ROBOT)
    assert set(hear(*messages())) == {False}
    Device.objects.filter(pk="robot1").update(lifecycle="approved", ends_before=NOW)
    assert set(hear(*messages())) == {False}
    describe(MIXER)
    Device.objects.filter(pk="mixer1").update(lifecycle="approved")
    with pytest.raises(BadMessage, match="Only a robot sends a map"):
        hear(*messages(), device="mixer1")
    assert (RobotMap.objects.count(), RobotMapDraft.objects.count()) == (0, 0)


def test_parts_that_contradict_each_other_are_refused_and_the_map_can_still_become_whole(robot: str) -> None:
    said, other = messages(), messages(width=200)
    hear(*said[:-1])
    with pytest.raises(BadMessage, match="different sizes, places or numbers of parts"):
        hear(other[-1])
    assert hear(said[-1]) == [True]


def test_a_part_that_comes_again_with_other_cells_changes_nothing(robot: str) -> None:
    said, other = messages(), messages(cells=CELLS[::-1])
    assert hear(said[0], other[0], *said[1:])[-1] is True
    assert kept().grid.cells == KINDS


def test_cells_that_unpack_to_more_than_the_size_are_refused_and_nothing_is_kept(robot: str) -> None:
    (bomb,) = messages(cells=bytes(4_000_000), width=2000)
    with pytest.raises(BadMessage, match="The map has not the 6 cells"):
        hear(bomb.replace(b"[2000,2000]", b"[2,3]"))
    assert (RobotMap.objects.count(), RobotMapPart.objects.count()) == (0, 0)
    assert hear(*messages(2), after_s=1)[-1] is True


def test_whole_maps_that_come_too_fast_are_not_unpacked(robot: str) -> None:
    def send(number: int, after_s: float) -> bool:
        return hear(*messages(number, cells=bytes([0, 100, number]), width=3), after_s=after_s)[-1]

    assert [send(number, 0) for number in (1, 2, 3)] == [True] * 3
    with pytest.raises(BadMessage, match="Whole maps come too fast; one every 10 s is enough"):
        send(4, 1)
    assert kept().facts.version == 3
    assert [send(5, 6), send(6, 11)] == [True, True]


def test_a_map_of_too_many_packed_bytes_is_forgotten(robot: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(robot_map_parts, "MOST_PACKED", 20_000)
    said = messages()
    with pytest.raises(BadMessage, match="The map has more than 20000 packed bytes"):
        hear(*said)
    assert RobotMapPart.objects.count() == 0
    assert set(hear(*said)) == {False}


def test_a_hundred_robots_that_never_finish_fill_only_so_much(hall: str) -> None:
    part = messages()[0]
    for number in range(100):
        approved(f"r{number}")
        hear(part, device=f"r{number}", after_s=number)
    waiting = RobotMapDraft.objects.filter(size__gt=0)
    assert (waiting.count(), RobotMapPart.objects.count()) == (32, 32)
    assert waiting.aggregate(most=Sum("size"))["most"] == 32 * 9000
    assert set(waiting.values_list("pk", flat=True)) == {f"r{number}" for number in range(68, 100)}
    hear(*messages(2)[:2], device="r0", after_s=3600)
    assert (waiting.count(), RobotMapPart.objects.count()) == (1, 2)


def test_the_history_gets_one_line_an_hour_and_an_unchanged_map_keeps_its_age(robot: str) -> None:
    hear(*messages(1))
    hear(*messages(2), after_s=60)
    assert (kept().facts.version, kept().facts.at, kept().facts.changed_at) == (2, NOW + timedelta(seconds=60), NOW)
    hear(*messages(3, cells=CELLS[::-1]), after_s=3700)
    assert kept().facts.changed_at == NOW + timedelta(seconds=3700)
    lines = DeviceEvent.objects.filter(kind="map").order_by("pk").values_list("text", flat=True)
    assert list(lines) == ["Sent its map: 15.0 by 10.0 m"] * 2


def test_cells_that_are_neither_free_nor_wall_enough_are_unknown_in_the_share_as_in_the_picture(robot: str) -> None:
    hear(*messages(cells=bytes([0, 19, 20, 40, 65, 66, 100, 255]), width=8))
    found = services.get_robot_map(site="hall", device_id=robot)
    assert found.facts.known == 1 - found.grid.cells.count(255) / 8 == 0.5
