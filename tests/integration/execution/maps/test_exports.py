"""A site's floor in the forms of other fleet managers, over HTTP."""

from __future__ import annotations

import io
import json
import zipfile
from typing import Any

import pytest
import yaml
from django.test import Client

from execution.floor.exports import routes
from registry import services as registry
from tests.kit.programs import SITE
from tests.kit.sign_in import find_person, join_and_sign_in, post_json

pytestmark = pytest.mark.django_db
AT = f"/api/sites/{SITE}/map"
GATE = {"name": "Gate", "rule": "keep_out", "points": [[15.0, -12.5], [16.5, -12.5], [16.5, -11.0], [15.0, -11.0]]}


@pytest.fixture
def viewer(factory: Any) -> Client:
    return join_and_sign_in("viewer", SITE)


def test_a_viewer_takes_the_floor_along_in_each_form(viewer: Client) -> None:
    lif = viewer.get(f"{AT}.lif.json")
    assert (lif.status_code, lif["Content-Type"]) == (200, "application/json")
    assert lif["Content-Disposition"] == f'attachment; filename="{SITE}.lif.json"'
    assert {"dock1", "curingOven01"} <= {node["nodeId"] for node in lif.json()["layouts"][0]["nodes"]}
    building = viewer.get(f"{AT}.building.yaml")
    assert (building.status_code, building["Content-Type"]) == (200, "application/yaml")
    assert yaml.safe_load(building.content)["name"] == "Painting Factory"
    masks = viewer.get(f"{AT}.nav2.zip")
    assert (masks.status_code, masks["Content-Type"]) == (200, "application/zip")
    names = zipfile.ZipFile(io.BytesIO(masks.content)).namelist()
    assert sorted(names) == [
        "costmap_filters.yaml", "keepout_mask.pgm", "keepout_mask.yaml", "speed_mask.pgm", "speed_mask.yaml"
    ]  # fmt: skip


def test_a_zone_that_is_made_is_in_the_next_export(viewer: Client) -> None:
    before = viewer.get(f"{AT}.lif.json").json()["layouts"][0]
    assert post_json(join_and_sign_in("admin", SITE), f"/api/sites/{SITE}/zones", GATE).status_code == 201
    after = viewer.get(f"{AT}.lif.json").json()["layouts"][0]
    gone = {node["nodeId"] for node in before["nodes"]} - {node["nodeId"] for node in after["nodes"]}
    assert "dock1" in gone
    assert "layoutDescription" not in before
    assert after["layoutDescription"].startswith("Robots cannot come to:")


def test_a_site_without_a_map_says_so(factory: Any) -> None:
    registry.create_site(name="Bare", slug="bare")
    client = join_and_sign_in("viewer", "bare")
    for form in ("lif.json", "building.yaml", "nav2.zip"):
        answer = client.get(f"/api/sites/bare/map.{form}")
        assert (answer.status_code, answer.json()["code"]) == (404, "no_map")


def test_a_map_without_places_and_devices_is_exported_as_it_is(factory: Any) -> None:
    registry.create_site(name="Bare", slug="bare")
    registry.save_map(site="bare", grid=registry.get_map(site=SITE).grid)
    client = join_and_sign_in("viewer", "bare")
    layout = client.get("/api/sites/bare/map.lif.json").json()["layouts"][0]
    assert (layout["nodes"], layout["edges"], layout["stations"]) == ([], [], [])
    level = yaml.safe_load(client.get("/api/sites/bare/map.building.yaml").content)["levels"]["L1"]
    assert (level["lanes"], len(level["floors"])) == ([], 1)


def test_one_person_has_one_export_worked_out_at_a_time(viewer: Client, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(routes, "PATIENCE_S", 0.0)
    claim = registry.Claim(find_person("viewer").pk)
    assert routes.export_slots.take(claim)
    try:
        answer = viewer.get(f"{AT}.lif.json")
    finally:
        routes.export_slots.give_back(claim)
    assert (answer.status_code, json.loads(answer.content)["code"]) == (429, "too_many_exports")
    assert viewer.get(f"{AT}.lif.json").status_code == 200
