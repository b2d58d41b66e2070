"""The site that programs are tested against: the painting factory of the examples."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import lru_cache
from typing import Any

from editor.language import Surroundings, compile_document, surroundings_from_json
from tests.kit.files import ROOT


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


def codes(document: dict[str, Any], site: Surroundings | None = None) -> list[tuple[str, str]]:
    """Return what is wrong with a program, each with its step."""
    return [(d.step, d.code) for d in compile_document(document, site or factory()).diagnostics]


RUN = """
    def run(self, ctx):
        self.robot = ctx.get("robot01")
        self.item_inventory = ctx.get("itemInventory01")
        self.painting_machine = ctx.get("paintMachine01")
        self.curing_oven = ctx.get("curingOven01")
        self.new_task()
"""


def script(*lines: str) -> str:
    """Return a script whose task has these lines."""
    body = "\n".join(f"        {line}" for line in lines)
    return f"class Task(object):\n    def new_task(self):\n{body}\n{RUN}"
