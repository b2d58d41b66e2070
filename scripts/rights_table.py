"""The table of who may do what, for docs/administration.md: `python -m scripts.rights_table` writes it there."""

from __future__ import annotations

import json
from pathlib import Path

from registry.people.rights import DEEDS
from registry.people.roles import ROLES

ROOT = Path(__file__).resolve().parent.parent
GUIDE = ROOT / "docs" / "administration.md"
WORDS = ROOT / "frontend" / "src" / "i18n" / "en"
BEGIN, END = "<!-- rights -->", "<!-- end of rights -->"


def print_rights() -> str:
    """Return the table as Markdown: the sentences of the screen, the roles, and what a token needs."""
    roles, deeds = (json.loads((WORDS / name).read_text()) for name in ("role.json", "screens/people.json"))
    heads = ["what", *(roles[role].lower() for role in ROLES), "token"]
    lines = [_row(heads), _row(["---"] * len(heads))]
    for deed in DEEDS:
        if deed.roles:
            marks = ["yes" if role in deed.roles else "no" for role in ROLES]
            scope = "none" if deed.right.scope == "session" else f"`{deed.right.scope}`"
            lines.append(_row([deeds["deed"][deed.name], *marks, scope]))
    return "\n".join(lines)


def _row(cells: list[str]) -> str:
    return f"| {' | '.join(cells)} |"


def write_rights() -> None:
    """Put the table into the guide, between its two marks."""
    before, _, rest = GUIDE.read_text().partition(BEGIN)
    after = rest.partition(END)[2]
    GUIDE.write_text(f"{before}{BEGIN}\n{print_rights()}\n{END}{after}")


if __name__ == "__main__":
    write_rights()
