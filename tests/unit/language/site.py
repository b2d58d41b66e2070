"""The site that programs are tested against: the painting factory of the examples."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import lru_cache
from pathlib import Path

from editor.language import Surroundings, surroundings_from_json

ROOT = Path(__file__).resolve().parents[3]


@lru_cache(maxsize=1)
def factory() -> Surroundings:
    """Return the painting factory as the examples have it, of whose library nothing is known."""
    site = surroundings_from_json(json.loads((ROOT / "examples" / "painting-factory.json").read_text()))
    return replace(site, library=None)


def with_device(device: str, **facts: object) -> Surroundings:
    """Return the factory with one device changed."""
    site = factory()
    changed = replace(site.devices[device], **facts)  # type: ignore[arg-type]
    return replace(site, devices={**site.devices, device: changed})
