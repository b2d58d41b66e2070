"""A web process does not go through all that it has loaded whenever Python collects what nobody needs."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

from tests.kit.files import ROOT

LOADED = """
import gc, json
import vipo_site.asgi
collected_each_time, left_out = len(gc.get_objects()), gc.get_freeze_count()
print(json.dumps([collected_each_time, left_out, gc.isenabled()]))
"""


def test_collections_of_a_web_process_leave_out_what_it_has_loaded(tmp_path: Path) -> None:
    environment = {**os.environ, "DJANGO_SETTINGS_MODULE": "vipo_site.settings", "VIPO_STATE_DIR": str(tmp_path)}
    done = subprocess.run(
        [sys.executable, "-c", LOADED], cwd=ROOT, env=environment, capture_output=True, text=True, check=True
    )
    collected_each_time, left_out, is_enabled = json.loads(done.stdout)
    assert (left_out > 100_000, is_enabled) == (True, True)
    assert collected_each_time < left_out / 100
