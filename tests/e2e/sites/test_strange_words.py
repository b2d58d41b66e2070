"""Devices whose ids, classes and names are words that every object of a browser has are devices like all others."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from playwright.sync_api import Page, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import (
    SITE,
    address_of,
    editor,
    machine,
    make_program,
    open_script,
    saved,
    tell,
    the_map,
    violations,
)
from tests.kit.mqtt import PlainDevice
from vipo_device.descriptions.reader import write_description
from vipo_device.protocol.description import Description, MethodSpec, ParameterSpec, Pose, PropertySpec, Size

PRESS = Description(
    "constructor",
    "Strange Press",
    "machine",
    "toString",
    Pose(6.0, -7.0),
    Size(0.8, 0.8, 1.0),
    properties=(PropertySpec("valueOf", "number", "DEG_C"), PropertySpec("isPrototypeOf", "text")),
    methods=(
        MethodSpec(
            "hasOwnProperty",
            "vipo/v1/dev/constructor/down/hasOwnProperty",
            parameters=(ParameterSpec("toLocaleString", "number"),),
        ),
    ),
)
CARRIER = Description(
    "__proto__", "Strange Carrier", "robot", "__proto__", Pose(7.5, -7.0), Size(0.3, 0.3, 0.3), radius_m=0.15,
    speed_m_s=0.2, properties=(PropertySpec("constructor", "number"),),
)  # fmt: skip
SAYS: dict[str, dict[str, Any]] = {
    PRESS.id: {"props": {"valueOf": 21.5, "isPrototypeOf": "constructor"}},
    CARRIER.id: {"props": {"constructor": 3}, "loc": [7.5, -7.0, 0, 0]},
}


@contextmanager
def taking_part(page: Page, description: Description) -> Iterator[None]:
    """Bring a device in as an engineer does: its key, its description, its approval; take it out afterwards."""
    with PlainDevice(tell(page, f"{SITE}/newcomers", {"id": description.id})) as device:
        try:
            device.introduce(write_description(description), **SAYS[device.id])
            row = page.locator("tr[data-status]", has_text=description.name)
            expect(row).to_contain_text("Waiting for approval")
            tell(page, f"{SITE}/devices/{device.id}/approve")
            expect(row).not_to_contain_text("Waiting for approval")
            yield
        finally:
            tell(page, f"{SITE}/devices/{device.id}/retire")


def test_they_are_listed_shown_on_the_map_and_drawn_with(sign_in: SignIn) -> None:
    page = sign_in("admin", "/sites/painting-factory/devices")
    with taking_part(page, PRESS), taking_part(page, CARRIER):
        page.locator("tr[data-status]", has_text=PRESS.name).click()
        expect(page.get_by_role("button", name="Try hasOwnProperty")).to_be_visible()
        expect(page.get_by_text("21.5").first).to_be_visible()
        page.goto(address_of(page, "/sites/painting-factory/map"))
        for description in (PRESS, CARRIER):
            expect(page.get_by_text(description.name).first).to_be_visible()
        make_program(page, "Strange words")
        expect(the_map(page)).to_be_visible()
        page.keyboard.press("o")
        machine(page, PRESS.name).click()
        page.get_by_label("toLocaleString").first.fill("3")
        expect(page.get_by_text("Nothing to fix")).to_be_visible()
        open_script(page)
        expect(editor(page)).to_contain_text(".has_own_property(")
        assert violations(page) == []
        saved(page)
        page.get_by_role("button", name="Simulate", exact=True).click()
        expect(page.get_by_role("region", name="Result")).to_contain_text("Finishes without errors")
