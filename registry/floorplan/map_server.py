"""ROS map_server files: a YAML header with a PGM or PNG image, read with suspicion and written back.

Reading follows map_server: lightness decides, `negate` turns it round, `mode` is trinary, scale or raw. A scale map's
in-between cells and a raw map's values are judged by the thresholds, since our grid knows three kinds of cells. ROS 2's
map_saver writes unknown cells as a grey that its own free_thresh of 0.25 calls free; in its maps they stay unknown. An
origin with a yaw is turned upright by nearest neighbour, so that every grid stands along the map frame's axes.
"""

from __future__ import annotations

import io
import re
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from math import cos, isfinite, pi, sin
from typing import Any

import numpy as np
import yaml
from numpy.typing import NDArray
from PIL import Image, UnidentifiedImageError

from registry.errors import RegistryError
from registry.floorplan.extent import why_too_large
from registry.floorplan.plan import FREE, OCCUPIED, UNKNOWN, Grid, cells_array

MAX_SIDE = 4096
MAX_IMAGE_BYTES = 16 * 1024 * 1024
MAX_YAML_BYTES = 64 * 1024
MAX_BRACKETS = 64
LONGEST_NUMBER = 40
"""Characters of a number of the header; a longer one stays the text that it is."""
BAND_ROWS, PIECE_BYTES = 256, 1 << 18
"""An image is worked on in bands, its text in pieces: beside the cells themselves, little is held at a time."""
MOST_COMMENTS = 1000
_DIGITS_AND_SPACE = b"0123456789 \t\r\n\v\f"
_NUMBERS = frozenset(("tag:yaml.org,2002:int", "tag:yaml.org,2002:float"))
_PNG_HEAD = b"\x89PNG\r\n\x1a\n"
_PIXELS = {OCCUPIED: 0, FREE: 254, UNKNOWN: 205}
_SAVERS = np.array((0, 205, 254, 255)) / 255
"""The shades of map_saver: an image that has no others is one of its, and so is what its grey means."""
_SHADE_HAIR = 1e-4
_FREE_OR_NOT = 205
"""A cell of map_saver's grey that counts as free by the thresholds, until all of the image is known."""
Cells = NDArray[np.uint8]
Shades = NDArray[np.float32]
Band = tuple[Shades, Shades | None]
"""Some rows of an image: lightness 0..1 and, where it has alpha, opacity 0..1; top row first."""
Bands = Iterator[Band]


class BadMap(RegistryError):
    """A map file that cannot be read; the sentence says what is wrong and how to mend it."""

    code = "bad_map"
    status = 422


@dataclass(frozen=True, slots=True)
class Header:
    """The YAML part: metres and radians; thresholds are shares of darkness."""

    image: str
    resolution_m: float
    origin: tuple[float, float, float]
    negate: bool = False
    occupied_thresh: float = 0.65
    free_thresh: float = 0.196
    mode: str = "trinary"


def read_map(yaml_bytes: bytes, image_bytes: bytes | None) -> Grid:
    """Return the grid of a map; `image_bytes` is None when the image did not come along. Raises BadMap."""
    header = read_header(yaml_bytes)
    if not image_bytes:
        raise BadMap(f"The map's image {header.image!r} is missing. Choose it together with the .yaml file.")
    if len(image_bytes) > MAX_IMAGE_BYTES:
        raise BadMap("The map's image is larger than 16 MB. Crop it or save it with a coarser resolution.")
    (height, width), bands = _read_image(image_bytes)
    cells, bottom = np.empty((height, width), dtype=np.uint8), height
    is_savers = header.mode == "trinary" and not header.negate
    for lightness, alpha in bands:
        top = bottom - lightness.shape[0]
        is_savers = is_savers and bool(np.any([_is_shade(lightness, each) for each in _SAVERS], axis=0).all())
        cells[top:bottom] = np.flipud(_classify(lightness, alpha, header))
        bottom = top
    cells[cells == _FREE_OR_NOT] = UNKNOWN if is_savers else FREE
    grid = _upright(cells, header)
    check_extent(grid)
    return grid


def read_header(yaml_bytes: bytes) -> Header:
    """Return the YAML part of a map; unknown keys are left aside. Raises BadMap."""
    fields = _load_yaml(yaml_bytes)
    mode = str(fields.get("mode", "trinary")).lower()
    if mode not in {"trinary", "scale", "raw"}:
        raise BadMap(f"The map's mode is {mode[:40]!r}. Use trinary, scale or raw.")
    image = fields.get("image")
    if not isinstance(image, str) or not image.strip():
        raise BadMap("The .yaml file names no image. Add a line such as `image: map.pgm`.")
    resolution = _number(fields, "resolution", None)
    if not 0.001 <= resolution <= 10:
        raise BadMap(f"The map's resolution is {resolution:g} m. It must be between 0.001 and 10 metres for each cell.")
    occupied, free = _number(fields, "occupied_thresh", 0.65), _number(fields, "free_thresh", 0.196)
    if not 0 <= free <= occupied <= 1:
        raise BadMap("The thresholds must satisfy 0 <= free_thresh <= occupied_thresh <= 1.")
    return Header(image.strip(), resolution, _origin(fields), _negate(fields), occupied, free, mode)


def _without_sixties(pattern: re.Pattern[str]) -> re.Pattern[str]:
    return re.compile(rf"(?![-+]?[0-9][0-9_]*(?::[0-9]))(?:{pattern.pattern})", pattern.flags)


class _PlainLoader(yaml.SafeLoader):
    """SafeLoader without anchors, of which a few can stand for gigabytes, and without numbers to the base of sixty.

    ROS reads `1:30` as a text (YAML 1.2), YAML 1.1 as 90: here it is a text, and so no resolution. So is a number that
    is too long to be meant; Python refuses to print some of them.
    """

    yaml_implicit_resolvers = {
        first: [(tag, _without_sixties(pattern)) for tag, pattern in resolvers]
        for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()
    }

    def compose_node(self, parent: yaml.Node | None, index: int) -> yaml.Node | None:
        if self.check_event(yaml.AliasEvent):
            raise BadMap("The .yaml file uses aliases (*name). A map's header needs none; remove them.")
        node = super().compose_node(parent, index)
        if isinstance(node, yaml.ScalarNode) and node.tag in _NUMBERS and len(node.value) > LONGEST_NUMBER:
            node.tag = "tag:yaml.org,2002:str"
        return node


_ODD_YAML = (yaml.YAMLError, ValueError, LookupError, AttributeError, ArithmeticError, TypeError, RecursionError)
"""What PyYAML raises of a text that is no YAML, and of values that do not fit their tags, such as `!!bool x`."""


def _load_yaml(yaml_bytes: bytes) -> dict[str, Any]:
    if len(yaml_bytes) > MAX_YAML_BYTES:
        raise BadMap("The .yaml file is larger than 64 kB. Choose the map's header, which has a handful of lines.")
    if yaml_bytes.count(b"[") + yaml_bytes.count(b"{") > MAX_BRACKETS:
        raise BadMap("The .yaml file is nested too deeply for a map's header. Choose the map's .yaml file.")
    try:
        fields = yaml.load(yaml_bytes.decode("utf-8-sig"), Loader=_PlainLoader)  # noqa: S506 - a SafeLoader, stricter
    except _ODD_YAML as error:
        first_line = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise BadMap(
            f"The .yaml file cannot be read ({first_line[:120]}). Compare it with a map_server file."
        ) from error
    if not isinstance(fields, dict):
        raise BadMap("The .yaml file is not a map's header. It needs lines such as `image:`, `resolution:`, `origin:`.")
    return {str(k): v for k, v in fields.items()}


def _number(fields: dict[str, Any], name: str, default: float | None) -> float:
    value = fields.get(name, default)
    if value is None:
        raise BadMap(f"The .yaml file has no {name}. Add it, for example `{name}: 0.05`.")
    try:
        number = float(value)
    except (TypeError, ValueError, OverflowError):
        number = float("nan")
    if isinstance(value, bool) or not isfinite(number):
        raise BadMap(f"The map's {name} is {str(value)[:40]!r}, which is not a number. Write one, such as 0.05.")
    return number


def _origin(fields: dict[str, Any]) -> tuple[float, float, float]:
    values = fields.get("origin")
    if not isinstance(values, list) or len(values) not in (2, 3):
        raise BadMap("The map's origin must be three numbers: `origin: [x, y, yaw]` in metres and radians.")
    x, y, yaw = (_number({"origin": v}, "origin", None) for v in (*values, 0)[:3])
    if max(abs(x), abs(y)) > 1e6 or abs(yaw) > 100:
        raise BadMap("The map's origin lies beyond a million metres. Check `origin: [x, y, yaw]`.")
    return x, y, yaw


def _negate(fields: dict[str, Any]) -> bool:
    value = fields.get("negate", 0)
    if value not in (0, 1, True, False, "0", "1"):
        raise BadMap(f"The map's negate is {str(value)[:40]!r}. Use 0 or 1.")
    return bool(int(value))


def _read_image(data: bytes) -> tuple[tuple[int, int], Bands]:
    """Return height and width, and the image's bands from the top; the size is looked at before anything is decoded."""
    if data[:2] in (b"P2", b"P5"):
        return _read_pgm(data)
    if not data.startswith(_PNG_HEAD):
        raise BadMap("The map's image is neither PGM (P2, P5) nor PNG. Save it as one of them.")
    if data[12:16] == b"IHDR" and len(data) >= 24:
        check_size(int.from_bytes(data[16:20]), int.from_bytes(data[20:24]))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", Image.DecompressionBombWarning)
            image = Image.open(io.BytesIO(data), formats=["PNG"])
            check_size(*image.size)
            image.load()
    except _ODD_PNG as error:
        raise BadMap("The map's PNG image is damaged. Export it again.") from error
    width, height = image.size
    tops = range(0, height, BAND_ROWS)
    return (height, width), (_lightness(image.crop((0, y, width, min(y + BAND_ROWS, height)))) for y in tops)


_ODD_PNG = (
    UnidentifiedImageError,
    OSError,
    SyntaxError,
    ValueError,
    LookupError,
    Image.DecompressionBombError,
    Image.DecompressionBombWarning,
)
"""What Pillow raises of a PNG that is damaged, or in which a second header says another size than the first."""


def _lightness(image: Image.Image) -> Band:
    if image.mode.startswith(("I", "F")):
        deep = np.asarray(image, dtype=np.float32)
        return np.clip(deep / np.float32(65535), 0.0, 1.0), None
    colours = np.asarray(image.convert("RGBA"))
    opaque = image.mode in {"RGB", "L", "1"} and "transparency" not in image.info
    lightness = colours[:, :, :3].sum(axis=2, dtype=np.uint16).astype(np.float32) / np.float32(765)
    return lightness, None if opaque else colours[:, :, 3].astype(np.float32) / np.float32(255)


def check_size(width: int, height: int) -> None:
    """Raise BadMap when a map has no cells, or more on a side than screens and planning take."""
    if width < 1 or height < 1:
        raise BadMap("The map's image is empty. Save the map again.")
    if width > MAX_SIDE or height > MAX_SIDE:
        raise BadMap(
            f"The map is {width} x {height} cells; {MAX_SIDE} x {MAX_SIDE} is the most. Use a coarser resolution."
        )


def check_extent(grid: Grid) -> None:
    """Raise BadMap when a map has more floor in square metres than can be planned on."""
    if why := why_too_large(grid, lambda: grid.cells.count(FREE)):
        raise BadMap(why)


def _read_pgm(data: bytes) -> tuple[tuple[int, int], Bands]:
    (width, height, maximum), start = _pgm_tokens(data)
    check_size(width, height)
    if not 1 <= maximum <= 65535:
        raise BadMap(f"The PGM's largest value is {maximum}. It must lie between 1 and 65535.")
    count = width * height
    values = _pgm_text(data, start, count) if data[:2] == b"P2" else _pgm_binary(data, start, maximum, count)
    if values.size < count:
        raise BadMap(f"The PGM ends early: {values.size} of {count} cells. Copy the whole file again.")
    pixels = values.reshape(height, width)
    return (height, width), (_shades(pixels[y : y + BAND_ROWS], maximum) for y in range(0, height, BAND_ROWS))


def _shades(values: NDArray[Any], maximum: int) -> Band:
    shades = values.astype(np.float32)
    shades /= np.float32(maximum)
    return np.minimum(shades, np.float32(1), dtype=np.float32), None


_NUMBER = re.compile(rb"\s*(?:#[^\n]*\n\s*)*(\d{1,9})(?=[\s#])")
_COMMENT = re.compile(rb"[ \t]*#[^\n]*")


def _pgm_tokens(data: bytes) -> tuple[list[int], int]:
    """Return width, height and largest value, and where the cells begin; comments may stand anywhere between."""
    head, position, tokens = data[:8192], 2, list[int]()
    while len(tokens) < 3:
        found = _NUMBER.match(head, position)
        if found is None:
            raise BadMap("The PGM's header is damaged; it needs `P5 width height maxval`. Save the map again.")
        tokens.append(int(found.group(1)))
        position = found.end()
    comment = _COMMENT.match(head, position)
    return tokens, (comment.end() if comment else position) + 1


def _pgm_text(data: bytes, start: int, count: int) -> NDArray[np.uint16]:
    """Return the first `count` numbers of a text, or as many as there are; a piece at a time is taken apart."""
    if data.count(b"#") > MOST_COMMENTS:
        raise BadMap(f"The PGM has more than {MOST_COMMENTS} comments. Save the map again, as P5 if you can.")
    values, filled = np.empty(count, dtype=np.uint16), 0
    while filled < count and start < len(data):
        words, start = _next_words(data, start)
        if words.translate(None, _DIGITS_AND_SPACE):
            raise BadMap("The PGM holds something that is not a number. Save the map again.")
        if not words or words.isspace():
            continue
        found = np.fromstring(words, dtype=np.int64, sep=" ")[: count - filled]
        values[filled : filled + found.size] = np.minimum(found, 65535)
        filled += found.size
    return values[:filled]


def _next_words(data: bytes, start: int) -> tuple[bytes, int]:
    """Return the text from `start` on up to a comment, or whole words of a piece of it, and where to go on."""
    end = start + PIECE_BYTES
    comment = data.find(b"#", start, end)
    if comment >= 0:
        line_end = data.find(b"\n", comment)
        return data[start:comment], line_end + 1 if line_end >= 0 else len(data)
    piece = data[start:end]
    if end >= len(data):
        return piece, len(data)
    whole = max(piece.rfind(space) for space in (b" ", b"\n", b"\t", b"\r"))
    if whole < 0:
        raise BadMap("The PGM holds something that is not a number. Save the map again.")
    return piece[:whole], start + whole


def _pgm_binary(data: bytes, start: int, maximum: int, count: int) -> NDArray[Any]:
    kind = np.dtype(">u2") if maximum > 255 else np.dtype("u1")
    there = max(0, len(data) - start) // kind.itemsize
    return np.frombuffer(data, dtype=kind, count=min(count, there), offset=min(start, len(data)))


def _is_shade(lightness: Shades, shade: float) -> NDArray[np.bool_]:
    return np.asarray(np.abs(lightness - np.float32(shade)) < _SHADE_HAIR)


def _classify(lightness: Shades, alpha: Shades | None, header: Header) -> Cells:
    """Return 0, 100, 205 or 255 for each cell; see-through cells are unknown."""
    cells = np.full(lightness.shape, UNKNOWN, dtype=np.uint8)
    if header.mode == "raw":
        share: NDArray[np.floating[Any]] = np.round(lightness * np.float32(255)) / np.float32(100)
        known = share <= 1.0
    else:
        share = lightness if header.negate else np.float32(1) - lightness
        known = np.ones(lightness.shape, dtype=np.bool_)
    cells[known & (share > header.occupied_thresh)] = OCCUPIED
    free = known & (share < header.free_thresh)
    cells[free] = FREE
    cells[free & _is_shade(lightness, _SAVERS[1])] = _FREE_OR_NOT
    if alpha is not None:
        cells[alpha < 0.5] = UNKNOWN
    return cells


def _upright(cells: Cells, header: Header) -> Grid:
    """Turn a map whose origin has a yaw so that it stands along the axes; new corners are unknown."""
    x, y, yaw = header.origin
    side = header.resolution_m
    turned = (yaw + pi) % (2 * pi) - pi
    if abs(turned) < 1e-6:
        return Grid(cells.shape[1], cells.shape[0], side, x, y, cells.tobytes())
    height, width = cells.shape
    turn_x, turn_y = cos(turned), sin(turned)
    corners = [(c * side, r * side) for c in (0, width) for r in (0, height)]
    xs = [x + a * turn_x - b * turn_y for a, b in corners]
    ys = [y + a * turn_y + b * turn_x for a, b in corners]
    new_width, new_height = (int(np.ceil(round((max(v) - min(v)) / side, 6))) for v in (xs, ys))
    check_size(new_width, new_height)
    upright = np.full((new_height, new_width), UNKNOWN, dtype=np.uint8)
    right = min(xs) + (np.arange(new_width)[None, :] + 0.5) * side - x
    for top in range(0, new_height, BAND_ROWS):
        band = upright[top : top + BAND_ROWS]
        up = min(ys) + (np.arange(top, top + band.shape[0])[:, None] + 0.5) * side - y
        columns = np.floor((right * turn_x + up * turn_y) / side).astype(np.int64)
        rows = np.floor((up * turn_x - right * turn_y) / side).astype(np.int64)
        inside = (columns >= 0) & (columns < width) & (rows >= 0) & (rows < height)
        band[inside] = cells[rows[inside], columns[inside]]
    return Grid(new_width, new_height, side, min(xs), min(ys), upright.tobytes())


def write_pgm(grid: Grid) -> bytes:
    """Return the grid as a binary PGM in map_server's three shades."""
    shades = np.full(256, _PIXELS[UNKNOWN], dtype=np.uint8)
    for kind, shade in _PIXELS.items():
        shades[kind] = shade
    pixels = np.flipud(shades[cells_array(grid)])
    return f"P5\n{grid.width} {grid.height}\n255\n".encode() + pixels.tobytes()


def write_yaml(grid: Grid, image: str) -> bytes:
    """Return the header that belongs to the PGM of that file name; read again it says the same to the last bit."""
    lines = (
        f"image: {image}",
        "mode: trinary",
        f"resolution: {plain_number(grid.resolution_m)}",
        f"origin: [{plain_number(grid.origin_x_m)}, {plain_number(grid.origin_y_m)}, 0]",
        "negate: 0",
        "occupied_thresh: 0.65",
        "free_thresh: 0.196",
    )
    return ("\n".join(lines) + "\n").encode()


def plain_number(value: float) -> str:
    """Return the shortest decimal that means this very number, without an exponent, which not every reader takes."""
    return np.format_float_positional(value, trim="0")
