"""One real server for all tests of the editor that do not end it."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.kit.web import Web, prepare


@pytest.fixture(scope="session")
def web(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Web]:
    folder = tmp_path_factory.mktemp("web")
    server = Web(folder, **prepare(folder, {}))
    server.start()
    try:
        yield server
    finally:
        server.kill()
