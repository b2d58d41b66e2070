"""A program that holds what no text may hold, from a time before the rule or from a client of its own, still works."""

from __future__ import annotations

import json
from typing import Any

import pytest

from editor import services as editor
from execution.models import Run
from tests.integration.execution.conftest import factory as factory
from tests.kit.programs import SITE, TASK, document, step
from tests.kit.sign_in import join_and_sign_in

pytestmark = pytest.mark.django_db(transaction=True)


@pytest.mark.parametrize("unfit", ["\0", "\x07", "\u202e"])
def test_a_program_with_unfit_texts_is_listed_kept_as_a_version_and_run(factory: Any, unfit: str) -> None:
    said = step("notify", order="W", message=f"mind{unfit} the door", level="info")
    note = step("comment", order="0V", text=f"a comment{unfit}")
    drawn = document({**TASK["steps"], "said": said, "note": note})
    program = str(editor.create_program(site=SITE, name="Task", document=drawn).id)
    client = join_and_sign_in("operator", SITE)
    assert client.get(f"/api/sites/{SITE}/programs").status_code == 200
    answer = client.post(f"/api/programs/{program}/runs", json.dumps({}), content_type="application/json")
    assert answer.status_code == 202, answer.json()
    assert Run.objects.count() == 1
    script = client.get(f"/api/programs/{program}/compiled").json()
    assert "mind the door" in json.dumps(script)
    assert unfit not in json.dumps(script, ensure_ascii=False)
