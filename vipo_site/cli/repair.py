"""`vipo mend-program`: a program of which a part is missing in the database, for whoever may change that."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from vipo_site.cli.terminal import CLEAN, FAULTY, Unusable, complain, set_up, write, write_json, write_table

if TYPE_CHECKING:
    from editor.services import Change, Mending

WHAT = "Show what is left of a program of which a part is missing in the database, and make that the program."
COLUMNS = ("left out", "author", "bytes", "stored at")


def add_mending_arguments(sub: argparse.ArgumentParser) -> None:
    """Describe what stands behind `vipo mend-program`."""
    sub.add_argument("id", nargs="?", default="", help="the program, by the id in the address of its page")
    what = sub.add_mutually_exclusive_group()
    what.add_argument("--apply", action="store_true", help="make what fits together the program; all is saved before")
    what.add_argument("--restore", type=Path, metavar="FILE", help="put back what such a file holds")
    sub.add_argument("--folder", type=Path, help="where the file is written (the folder mended of VIPO_STATE_DIR)")
    sub.add_argument("--json", action="store_true", help="write JSON for machines")
    sub.set_defaults(run=mend)


def mend(options: argparse.Namespace) -> int:
    """Show or mend a program; return 0, or 1 while rows are left out. Raises Unusable or VipoError."""
    set_up()
    from django.conf import settings

    from editor import services

    folder = options.folder or Path(settings.VIPO_STATE_DIR) / "mended"
    if bool(options.id) == bool(options.restore):
        raise Unusable("Name a program by its id, or a file with --restore.", "bad_usage")
    is_all_read = True
    if options.restore:
        found = services.restore_rows(file=options.restore, folder=folder)
    else:
        services.show_mending(program_id=options.id)  # so that an id that is none is told of first
        told = _read_unstored(options.id)
        if options.apply:
            found = services.mend_program(program_id=options.id, folder=folder, told=told or ())
        else:
            found = services.show_mending(program_id=options.id, told=told or ())
        is_all_read = told is not None
    is_whole = not found.left_out or options.apply
    if options.json:
        write_json(_to_json(found))
    else:
        _say(found, is_mended=options.apply)
    if not is_all_read:
        complain("Redis does not answer, so what was drawn in the last moments and is in no row yet is not in this.")
    return CLEAN if is_whole else FAULTY


def _read_unstored(program: str) -> tuple[Change, ...] | None:
    """Return what may be in no row yet; None where that cannot be asked."""
    from editor.rooms.stream_tail import StreamLost, read_unstored

    try:
        return read_unstored(program_id=program)
    except StreamLost:
        return None


def _say(found: Mending, *, is_mended: bool) -> None:
    of_rows = f"{found.rows - len(found.left_out)} of {found.rows} rows fit together"
    write(f"{found.name}: {of_rows}: {found.steps} steps, {found.functions} functions.")
    if found.told:
        write(f"{found.told_fitting} of {found.told} changes that are in no row yet fit together with them.")
    if found.left_out:
        rows = [(_name(each.seq, each.is_snapshot), each.author, str(each.size), f"{each.at:%Y-%m-%d %H:%M:%S}")
                for each in found.left_out]  # fmt: skip
        write_table([COLUMNS, *rows])
    if found.file is not None:
        write(f"What the database held before is saved in {found.file}")
        write(f"Put it back with: vipo mend-program --restore {found.file}")
    elif is_mended:
        write("Nothing is missing, so nothing was changed.")


def _name(seq: int, is_snapshot: bool) -> str:
    return f"{'snapshot' if is_snapshot else 'row'} {seq}"


def _to_json(found: Mending) -> dict[str, object]:
    out = [
        {
            "seq": each.seq,
            "snapshot": each.is_snapshot,
            "author": each.author,
            "bytes": each.size,
            "at": each.at.isoformat(),
        }
        for each in found.left_out
    ]
    return {
        "program": str(found.program),
        "name": found.name,
        "steps": found.steps,
        "functions": found.functions,
        "rows": found.rows,
        "left_out": out,
        "told": found.told,
        "told_fitting": found.told_fitting,
        "file": str(found.file) if found.file else None,
    }
