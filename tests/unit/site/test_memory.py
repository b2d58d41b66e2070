"""A web process that was sent a lot gives the memory back."""

from __future__ import annotations

import subprocess
import sys

from tests.kit.files import ROOT

MEASURE = """
import random, sys
from pathlib import Path
if sys.argv[1] == "as the web process":
    from vipo_site.http.memory import give_back_large_blocks
    assert give_back_large_blocks()

def resident():
    return int(Path("/proc/self/statm").read_text().split()[1]) * 4096

before, stays, dice = resident(), [], random.Random(1)
for _ in range(200):
    messages = [bytes(dice.randrange(100_000, 1_000_000)) for _ in range(20)]
    stays.append([bytes(30_000) for _ in range(2)])
    dice.shuffle(messages)
    while messages:
        messages.pop()
print(resident() - before - 200 * 60_000)
"""


def kept_bytes(how: str) -> int:
    """Return what a process holds after a flood of large messages, beside the small objects that stay."""
    told = subprocess.run([sys.executable, "-c", MEASURE, how], cwd=ROOT, capture_output=True, text=True, check=True)
    return int(told.stdout)


def test_what_a_flood_of_large_messages_took_goes_back_to_the_system() -> None:
    assert kept_bytes("as the web process") < 3_000_000 < kept_bytes("as other processes")
