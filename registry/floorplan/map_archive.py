"""Map files in one zip archive, as people send them about; what unpacking may cost is bounded beforehand."""

from __future__ import annotations

import io
import lzma
import zipfile
import zlib
from collections.abc import Mapping
from pathlib import PurePosixPath

from registry.floorplan.map_server import MAX_IMAGE_BYTES, MAX_YAML_BYTES, BadMap, read_header

MOST_ENTRIES = 200
_ODD = (
    zipfile.BadZipFile,
    zlib.error,
    lzma.LZMAError,
    EOFError,
    NotImplementedError,
    OSError,
    RuntimeError,
    ValueError,
)
"""What zipfile raises of an archive that is damaged, encrypted or packed in a way that it does not know."""


def open_archive(data: bytes) -> tuple[bytes, bytes | None]:
    """Return a map's header and the image that it names, None where the archive has no such image.

    No more than a header's and an image's most bytes are unpacked, whatever the archive says of itself. Raises BadMap.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            return _take_out(archive)
    except _ODD as error:
        raise BadMap("The .zip file cannot be opened. Pack the map's .yaml file and its image again.") from error


def write_archive(files: Mapping[str, bytes]) -> bytes:
    """Return a .zip of files by their names; the same files make the same bytes."""
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files.items():
            archive.writestr(zipfile.ZipInfo(name), data, compress_type=zipfile.ZIP_DEFLATED)
    return packed.getvalue()


def _take_out(archive: zipfile.ZipFile) -> tuple[bytes, bytes | None]:
    entries = [entry for entry in archive.infolist() if not entry.is_dir() and not _is_litter(entry.filename)]
    if len(entries) > MOST_ENTRIES:
        raise BadMap(f"The .zip file has more than {MOST_ENTRIES} files. Pack only the map's .yaml file and its image.")
    headers = [entry for entry in entries if entry.filename.lower().endswith((".yaml", ".yml"))]
    if len(headers) != 1:
        raise BadMap(f"The .zip file has {len(headers) or 'no'} .yaml files; a map has one. Pack it with its image.")
    header = _unpack(archive, headers[0], MAX_YAML_BYTES)
    named = PurePosixPath(read_header(header).image.replace("\\", "/")).name
    image = next((entry for entry in entries if PurePosixPath(entry.filename).name == named), None)
    return header, None if image is None else _unpack(archive, image, MAX_IMAGE_BYTES)


def _is_litter(name: str) -> bool:
    """Tell of what some systems put into archives by themselves."""
    return name.startswith("__MACOSX/") or PurePosixPath(name).name.startswith(".")


def _unpack(archive: zipfile.ZipFile, entry: zipfile.ZipInfo, most: int) -> bytes:
    with archive.open(entry) as file:
        data = file.read(most + 1)
    if len(data) > most:
        raise BadMap(f"{entry.filename[:80]} in the .zip file unpacks to more than {most} bytes. Make the map smaller.")
    return data
