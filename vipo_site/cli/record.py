"""`vipo record`: what was done at the server and at none of its sites, such as sign-ons that let nobody in."""

from __future__ import annotations

import argparse
from dataclasses import asdict

from vipo_site.cli.terminal import CLEAN, set_up, write_json, write_table

WHAT = "Show what was done at the server and is in no site's record: sign-ons by providers that failed, new accounts."
COLUMNS = ("at", "what", "by", "facts", "from")
MOST = 1000


def add_record_arguments(sub: argparse.ArgumentParser) -> None:
    """Describe what stands behind `vipo record`."""
    sub.add_argument("--last", type=int, default=50, metavar="N", help=f"so many lines (50, {MOST} at most)")
    sub.add_argument("--json", action="store_true", help="write JSON for machines")
    sub.set_defaults(run=show_record)


def show_record(options: argparse.Namespace) -> int:
    """Show the newest lines, the newest first; return 0."""
    set_up()
    from registry import services

    lines = services.list_server_audit(last=max(1, min(options.last, MOST)))
    if options.json:
        write_json([{**asdict(line), "at": line.at.isoformat()} for line in lines])
        return CLEAN
    rows = [
        (
            f"{line.at:%Y-%m-%d %H:%M:%S}",
            line.code,
            line.actor,
            ", ".join(f"{name} {value}" for name, value in line.facts.items()),
            line.address,
        )
        for line in lines
    ]
    write_table([COLUMNS, *rows])
    return CLEAN
