"""What is another site's and what is nowhere are refused alike, by every call that names a thing by its id."""

from __future__ import annotations

import json
import re
from typing import Any
from uuid import uuid4

import pytest

from editor.models import Program
from execution.models import Rehearsal, Run
from registry import services
from registry.models import Device, DeviceAlert
from tests.kit.api_rights import OPERATIONS, RIGHTS
from tests.kit.sign_in import add_person, signed_in
from tests.kit.sites import NOW, approve

NAMED = sorted(
    (method, path)
    for path, methods in OPERATIONS.items()
    for method in methods
    if RIGHTS[methods[method]["operationId"]].is_of_site
)
pytestmark = pytest.mark.usefixtures("impatient")
TIMES = re.compile(r'creationTime="[^"]*"')
BODIES: dict[str, Any] = {
    "/api/sites/{slug}/newcomers": {"id": "x"},
}


def fill(path: str, names: dict[str, str]) -> str:
    return re.sub(r"\{(?:\w+:)?(\w+)\}", lambda found: names.get(found[1], "1"), path)


def answer(method: str, path: str, names: dict[str, str]) -> tuple[int, str]:
    """Return the status and the body, without the names that were asked for."""
    client = signed_in("keeper")
    form = "application/merge-patch+json" if path.endswith("{thing}") else "application/json"
    more = {} if method == "get" else {"data": json.dumps(BODIES.get(path, {"title": "Mine"})), "content_type": form}
    said = getattr(client, method)(fill(path, names), **more)
    text = said.content.decode()
    for name in (each for each in names.values() if len(each) > 3):
        text = text.replace(name, "NAME")
    return said.status_code, TIMES.sub("TIME", text)


@pytest.fixture
def foreign(hall: str) -> dict[str, str]:
    """Give the names of what there is at a site of which the asker is no member, who is admin of another."""
    approve()
    services.create_site(name="Yard", slug="yard")
    add_person("keeper")
    services.set_member(site="yard", email="keeper@vipo.example", role="admin")
    program = Program.objects.create(site_id=services.get_site_id(site="hall"), name="Secret", edited_at=NOW)
    assert Device.objects.get(pk="mixer1").site.slug == "hall"
    site = {"site_id": services.get_site_id(site="hall"), "program": program.pk, "created_at": NOW}
    run = Run.objects.create(number=1, **site)
    rehearsal = Rehearsal.objects.create(**site)
    services.raise_alert(device_id="mixer1", code="flapping", at=NOW)
    return {
        "device_id": "mixer1",
        "device": "mixer1",
        "thing": "mixer1",
        "program": str(program.pk),
        "function": str(program.pk),
        "run": str(run.pk),
        "rehearsal": str(rehearsal.pk),
        "alert_id": str(DeviceAlert.objects.get().pk),
        "call": str(uuid4()),
    }


@pytest.mark.parametrize(("method", "path"), NAMED)
def test_what_is_foreign_is_refused_like_what_is_nowhere(foreign: dict[str, str], method: str, path: str) -> None:
    words = {"device_id": "nobody", "device": "nobody", "thing": "nobody", "alert_id": "987654"}
    absent = {name: words.get(name, str(uuid4())) for name in foreign}
    sites = [("hall", "nowhere"), *([("yard", "yard")] if any(f"{name}}}" in path for name in foreign) else [])]
    for site_here, site_absent in sites:
        here = answer(method, path, {**foreign, "slug": site_here, "site": site_here})
        nowhere = answer(method, path, {**absent, "slug": site_absent, "site": site_absent})
        assert here == nowhere
        assert here[0] >= 400
