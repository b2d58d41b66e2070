"""A program that carries a box past a check, and tests of it that pass, fail and cannot be carried out."""

from __future__ import annotations

from typing import Any

import pytest

from editor import services as editor
from tests.kit.programs import SITE, document, step
from tests.kit.sign_in import post_json

PASSES = "name: It ends\nthen:\n  - ends: well\n  - step: {step: 1, times: 1}\n"
FAILS = "name: It is quick\nwhen: {seed: 7}\nthen:\n  - within_s: 1\n"
UNUSABLE = "name: It takes step 9\nthen:\n  - step: {step: 9}\n"


def waiting_program(**wait: Any) -> dict[str, Any]:
    """Return a program that decides, waits for five seconds, and is over."""
    branch = ("choice", "then")
    condition = {"op": ">", "args": [2, 1]}
    return document(
        {
            "choice": step("if", condition=condition),
            "pause": step("wait", branch, duration=5, **wait),
        }
    )


@pytest.fixture
def program(factory):
    return editor.create_program(site=SITE, name="Wait a bit", document=waiting_program()).id


def add(client: Any, program: Any, text: str) -> dict[str, Any]:
    made = post_json(client, f"/api/programs/{program}/tests", {"text": text})
    assert made.status_code == 201, made.content
    return dict(made.json())


def put(client: Any, path: str, text: str, tag: str) -> Any:
    return client.put(path, {"text": text}, content_type="application/json", headers={"If-Match": tag} if tag else {})
