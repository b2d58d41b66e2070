"""DXF drawings as people bring them: each is read in a process of its own, which is ended when it takes too much."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
from typing import TYPE_CHECKING, Any

from django.conf import settings
from django.core.files.uploadedfile import UploadedFile

from registry.errors import RegistryError
from registry.floorplan.map_server import MAX_IMAGE_BYTES
from registry.maps.uploads import in_turn
from registry.models import User
from registry.processes.children import sigint_blocked

WALL_S = 120.0
READ, REFUSED, TOO_LARGE = 0, 3, 4
"""The exit codes of registry/maps/drawing_reader.py, which is never imported here: ezdxf stays out of the server."""
if TYPE_CHECKING:
    Upload = UploadedFile[Any]


class BadDrawing(RegistryError):
    """A drawing that cannot be read; the sentence says what is wrong and how to mend it."""

    code = "bad_drawing"
    status = 422


def read_brought_drawing(*, drawing: Upload | None, by: User) -> dict[str, Any]:
    """Return what is drawn in a DXF file: `metres` of its unit (None: unknown), `layers` with lines, `skipped` counts.

    Raises BadDrawing, TooManyUploads.
    """
    if drawing is None:
        raise BadDrawing("The drawing is missing. Choose a .dxf file.")
    if (drawing.size or 0) > MAX_IMAGE_BYTES:
        raise BadDrawing(
            f"The drawing has {drawing.size} bytes; {MAX_IMAGE_BYTES} is the most. Leave out what is no wall."
        )
    data = bytes(drawing.read())
    code, output = in_turn(by, lambda: _run(data))
    if code == READ:
        found: dict[str, Any] = json.loads(output)
        return found
    if code in (REFUSED, TOO_LARGE):
        raise BadDrawing(output.decode(errors="replace"))
    raise BadDrawing("Reading the drawing takes too long or too much memory. Leave out what is no wall.")


def _run(data: bytes) -> tuple[int, bytes]:
    """Run the reader on a file; return its exit code and what it said. It is gone when this returns."""
    with sigint_blocked():
        reader = subprocess.Popen(
            [sys.executable, "-m", "registry.maps.drawing_reader"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env={"PYTHONPATH": str(settings.BASE_DIR), "PYTHONUTF8": "1"},
            cwd=settings.BASE_DIR,
        )
    with reader as process:
        try:
            output, _ = process.communicate(data, timeout=WALL_S)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
            return -signal.SIGXCPU, b""
    return process.returncode, output
