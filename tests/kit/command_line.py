"""The command `vipo` as a person types it, and what it answers."""

from __future__ import annotations

import pytest

from vipo_site.cli.main import main


def run_vipo(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, str, str]:
    """Return the exit code, and what it writes as its answer and as its complaints."""
    capsys.readouterr()
    code = main(arguments)
    out, err = capsys.readouterr()
    return code, out, err
