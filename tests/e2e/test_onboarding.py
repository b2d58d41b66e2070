"""An engineer brings a device in: its key in the dialog, its description over MQTT, its approval on the page."""

from __future__ import annotations

import json
from contextlib import ExitStack

from playwright.sync_api import expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import SITE, tell, violations
from tests.kit.files import MIXER_TEXT
from tests.kit.mqtt import PlainDevice
from tests.kit.waiting import wait_for

TEXT = MIXER_TEXT.replace("paintMixer03", "mixer-7")
LEGACY = "hall/old-mixer/mix"
ASKING = TEXT.replace("vipo/v1/dev/mixer-7/down/mixPaint", LEGACY)


def test_a_device_is_added_comes_in_and_is_approved(sign_in: SignIn) -> None:
    page = sign_in("admin", "/sites/painting-factory/devices")
    page.get_by_role("button", name="Add device").click()
    dialog = page.get_by_role("dialog", name="Add a device")
    expect(dialog.get_by_role("textbox", name="Id")).to_be_focused()
    page.keyboard.type("mixer 7")
    expect(dialog.get_by_role("button", name="Make its key")).to_be_disabled()
    dialog.get_by_role("textbox", name="Id").fill("mixer-7")
    page.keyboard.press("Enter")
    page.evaluate("navigator.clipboard.writeText('')")
    dialog.get_by_role("button", name="Copy").click()
    setup = json.loads(wait_for("what is copied", lambda: page.evaluate("navigator.clipboard.readText()")))
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
    broker = f"mqtt://{setup['host']}:{setup['port']}"
    told = {"id": setup["id"], "credential": setup["password"], "broker": broker}
    with PlainDevice(told) as device, ExitStack() as afterwards:
        afterwards.callback(tell, page, f"{SITE}/devices/mixer-7/retire")
        device.say("desc", TEXT.replace(";", "", 1))
        expect(dialog.get_by_text("Its description was refused", exact=False)).to_be_visible()
        expect(dialog.get_by_text("Waiting for mixer-7")).to_be_visible()
        assert violations(page) == []
        device.introduce(ASKING)
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
