"""`vipo scan`: what it writes and prints, and what it refuses."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from registry.floorplan.map_server import read_map, write_pgm, write_yaml
from registry.floorplan.plan import OCCUPIED, Grid
from tests.kit.floors.halls import bare_hall, hall_with_a_bay
from vipo_site.cli.main import main


@pytest.fixture
def hall(tmp_path: Path) -> Path:
    return write_map(tmp_path, bare_hall(5.0, 4.0))


def write_map(folder: Path, grid: Grid) -> Path:
    (folder / "hall.pgm").write_bytes(write_pgm(grid))
    (folder / "hall.yaml").write_bytes(write_yaml(grid, "hall.pgm"))
    return folder / "hall.yaml"


def test_a_scan_writes_a_map_and_says_how_good_it_is(
    hall: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "made" / "here"
    assert main(["scan", "--map", str(hall), "--seed", "3", "--out", str(out), "--json"]) == 0
    body = json.loads(capsys.readouterr().out)
    assert body["seed"] == 3
    assert body["lidar_m"] == 8
    assert body["is_whole"] is True
    assert body["f1"] >= 0.95
    assert body["iou"] >= 0.97
    assert body["pose_error"]["largest"]["m"] <= 0.05
    assert body["pose_error"]["final"]["m"] <= body["pose_error"]["largest"]["m"]
    assert body["virtual_s"] > 0
    assert body["processor_s"] > 0
    grid = read_map((out / "map.yaml").read_bytes(), (out / "map.pgm").read_bytes())
    assert [grid.width, grid.height] == body["size_cells"]
    assert grid.resolution_m == 0.05


def test_the_same_seed_writes_the_same_bytes(hall: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name in ("first", "again"):
        assert main(["scan", "--map", str(hall), "--seed", "5", "--out", str(tmp_path / name)]) == 0
    told = capsys.readouterr().out
    assert "Walls found (F1, one cell)" in told
    for file in ("map.yaml", "map.pgm"):
        assert (tmp_path / "first" / file).read_bytes() == (tmp_path / "again" / file).read_bytes()


@pytest.mark.parametrize(("wide_m", "code"), [(0.3, 1), (0.5, 0)])
def test_a_scan_from_a_bay_ends_well_only_where_the_hall_was_seen(
    wide_m: float, code: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    grid, start = hall_with_a_bay(wide_m)
    at = ["--start", *(f"{value:g}" for value in (start.x, start.y, start.theta))]
    assert main(["scan", "--map", str(write_map(tmp_path, grid)), *at, "--out", str(tmp_path / "out")]) == code
    why = (
        "The map is not whole: the robot did not get through a narrow place behind which there is more to see. "
        "Let it begin where it has more room, with --start X Y THETA.\n"
    )
    assert (why in capsys.readouterr().out) == (code == 1)


def refused(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> str:
    assert main(["scan", *arguments]) == 2
    told = capsys.readouterr()
    assert told.out == ""
    return told.err


def test_bad_maps_and_options_are_named(hall: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = ["--out", str(tmp_path / "out")]
    assert refused(["--map", str(tmp_path / "no.yaml"), *out], capsys) == (
        f"{tmp_path / 'no.yaml'} cannot be read: No such file or directory.\n"
    )
    lonely = tmp_path / "lonely.yaml"
    lonely.write_text("image: gone.pgm\nresolution: 0.05\norigin: [0, 0, 0]\n")
    assert refused(["--map", str(lonely), *out], capsys) == (
        f"{tmp_path / 'gone.pgm'} cannot be read: No such file or directory.\n"
    )
    lonely.write_text("resolution: 0.05\n")
    assert "names no image" in refused(["--map", str(lonely), *out], capsys)
    (tmp_path / "gone.pgm").write_bytes(b"P5\n4 4\n255\nabc")
    lonely.write_text("image: gone.pgm\nresolution: 0.05\norigin: [0, 0, 0]\n")
    assert "The PGM ends early: 3 of 16 cells." in refused(["--map", str(lonely), *out], capsys)
    for option, value, told in (
        ("--lidar", "0.1", "--lidar 0.1 is out of bounds; choose 2 to 40 metres.\n"),
        ("--lidar", "nan", "--lidar nan is out of bounds; choose 2 to 40 metres.\n"),
        ("--odometry", "2", "--odometry 2 is out of bounds; choose 0 to 0.3 (0.05 is 5 %).\n"),
        ("--seed", "-1", "--seed must be a whole number from 0 to 2147483647.\n"),
        ("--seed", "2147483648", "--seed must be a whole number from 0 to 2147483647.\n"),
    ):
        assert refused(["--map", str(hall), option, value, *out], capsys) == told
    assert "does not fit at (0.1, 0.1)" in refused(["--map", str(hall), "--start", "0.1", "0.1", "0", *out], capsys)
    assert not (tmp_path / "out" / "map.pgm").exists()


def test_a_map_without_floor_or_with_coarse_cells_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    solid = write_map(tmp_path, Grid(20, 20, 0.05, 0.0, 0.0, bytes([OCCUPIED]) * 400))
    assert "does not fit" in refused(["--map", str(solid), "--out", str(tmp_path / "out")], capsys)
    coarse = write_map(tmp_path, Grid(20, 20, 1.0, 0.0, 0.0, bytes(400)))
    assert "has cells of 1 m" in refused(["--map", str(coarse), "--out", str(tmp_path / "out")], capsys)
