"""Reads one DXF drawing, in a process of its own that may be killed at any time.

The file comes on standard input, what is drawn in it goes to standard output as JSON; the exit code says which kind of
answer it is. Curves become lines, blocks are drawn where they are inserted, what is no line (texts, dimensions,
hatches) is counted and left out. Nothing that a file refers to is fetched: a block of another file counts as XREF, one
that is nowhere as INSERT.
"""

from __future__ import annotations

import io
import json
import os
import re
import resource
import sys
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from math import isfinite
from typing import Any

from ezdxf import recover
from ezdxf.audit import AuditError
from ezdxf.document import Drawing
from ezdxf.entities.dxfentity import DXFEntity
from ezdxf.entities.dxfgfx import DXFGraphic
from ezdxf.entities.insert import Insert
from ezdxf.lldxf.const import DXFError
from ezdxf.path import Path, make_path

READ, REFUSED, TOO_LARGE = 0, 3, 4
BEHIND_THE_SERVER = 10
CPU_S = 20
MEMORY_BYTES = 1536 * 1024 * 1024
MOST_ENTITIES = 100_000
"""Of the drawing with all that its blocks stand for."""
MOST_POINTS = 400_000
MOST_LAYERS = 500
MOST_DEPTH = 12
"""So deep blocks may stand in blocks."""
FARTHEST = 1e11
"""In the drawing's units: a country's survey in millimetres reaches 6e9. Farther out lie only damaged lines."""
SAG = 0.002
"""How far a line may cut a curve short, as a share of the curve's size."""
METRES = {1: 0.0254, 2: 0.3048, 4: 0.001, 5: 0.01, 6: 1.0, 10: 0.9144, 14: 0.1}
"""What a drawing's unit is by $INSUNITS: inches, feet, millimetres, centimetres, metres, yards, decimetres."""
VERSION = re.compile(rb"\$ACADVER[ \t]*\r?\n[ \t]*1[ \t]*\r?\n[ \t]*(AC\d{4})[ \t]*\r?\n")
UTF8_SINCE = b"AC1021"
"""From this version on texts are UTF-8, also where no code page is named (AutoCAD 2007)."""
END_BYTES = b" \t\r\n\0\x1a"
"""What may stand behind the mark at a drawing's end."""
DRAWN = {"LINE", "LWPOLYLINE", "POLYLINE", "ARC", "CIRCLE", "ELLIPSE", "SPLINE"}


class Refused(Exception):
    """The drawing is not read; the sentence says why and how to mend it."""

    def __init__(self, sentence: str, code: int = REFUSED) -> None:
        super().__init__(sentence)
        self.code = code


@dataclass
class Layer:
    """What is drawn on a layer: lines of x, y, x, y … in units of the drawing."""

    is_hidden: bool
    lines: list[list[float]] = field(default_factory=list)


class Reader:
    """Goes through a drawing and keeps what is a line, as long as it does not cost too much."""

    def __init__(self, drawing: Drawing) -> None:
        self._drawing = drawing
        self._entities = self._points = 0
        self.layers: dict[str, Layer] = {}
        self.skipped: Counter[str] = Counter()

    def take(self, entities: Iterable[DXFEntity], layer: str = "0", depth: int = 0) -> None:
        """Take in entities; what lies on layer 0 of a block is on the layer on which the block is inserted."""
        for entity in entities:
            self._entities += 1
            if self._entities > MOST_ENTITIES:
                raise Refused(f"The drawing has more than {MOST_ENTITIES} parts. Leave out what is no wall.", TOO_LARGE)
            own = str(entity.dxf.get("layer", "0"))
            here = layer if own == "0" and depth else own
            if isinstance(entity, Insert):
                self._insert(entity, here, depth)
            elif entity.dxftype() in DRAWN and isinstance(entity, DXFGraphic):
                self._draw(entity, here)
            else:
                self.skipped[entity.dxftype()[:40]] += 1

    def _insert(self, block: Insert, layer: str, depth: int) -> None:
        if depth >= MOST_DEPTH:
            raise Refused(
                f"Blocks stand in blocks more than {MOST_DEPTH} deep. Resolve them in the drawing.", TOO_LARGE
            )
        if block.mcount > MOST_ENTITIES:
            raise Refused(f"A block is repeated {block.mcount} times. Leave out what is no wall.", TOO_LARGE)
        if block.is_xref() and not len(block.block() or ()):
            self.skipped["XREF"] += 1
            return
        for each in block.multi_insert() if block.mcount > 1 else (block,):
            self.take(each.virtual_entities(), layer, depth + 1)

    def _draw(self, entity: DXFGraphic, layer: str) -> None:
        if layer not in self.layers:
            if len(self.layers) >= MOST_LAYERS:
                raise Refused(f"The drawing has more than {MOST_LAYERS} layers. Keep those with walls.", TOO_LARGE)
            self.layers[layer] = Layer(self._is_hidden(layer))
        try:
            path = make_path(entity)
        except (TypeError, ValueError, ArithmeticError, DXFError):
            self.skipped[entity.dxftype()] += 1
            return
        for part in path.sub_paths():
            self._add(self.layers[layer], part)

    def _add(self, layer: Layer, path: Path) -> None:
        corners = path.control_vertices()
        if len(corners) < 2:
            return
        if not all(isfinite(v) and abs(v) < FARTHEST for c in corners for v in (c.x, c.y)):
            self.skipped["FAR"] += 1
            return
        size = max(_span([c.x for c in corners]), _span([c.y for c in corners]))
        points = path.flattening(max(size * SAG, 1e-9), 4) if path.has_curves else iter(corners)
        line: list[float] = []
        for point in points:
            self._points += 1
            if self._points > MOST_POINTS:
                raise Refused(f"The drawing has more than {MOST_POINTS} corners. Leave out what is no wall.", TOO_LARGE)
            line += (round(point.x, 5), round(point.y, 5))
        layer.lines.append(line)

    def _is_hidden(self, layer: str) -> bool:
        if layer not in self._drawing.layers:
            return False
        found = self._drawing.layers.get(layer)
        return bool(found.is_off() or found.is_frozen())


def _span(values: list[float]) -> float:
    return max(values) - min(values)


def _is_lost_block(code: int, message: str) -> bool:
    """Tell whether ezdxf has taken out a block that is nowhere; it has the same code for dimensions and styles."""
    return code == AuditError.UNDEFINED_BLOCK and message.startswith("Deleted entity INSERT")


def read_drawing(data: bytes) -> dict[str, Any]:
    """Return what is drawn in a DXF file, and how many metres its unit is (None: it does not say). Raises Refused."""
    if data[:4] == b"AC10":
        raise Refused("This is a DWG file. Save the drawing as DXF.")
    if data[:18] == b"AutoCAD Binary DXF":
        raise Refused("This is a binary DXF file. Save the drawing as ASCII DXF.")
    broken = "The file is no DXF drawing, or it is damaged. Save it again as DXF (ASCII)."
    if b"SECTION" not in data:
        raise Refused(broken)
    try:
        drawing, audit = recover.read(io.BytesIO(with_code_page(data)))
    except (DXFError, OSError, ValueError, TypeError, LookupError, AttributeError, ArithmeticError) as error:
        raise Refused(broken) from error
    reader = Reader(drawing)
    if nowhere := sum(1 for fix in audit.fixes if _is_lost_block(fix.code, fix.message)):
        reader.skipped["INSERT"] = nowhere  # the reader has taken them out already
    reader.take(drawing.modelspace())
    if not any(layer.lines for layer in reader.layers.values()):
        is_whole = data.rstrip(END_BYTES).endswith(b"EOF")
        raise Refused(_why_empty(reader) if is_whole else broken)
    unit = drawing.header.get("$INSUNITS", 0)
    return {"metres": METRES.get(unit), "layers": list(_told(reader.layers)), "skipped": dict(reader.skipped)}


def with_code_page(data: bytes) -> bytes:
    """Return a drawing in UTF-8 with a code page, which ezdxf wants to see before it takes texts as such.

    What is no UTF-8, though its version asks for that, is read as before.
    """
    version = VERSION.search(data)
    if version is None or version[1] < UTF8_SINCE or b"$DWGCODEPAGE" in data:
        return data
    try:
        data.decode()
    except UnicodeDecodeError:
        return data
    return data[: version.end()] + b"  9\n$DWGCODEPAGE\n  3\nANSI_1252\n" + data[version.end() :]


def _why_empty(reader: Reader) -> str:
    if lost := reader.skipped["XREF"] + reader.skipped["INSERT"]:
        return (
            f"The drawing has no lines in its model space: the blocks there ({lost}) lie in other files or nowhere. "
            "Bind them into the drawing, and save it again."
        )
    if far := reader.skipped["FAR"]:
        return f"All {far} lines lie farther than {FARTHEST:g} units from the drawing's origin. Move it to the origin."
    return "The drawing has no lines in its model space. Choose the drawing with the walls."


def _told(layers: dict[str, Layer]) -> Iterator[dict[str, Any]]:
    for name, layer in sorted(layers.items()):
        if layer.lines:
            yield {"name": name[:255], "hidden": layer.is_hidden, "lines": layer.lines}


def main() -> int:
    """Read the drawing on standard input; return the exit code."""
    os.nice(BEHIND_THE_SERVER)
    resource.setrlimit(resource.RLIMIT_CPU, (CPU_S, CPU_S + 1))
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY_BYTES, MEMORY_BYTES))
    try:
        answer, code = json.dumps(read_drawing(sys.stdin.buffer.read())), READ
    except Refused as refusal:
        answer, code = str(refusal), refusal.code
    except (MemoryError, RecursionError):
        answer, code = "The drawing needs more memory than it may have. Leave out what is no wall.", TOO_LARGE
    sys.stdout.write(answer)
    return code


if __name__ == "__main__":
    sys.exit(main())
