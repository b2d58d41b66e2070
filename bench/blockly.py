"""The same length of program in Blockly, whose generator prints and does not check; for comparison."""

from __future__ import annotations

import json
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

from bench.figures import figure

PEERS = Path(__file__).resolve().parent / "peers"
REPEATS = 60


def measure_blockly(count: int) -> Iterator[dict[str, object]]:
    """Let Blockly print as many statement blocks; where it cannot be had, say so."""
    missing = what_is_missing("blockly")
    if missing:
        yield {"what": "Blockly prints Python", "skipped": missing}
        return
    command = ["node", str(PEERS / "blockly.mjs"), str(count), str(REPEATS)]
    said = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    more = {name: said[name] for name in ("statements", "blocks", "lines", "version")}
    yield figure("Blockly prints Python", said["ms"], "ms", **more)


def what_is_missing(peer: str) -> str:
    """Install the peers where this one is not yet; return what keeps it from being there."""
    if shutil.which("node") is None or shutil.which("npm") is None:
        return "Node and npm are not installed."
    if (PEERS / "node_modules" / peer).exists():
        return ""
    command = ["npm", "ci", "--no-audit", "--no-fund", "--loglevel=error"]
    done = subprocess.run(command, check=False, cwd=PEERS, capture_output=True, text=True)
    return "" if done.returncode == 0 else f"npm could not install {peer}: {done.stderr.strip()[-200:]}"
