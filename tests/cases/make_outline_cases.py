"""Write tests/cases/outline: documents as merges may leave them, and how every reader must read them.

What is expected is thought out by hand here, never taken from a reader: `python -m tests.cases.make_outline_cases`.
"""

from __future__ import annotations

from pathlib import Path

from tests.cases.outline_case import text_of
from tests.cases.outline_merges import MERGES
from tests.cases.outline_places import PLACES

FOLDER = Path(__file__).parent / "outline"
CASES = {**PLACES, **MERGES}


def main() -> None:
    """Write the folder anew."""
    FOLDER.mkdir(exist_ok=True)
    for old in FOLDER.glob("*.json"):
        old.unlink()
    for name, content in CASES.items():
        (FOLDER / f"{name}.json").write_text(text_of(content))


if __name__ == "__main__":
    main()
