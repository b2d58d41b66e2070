"""A robot maps a floor that nobody has given it: its map is seen growing, and an admin makes it the site's."""

from __future__ import annotations

import re
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any
from urllib.parse import urlsplit

import pytest
from playwright.sync_api import expect

from simulation.mapping.survey import SurveyPlan
from simulation.scout import Scout, ScoutPlan
from tests.e2e.conftest import SignIn
from tests.e2e.screens import ask, tell, violations
from tests.kit.floors.halls import bare_hall
from vipo_device.protocol.description import Pose
from vipo_device.protocol.mqtt_client import MqttClient, Will

pytestmark = pytest.mark.browser

SITE, ROBOT = "dark-hall", "dark-hall.scout"


@contextmanager
def scout_at_work(setup: dict[str, Any]) -> Iterator[None]:
    """Let a simulated robot come in, as its dialog says."""
    broker = urlsplit(setup["broker"])

    def connect(device: str, will: Will) -> MqttClient:
        return MqttClient(
            host=broker.hostname or "",
            port=broker.port or 1883,
            username=device,
            password=str(setup["credential"]),
            client_id=device,
            will=will,
        )

    survey = SurveyPlan(bare_hall(9.0, 4.0), 1, start=Pose(1.0, 1.0))
    stopping = threading.Event()
    scout = Scout(ScoutPlan(ROBOT, "Scout", SITE, survey, speed=10), connect)
    thread = threading.Thread(target=scout.run, args=(stopping,))
    thread.start()
    try:
        yield
    finally:
        stopping.set()
        thread.join(10)


def test_a_robot_maps_an_empty_site_and_its_map_becomes_the_sites(sign_in: SignIn) -> None:
    page = sign_in("admin", "/sites/new")
    page.get_by_label("Name of the site").fill("Dark hall")
    page.get_by_role("button", name="Make it without a map for now").click()
    expect(page.get_by_role("region", name="Set up Dark hall")).to_be_visible()
    setup = tell(page, f"/api/sites/{SITE}/newcomers", {"id": ROBOT})
    origin = page.url.split("/sites/")[0]
    with scout_at_work(setup):
        page.goto(f"{origin}/sites/{SITE}/devices")
        page.get_by_role("button", name="Approve").click()
        expect(page.locator("tr[data-status]", has_text="Scout")).to_contain_text("Idle")
        page.goto(f"{origin}/sites/{SITE}/map")
        page.get_by_role("link", name="Map the floor with Scout").click()
        card = page.get_by_role("region", name="Its map")
        expect(card.get_by_text("This robot has sent no map yet.")).to_be_visible()
        page.get_by_role("button", name="Try explore").click()
        dialog = page.get_by_role("dialog", name="Scout: explore")
        dialog.get_by_role("button", name="Start").click()
        expect(dialog.get_by_text("Under way")).to_be_visible()
        expect(page.get_by_text("Growing")).to_be_visible()
        first = ask(page, f"/api/sites/{SITE}/devices/{ROBOT}/map")
        expect(dialog.get_by_text("Done")).to_be_visible(timeout=40_000)
        page.keyboard.press("Escape")
        expect(dialog).to_be_hidden()
        last = ask(page, f"/api/sites/{SITE}/devices/{ROBOT}/map")
        assert last["version"] > first["version"]
        assert area(last) > area(first) > 0
        assert violations(page) == []
        card.get_by_role("button", name="Use as this site's map").click()
        page.get_by_role("dialog").get_by_role("button", name=re.compile("^Use this map|^Use it all the same")).click()
        expect(page.get_by_text("is the site's map now: version 1")).to_be_visible()
    page.goto(f"{origin}/sites/{SITE}/map")
    expect(page.get_by_text("Version 1, from Scout")).to_be_visible()
    versions = ask(page, f"/api/sites/{SITE}/map/versions")
    assert [(each["version"], each["source"]) for each in versions] == [(1, f"robot:{ROBOT}")]


def area(facts: dict[str, Any]) -> float:
    """Square metres that are known."""
    return float(facts["known"] * facts["width"] * facts["height"] * facts["resolution_m"] ** 2)
