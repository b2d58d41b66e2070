"""Which ids the connectors' devices have at a site."""

from __future__ import annotations

from argparse import ArgumentParser
from pathlib import Path
from typing import Any

import pytest
from django.core.management.base import CommandError

from connectors.settings import add_prefix, device_names
from vipo_device.kit.keyring import KeyRing
from vipo_device.protocol.messages import is_device_id

WORLDS = ("vda5050", "mtconnect")


@pytest.mark.parametrize("world", WORLDS)
def test_new_ids_begin_with_the_sites_name_unless_it_is_the_default_one(
    world: str, tmp_path: Path, settings: Any
) -> None:
    settings.VIPO_DEFAULT_SITE = "hall"
    assert device_names("hall", tmp_path, world, None)("Acme-1") == "Acme-1"
    assert device_names("yard", tmp_path, world, None)("Acme-1") == "yard.Acme-1"
    assert device_names("yard", tmp_path, world, "")("Acme-1") == "Acme-1"
    assert device_names("hall", tmp_path, world, "agv.")("Acme-1") == "agv.Acme-1"


def test_an_id_that_is_too_long_behind_the_prefix_is_cut_and_kept_apart(tmp_path: Path) -> None:
    name = device_names("yard", tmp_path, "vda5050", None)
    found = {name("a" * 60), name("a" * 61), name("a" * 59)}
    assert [is_device_id(each) and each.startswith("yard.aaa") for each in found] == [True] * 3


@pytest.mark.parametrize("file", ["devices.json", "vda5050-yard.json"])
def test_a_device_that_has_a_key_without_the_prefix_keeps_its_id(tmp_path: Path, file: str) -> None:
    (tmp_path / file).write_text('{"Acme-1": "its key"}')
    name = device_names("yard", tmp_path, "vda5050", None)
    assert [name("Acme-1"), name("Acme-2")] == ["Acme-1", "yard.Acme-2"]
    (tmp_path / file).write_text('{"Acme-2": "its key"}')
    assert [name("Acme-1"), name("Acme-2")] == ["Acme-1", "yard.Acme-2"], "nobody changes it under way"


@pytest.mark.parametrize("file", ["devices.json", "vda5050-yard.json"])
@pytest.mark.parametrize("text", ['{"Acme-1": "its', "[]"])
def test_while_a_file_of_keys_cannot_be_read_nobody_gets_another_id(tmp_path: Path, file: str, text: str) -> None:
    (tmp_path / file).write_text('{"Acme-1": "its key"}')
    name = device_names("yard", tmp_path, "vda5050", None)
    (tmp_path / file).write_text(text)
    assert [name("Acme-1"), name("Acme-2")] == ["Acme-1", "yard.Acme-2"]
    with pytest.raises(CommandError, match=rf"{file} cannot be read \(.+\)\. Mend it: it says which devices keep"):
        device_names("yard", tmp_path, "vda5050", None)
    assert device_names("yard", tmp_path, "vda5050", "")("Acme-1") == "Acme-1", "without a prefix nobody asks it"


def test_a_file_that_cannot_be_read_is_kept_and_who_had_a_key_in_it_keeps_the_id(tmp_path: Path) -> None:
    given, own = tmp_path / "devices.json", tmp_path / "vda5050-yard.json"
    own.write_text('{"Acme-1": "its key", "Acme-2": "its key"}')
    name = device_names("yard", tmp_path, "vda5050", None)
    for number, text in enumerate(('{"Acme-1": "its key", "Acme-2', "[]")):
        own.write_text(text)
        assert KeyRing(given, own).first_key(name("Acme-1")) == KeyRing(given, own).first_key("Acme-1") != "its key"
        assert (tmp_path / f"vda5050-yard.json.damaged{number or ''}").read_text() == text
    assert [name("Acme-2"), name("Acme-3")] == ["Acme-2", "yard.Acme-3"]


def test_the_environment_says_the_prefix_where_the_command_line_does_not(monkeypatch: pytest.MonkeyPatch) -> None:
    def read(*arguments: str) -> str | None:
        parser = ArgumentParser()
        add_prefix(parser, "VIPO_VDA5050_PREFIX")
        found: str | None = parser.parse_args(arguments).prefix
        return found

    assert [read(), read("--prefix="), read("--prefix", "agv.")] == [None, "", "agv."]
    monkeypatch.setenv("VIPO_VDA5050_PREFIX", "hall.")
    assert [read(), read("--prefix=")] == ["hall.", ""]
    monkeypatch.setenv("VIPO_VDA5050_PREFIX", "")
    assert read() is None


@pytest.mark.parametrize("prefix", ["a/b", "a b", "x" * 49])
def test_a_prefix_that_no_id_can_have_is_refused(tmp_path: Path, prefix: str) -> None:
    with pytest.raises(CommandError, match=r"^--prefix must be at most 48 letters"):
        device_names("yard", tmp_path, "vda5050", prefix)
