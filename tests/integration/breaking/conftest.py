"""One demo for all tests that do not end it."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.integration.breaking.site import Factory, complaints
from tests.kit.demo import running_demo

ROBOTS = ("robot01", "robot02", "robot03", "itemInventory01", "paintMachine01", "paintMixer02")


@pytest.fixture(scope="package")
def factory(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Factory]:
    with running_demo(tmp_path_factory.mktemp("breaking") / "state", speed=10) as demo:
        factory = Factory(demo)
        factory.wait_online(*ROBOTS)
        yield factory
        factory.close()
        assert complaints(demo.log.read_text()) == []
