"""The real MicroPython, fetched once."""

from __future__ import annotations

import pytest

from tests.firmware.rig import interpreter_command
from tests.kit.files import ROOT
from tests.kit.servers import must_be_installed
from vipo_site.demo.firmware_process import find_micropython


@pytest.fixture(scope="session")
def micropython() -> str:
    path, why = find_micropython(ROOT / "var")
    if path is None:
        must_be_installed("MicroPython", why)
    return path


@pytest.fixture(params=["micropython", "cpython"])
def interpreter(request: pytest.FixtureRequest) -> list[str]:
    return find_interpreter(request, request.param)


def find_interpreter(request: pytest.FixtureRequest, name: str) -> list[str]:
    return interpreter_command(request.getfixturevalue("micropython") if name == "micropython" else None)
