"""Values of a shared document as plain JSON, and a hash of such. Pure."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Mapping
from typing import Any

from vipo_device.protocol.texts import cleaned, find_unfit, normal

_SAFE_INTEGER = 2**53


def digest_of(document: Mapping[str, Any]) -> str:
    """Return a hash of a plain document's content."""
    text = json.dumps(document, sort_keys=True, separators=(",", ":"), ensure_ascii=True)
    return hashlib.sha256(text.encode()).hexdigest()


def plain(value: Any) -> Any:
    """Return JSON with whole numbers as integers, as they were typed: Yjs knows only one kind of number."""
    if isinstance(value, str):
        return cleaned(value)
    if isinstance(value, dict):
        return {normal(key): plain(item) for key, item in value.items() if not find_unfit(key)}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, float):
        return _number(value)
    if value is None or isinstance(value, bool | int):
        return value
    return None  # bytes and the like are not JSON: a value that is still to be entered


def _number(value: float) -> float | int | None:
    if not math.isfinite(value):
        return None
    return int(value) if value.is_integer() and abs(value) < _SAFE_INTEGER else value
