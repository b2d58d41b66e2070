"""Keys in files, and which of them a device comes in with."""

from __future__ import annotations

import json
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from vipo_device.kit.keyring import KeyFile, KeyRing, RotatingKeyRing


def read(path: Path) -> dict[str, str]:
    found: dict[str, str] = json.loads(path.read_text())
    return found


def test_a_key_is_replaced_and_the_others_stay(tmp_path: Path) -> None:
    path = tmp_path / "devices.json"
    path.write_text('{"oven": "first", "mixer": "its key"}')
    KeyFile(path).keep("oven", "second")
    assert read(path) == {"oven": "second", "mixer": "its key"}
    assert path.stat().st_mode & 0o777 == 0o600
    assert (KeyFile(path).find("oven"), KeyFile(path).find("booth")) == ("second", "")


def test_a_file_that_is_not_one_of_keys_is_not_written_over(tmp_path: Path) -> None:
    path = tmp_path / "devices.json"
    path.write_text('["oven"]')
    with pytest.raises(ValueError, match=r"^devices\.json is no JSON object of keys by device\.$"):
        KeyFile(path).keep("oven", "second")
    assert path.read_text() == '["oven"]'


def test_a_key_is_made_once_and_one_that_people_wrote_goes_first(tmp_path: Path) -> None:
    by_hand, own = tmp_path / "devices.json", tmp_path / "secrets" / "own.json"
    ring = KeyRing(by_hand, own)
    made = ring.first_key("Acme-1")
    assert (len(made), ring.keys("Acme-1"), ring.key_to_enrol("Acme-1")) == (32, [made], made)
    assert own.stat().st_mode & 0o777 == 0o600
    by_hand.write_text(json.dumps({"Acme-1": "by hand"}))
    assert ring.keys("Acme-1") == ["by hand"]
    own.write_text("not JSON")
    assert ring.first_key("Acme-2") != made
    ring.accept("Acme-1", made)
    assert read(by_hand) == {"Acme-1": "by hand"}


def test_connectors_that_share_a_file_of_keys_keep_each_others(tmp_path: Path) -> None:
    own = tmp_path / "own" / "mtconnect-hall.json"
    rings = [KeyRing(tmp_path / "devices.json", own) for _ in range(4)]
    with ThreadPoolExecutor(8) as pool:
        keys = dict(pool.map(lambda n: (f"m{n % 8}", rings[n % 4].first_key(f"m{n % 8}")), range(64)))
    assert read(own) == keys


def test_a_rotating_key_leaves_the_one_before_as_spare(tmp_path: Path) -> None:
    current, spares = tmp_path / "devices.json", tmp_path / "devices-spare.json"
    ring = RotatingKeyRing(current, spares)
    assert (ring.first_key("oven"), ring.keys("oven")) == ("", [])
    ring.replace("oven", "first")
    assert (ring.keys("oven"), spares.exists()) == (["first"], False)
    ring.replace("oven", "second")
    assert (ring.first_key("oven"), ring.keys("oven")) == ("second", ["second", "first"])


def test_a_fresh_key_becomes_the_rotating_one_only_when_it_was_let_in(tmp_path: Path) -> None:
    current, spares = tmp_path / "devices.json", tmp_path / "devices-spare.json"
    current.write_text('{"oven": "first"}')
    ring = RotatingKeyRing(current, spares)
    fresh = ring.key_to_enrol("oven")
    assert (ring.key_to_enrol("oven"), read(current), read(spares)) == (fresh, {"oven": "first"}, {"oven": fresh})
    ring.accept("oven", fresh)
    assert (read(current), read(spares)) == ({"oven": fresh}, {"oven": "first"})
    ring.accept("oven", fresh)
    assert (read(current), read(spares)) == ({"oven": fresh}, {"oven": "first"})
    assert ring.key_to_enrol("oven") not in {fresh, "first"}
