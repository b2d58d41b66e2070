"""What a thread is about, and whether that still stands in the program."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any, Literal

Asked = Literal["program", "construct", "arrow", "place"]
"""What members may ask to be talked about; of a moment of a run the app that has the runs tells."""
Kind = Literal[Asked, "moment"]
Root = Literal["steps", "functions", "roles", "parameters", "zones"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Anchor:
    """What a thread is about.

    `root` and `id` name a construct; an arrow leads from the step `id` to the step `to`. `x` and `y` are where its pin
    stood on the map when the thread began, metres; a place is nothing else. A moment is `t_s` seconds after the start
    of the run `run`, the site's run `number`.
    """

    kind: Kind
    root: Root | None = None
    id: str | None = None
    to: str | None = None
    x: float | None = None
    y: float | None = None
    run: str | None = None
    number: int | None = None
    t_s: float | None = None


def find_missing(anchor: Anchor) -> str:
    """Return what an anchor of its kind lacks, as a sentence; empty if it is whole."""
    if anchor.kind == "construct" and not (anchor.root and anchor.id):
        return "A comment on a construct names it: give its root and its id."
    if anchor.kind == "arrow" and not (anchor.id and anchor.to):
        return "A comment on an arrow names both steps: give id and to."
    if anchor.kind == "place" and (anchor.x is None or anchor.y is None):
        return "A comment on a place says where: give x and y in metres."
    return ""


def is_drawn(kind: str) -> bool:
    """Tell whether things of this kind are in the document, and so may be deleted from it."""
    return kind in ("construct", "arrow")


def stands_in(anchor: Anchor, document: Mapping[str, Any]) -> bool:
    """Tell whether what a thread is about is in this document; places, moments and the program itself always are."""
    if anchor.kind == "construct":
        return _has(document, anchor.root or "", anchor.id)
    if anchor.kind == "arrow":
        return _has(document, "steps", anchor.id) and _has(document, "steps", anchor.to)
    return True


def _has(document: Mapping[str, Any], root: str, name: str | None) -> bool:
    held = document.get(root)
    return isinstance(held, Mapping) and name in held


def anchor_to_json(anchor: Anchor) -> dict[str, Any]:
    """Return an anchor as it is kept: only what it has."""
    return {name: value for name, value in asdict(anchor).items() if value is not None}
