"""An engineer brings a device in: its key in the dialog, its description over MQTT, its approval on the page."""

from __future__ import annotations

import json

import paho.mqtt.client as mqtt
from playwright.sync_api import expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import SITE, tell, violations
from tests.kit.files import MIXER_TEXT

TEXT = MIXER_TEXT.replace("paintMixer03", "mixer-7")
LEGACY = "hall/old-mixer/mix"
ASKING = TEXT.replace("vipo/v1/dev/mixer-7/down/mixPaint", LEGACY)


def connect(setup: dict[str, str | int]) -> mqtt.Client:
    """Connect with what the dialog says."""
    name = str(setup["id"])
    client = mqtt.Client(mqtt.CallbackAPIVersion.VERSION2, name)
    client.username_pw_set(name, str(setup["password"]))
    client.will_set(f"vipo/v1/dev/{name}/up/presence", '{"s": "offline", "boot": 1}', 1, retain=True)
    client.connect(str(setup["host"]), int(setup["port"]))
    client.loop_start()
    return client


def introduce(client: mqtt.Client, name: str) -> None:
    """Describe the device, and say that it is there."""
    said = [
        ("desc", ASKING),
        ("presence", '{"s": "online", "boot": 1}'),
        ("state", '{"boot": 1, "seq": 1, "done": true}'),
    ]
    for topic, payload in said:
        say(client, name, topic, payload)


def say(client: mqtt.Client, name: str, topic: str, payload: str) -> None:
    client.publish(f"vipo/v1/dev/{name}/up/{topic}", payload, 1, retain=True).wait_for_publish(20)


def test_a_device_is_added_comes_in_and_is_approved(sign_in: SignIn) -> None:
    page = sign_in("admin", "/sites/painting-factory/devices")
    page.get_by_role("button", name="Add device").click()
    dialog = page.get_by_role("dialog", name="Add a device")
    expect(dialog.get_by_role("textbox", name="Id")).to_be_focused()
    page.keyboard.type("mixer 7")
    expect(dialog.get_by_role("button", name="Make its key")).to_be_disabled()
    dialog.get_by_role("textbox", name="Id").fill("mixer-7")
    page.keyboard.press("Enter")
    dialog.get_by_role("button", name="Copy").click()
    setup = json.loads(page.evaluate("navigator.clipboard.readText()"))
    assert (setup["id"], setup["site"]) == ("mixer-7", "painting-factory")
    expect(dialog.get_by_text("Waiting for mixer-7")).to_be_visible()
    assert violations(page) == []

    dialog.get_by_role("tab", name="Check a description").click()
    dialog.get_by_role("textbox", name="Description").fill(TEXT)
    dialog.get_by_role("button", name="Check", exact=True).click()
    expect(dialog.get_by_text("(mixer-7).")).to_be_visible()
    dialog.get_by_role("textbox", name="Description").fill(TEXT.replace(";", "", 1))
    dialog.get_by_role("button", name="Check", exact=True).click()
    expect(dialog.get_by_text("Line ", exact=False)).to_be_visible()
    assert violations(page) == []

    dialog.get_by_role("tab", name="One device").click()
    device = connect(setup)
    try:
        say(device, "mixer-7", "desc", TEXT.replace(";", "", 1))
        expect(dialog.get_by_text("Its description was refused", exact=False)).to_be_visible()
        expect(dialog.get_by_text("Waiting for mixer-7")).to_be_visible()
        assert violations(page) == []
        introduce(device, "mixer-7")
        dialog.get_by_role("button", name="Look at it").click()
        row = page.locator("tr[data-status]", has_text="mixer-7")
        expect(row).to_contain_text("Waiting for approval")
        tell(page, f"{SITE}/devices/mixer-7/approve")
        expect(row).to_contain_text("Idle")

        page.get_by_role("button", name=f"Confirm the topic {LEGACY}").click()
        assert violations(page) == []
        page.get_by_role("dialog").get_by_role("button", name="Confirm", exact=True).click()
        expect(page.get_by_role("button", name=f"Withdraw the topic {LEGACY}")).to_be_visible()
        expect(page.get_by_role("button", name="Try mixPaint")).to_be_visible()
        page.get_by_role("tab", name="Used in").click()
        expect(page.get_by_text("No program uses it yet.")).to_be_visible()
    finally:
        tell(page, f"{SITE}/devices/mixer-7/retire")
        device.disconnect()
        device.loop_stop()
