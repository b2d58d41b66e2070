"""The file of kinds is read with suspicion: each refusal names the kind and the word."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from simulation.behaviour import behaviour_of
from simulation.kind_file import OWN_FILE, BadKinds, default_kinds, read_kinds
from tests.kit import demo_floor

HEAD = 'version = 1\n[[kinds]]\nname = "saw"\n'


def test_the_kinds_that_vipo_comes_with_are_told_by_what_devices_can_do() -> None:
    kinds = default_kinds()
    assert [kind.name for kind in kinds] == ["any machine", "hot while it works", "curing", "painting", "any robot"]
    assert [kind.when.classes for kind in kinds] == [()] * 5


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("", "The kinds have the version None; write version = 1 in the first line."),
        ("version = 2", "The kinds have the version 2; write version = 1 in the first line."),
        ("version = true", "The kinds have the version True; write version = 1 in the first line."),
        ("version = 1\nkinds = 3", "Write at most 500 kinds, each under [[kinds]]."),
        ("version = 1\nkinds = [3]", "Kind 1 is no table: write [[kinds]] above it."),
        ("version = 1\n[[kinds]]\njob_s = 1.0", "Kind 1 has no name: write name = followed by a text."),
        (HEAD + "job_s = -1.0", "saw: job_s must be at least 0.001, not -1.0."),
        (HEAD + "job_s = nan", "saw: job_s must be a number of at most 1e+06, not nan."),
        (HEAD + "charging_h = 0.0", "saw: charging_h must be at least 0.001, not 0.0."),
        (HEAD + "spread = 1.5", "saw: spread must be from 0 to 1, not 1.5."),
        (HEAD + "slots = 1.5", "saw: a count must be a whole number of at least 0, not 1.5."),
        (HEAD + "fails = { cut = 2 }", "saw: odds must be from 0 to 1, not 2."),
        (HEAD + "uses = { cut = 2 }", "saw: uses.cut must be a table."),
        (HEAD + 'hands_over = "cut"', 'saw: hands_over must be a list of texts, such as ["heat"].'),
        (HEAD + 'when = { kind = "saw" }', 'saw: kind is "machine" or "robot", not \'saw\'.'),
        (HEAD + "when = 3", "saw: when must be a table."),
        (
            HEAD + 'when = { colour = ["red"] }',
            "saw: colour in when is not known. "
            "Known are: classes, gives, ids, kind, methods, properties, reaches_c, takes.",
        ),
        (
            HEAD + 'readings = { heat = { law = "jump" } }',
            "saw: the law of heat is one of progress, approach, while_working, counts, drawn, not 'jump'.",
        ),
        (
            HEAD + 'readings = { heat = { law = "approach", rising_s = 0 } }',
            "saw: rising_s must be at least 0.001, not 0.",
        ),
        (
            HEAD + 'readings = { grade = { law = "drawn", after = ["cut"], usual = 3 } }',
            "saw: usual must be a text, not 3.",
        ),
        (HEAD + 'readings = { grade = { law = "drawn", after = ["cut"] } }', "saw: grade is drawn and needs usual."),
        (HEAD + 'readings = { grade = { law = "drawn", usual = "A" } }', "saw: grade is drawn and needs after."),
        ('version = 1\n[[kind]]\nname = "saw"', "The file: kind is not known. Known are: kinds, version."),
    ],
)
def test_what_cannot_be_understood_is_refused_with_a_sentence(text: str, why: str) -> None:
    with pytest.raises(BadKinds) as refused:
        read_kinds(text)
    assert refused.value.detail == why


def test_a_unit_that_is_not_known_is_refused_and_named() -> None:
    with pytest.raises(BadKinds, match=r"^saw: the unit 'DEGC' is not known\. Known are: SEC, .*DEG_C"):
        read_kinds(HEAD + 'readings = { heat = { law = "approach", unit = "DEGC" } }')


def test_what_is_no_toml_is_refused_with_the_line() -> None:
    with pytest.raises(BadKinds, match=r"^The kinds are no TOML: .*line 3"):
        read_kinds("version = 1\n[[kinds]]\nname = saw\n")


@pytest.fixture
def own_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A file of kinds that the server is told of."""
    path = tmp_path / "kinds.toml"
    monkeypatch.setenv(OWN_FILE, str(path))
    default_kinds.cache_clear()
    yield path
    default_kinds.cache_clear()


def test_a_server_s_own_kinds_know_better_than_those_of_vipo(own_file: Path) -> None:
    own_file.write_text('version = 1\n[[kinds]]\nname = "slow robots"\nwhen = { kind = "robot" }\nspeed_m_s = 0.125\n')
    robot = next(device for device in demo_floor.devices() if device.kind == "robot")
    assert default_kinds()[-1].name == "slow robots"
    assert behaviour_of(replace(robot, speed_m_s=None), default_kinds()).speed_m_s == 0.125


@pytest.mark.parametrize(
    ("text", "why"),
    [
        (None, "which cannot be read: No such file or directory."),
        (b"\xff\xfe", "which cannot be read: it is no text."),
        (b"[[kinds]]", "The kinds have the version None; write version = 1 in the first line."),
        (HEAD.encode() + b'slots = "many"\n', "saw: slots must be a number"),
    ],
)
def test_a_file_of_one_s_own_that_cannot_be_read_is_named(own_file: Path, text: bytes | None, why: str) -> None:
    if text is not None:
        own_file.write_bytes(text)
    with pytest.raises(BadKinds) as refused:
        default_kinds()
    assert refused.value.detail.startswith(f"VIPO_KINDS names {own_file}")
    assert why in refused.value.detail
