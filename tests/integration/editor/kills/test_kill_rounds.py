"""Twelve rounds of `rounds`, which a command plays a thousand times."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.integration.editor.kills.rounds import Judged, play
from tests.integration.editor.web_pairs import running_pair
from tests.kit.servers import Redis

ROUNDS = 12


@pytest.mark.servers
def test_what_was_called_saved_is_in_the_database_whichever_process_dies(
    tmp_path: Path, module_database_url: str, shared_redis: Redis
) -> None:
    judged = Judged()
    with running_pair(tmp_path, module_database_url, shared_redis) as pair:
        for judged in play(pair, ROUNDS, seed=11):
            assert judged.lost == 0, judged.examples
    assert judged.rounds == ROUNDS
    assert judged.saved > ROUNDS * 5
