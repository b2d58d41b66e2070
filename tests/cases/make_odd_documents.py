"""Write tests/cases/odd_documents.json: documents as somebody left them, and as everybody is to read them.

Browsers read them by rules of their own: `python -m tests.cases.make_odd_documents`.
"""

from __future__ import annotations

import json
import random
from pathlib import Path
from typing import Any

from editor.language.reading.well_formed import well_formed
from tests.cases.odd_documents import make_odd, sound_documents

FILE = Path(__file__).parent / "odd_documents.json"
HOW_MANY, SMALL = 150, 3_000
_KEPT = ("steps", "functions", "roles", "parameters", "zones", "start_pos")


def make_cases() -> list[dict[str, Any]]:
    """Return documents with the well-formed ones that they are read as."""
    chance = random.Random(11)
    small = [document for document in sound_documents() if len(json.dumps(document)) < SMALL]
    given = (make_odd(chance.choice(small), chance) for _ in range(HOW_MANY))
    return [{"given": each, "read": {name: well_formed(each).get(name) for name in _KEPT}} for each in given]


if __name__ == "__main__":
    FILE.write_text("[\n" + ",\n".join(json.dumps(case) for case in make_cases()) + "\n]\n")
