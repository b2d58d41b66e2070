"""Tests are left out nowhere but where none of the project's commands can install what they need."""

from __future__ import annotations

import platform
import re

import pytest

from tests.kit.files import ROOT
from tests.kit.servers import ServerMissing, must_be_installed

SKIPS = re.compile(r"pytest\.skip\(|skipif|mark\.skip|importorskip|mark\.xfail")
HERE = "tests/unit/site/sources/test_skips.py"


def test_one_place_alone_may_skip_a_test() -> None:
    found = {
        str(file.relative_to(ROOT))
        for file in (ROOT / "tests").rglob("*.py")
        if "node_modules" not in file.parts and SKIPS.search(file.read_text())
    }
    assert found - {HERE} == {"tests/kit/servers.py"}


def test_a_part_that_make_servers_installs_fails_the_test_when_it_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(platform, "freedesktop_os_release", lambda: {"ID": "debian"})
    with pytest.raises(ServerMissing, match=r"ROS 1 is not here: no rospy\. Run `make servers`, then try again\."):
        must_be_installed("ROS 1", "no rospy.")


def test_a_part_that_no_command_installs_on_this_system_leaves_the_test_out(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(platform, "freedesktop_os_release", lambda: {"ID": "fedora"})
    with pytest.raises(pytest.skip.Exception, match="ROS 1 comes from Debian's packages"):
        must_be_installed("ROS 1", "no rospy.")
