"""The map's page is seen from nearer, by buttons, wheel and dragging; what is pointed at or dragged stays right."""

from __future__ import annotations

import re
from collections.abc import Callable

import pytest
from playwright.sync_api import Locator, Page, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import SITE, address_of, ask, shoot, tell, violations
from tests.kit.waiting import wait_for

pytestmark = pytest.mark.browser
MAP = "/sites/painting-factory/map"
OVEN, IN_A_CORNER = "Curing Oven", "Item Inventory"


def box_of(page: Page, device: str = OVEN) -> tuple[float, float, float]:
    """Return the middle of a device on the screen and how wide it is, in pixels."""
    found = page.get_by_role("button", name=device, exact=True).bounding_box()
    assert found is not None
    return found["x"] + found["width"] / 2, found["y"] + found["height"] / 2, found["width"]


def test_one_comes_nearer_by_keyboard_by_wheel_and_by_dragging_and_sees_the_whole_again(sign_in: SignIn) -> None:
    page = sign_in("author", MAP)
    nearer = page.get_by_role("button", name="Nearer")
    whole = page.get_by_role("button", name="The whole map")
    expect(whole).to_be_disabled()
    x, y, width = box_of(page)
    page.mouse.move(x, y)
    page.mouse.wheel(0, -400)
    expect(whole).to_be_enabled()
    near_x, near_y, near_width = box_of(page)
    assert near_width > 2 * width
    assert (near_x, near_y) == pytest.approx((x, y), abs=12)

    page.mouse.move(x, y + 200)
    page.mouse.down()
    page.mouse.move(x + 120, y + 140, steps=4)
    page.mouse.up()
    moved_x, moved_y, _ = box_of(page)
    assert (moved_x - near_x, moved_y - near_y) == pytest.approx((120, -60), abs=3)
    shoot(page, "map-nearer", "light", "dark")
    assert violations(page) == []

    whole.focus()
    page.keyboard.press("Enter")
    expect(whole).to_be_disabled()
    assert box_of(page) == pytest.approx((x, y, width), abs=1)
    page.mouse.move(x, y)
    page.mouse.wheel(0, 400)  # there is nothing farther: the page may scroll
    assert box_of(page)[2] == pytest.approx(width, abs=1)
    nearer.focus()
    page.keyboard.press("Enter")
    assert box_of(page)[2] > 1.2 * width
    page.get_by_role("button", name="Farther").click()
    expect(whole).to_be_disabled()
    page.set_viewport_size({"width": 820, "height": 1180})
    shoot(page, "map-whole-820", "light", "dark")
    assert violations(page) == []


def test_a_length_is_the_same_from_nearer(sign_in: SignIn) -> None:
    page = sign_in("author", MAP)
    x, y, width = box_of(page)
    page.get_by_role("button", name="Measure").click()
    page.mouse.move(x, y)
    page.mouse.wheel(0, -300)
    floor = page.get_by_role("application", name="The map, to measure on")
    expect(floor).to_be_visible()
    page.mouse.click(x - 40, y - 90)
    page.mouse.click(x + 60, y - 90)
    length = page.get_by_role("region", name="Measure").locator("p").first
    metres = float(length.inner_text().split()[0])
    page.keyboard.press("Escape")
    page.keyboard.press("Escape")
    near = box_of(page)[2]
    oven_m = 2.7
    assert metres == pytest.approx(100 * oven_m / near, abs=0.35)
    assert near > 1.5 * width


def test_what_is_seen_from_nearer_is_moved_by_keys_and_what_has_the_focus_is_seen(sign_in: SignIn) -> None:
    page = sign_in("author", MAP)
    nearer = page.get_by_role("button", name="Nearer")
    nearer.focus()
    for _ in range(6):
        page.keyboard.press("Enter")
    floor = page.get_by_role("group", name="Map, moved by arrow keys")
    expect(floor).to_be_visible()
    assert violations(page) == []
    x, y, _ = box_of(page)
    floor.focus()
    page.keyboard.press("ArrowRight")
    page.keyboard.press("ArrowUp")
    moved_x, moved_y, _ = box_of(page)
    assert (moved_x - x, moved_y - y) == pytest.approx((-60, 60), abs=2)
    for name in (OVEN, IN_A_CORNER):
        page.get_by_role("button", name=name, exact=True).focus()
        pane = floor.bounding_box()
        box = page.get_by_role("button", name=name, exact=True).bounding_box()
        assert pane is not None
        assert box is not None
        assert pane["x"] <= box["x"] + box["width"] / 2 <= pane["x"] + pane["width"]
        assert pane["y"] <= box["y"] + box["height"] / 2 <= pane["y"] + pane["height"]
    page.get_by_role("button", name="The whole map").press("Enter")
    expect(floor).to_have_count(0)


def on_floor(floor: Locator, x: float, y: float) -> tuple[float, float]:
    """Return the point of the map (metres) that is under a point of the screen while a tool has the floor."""
    plan, box = ask(floor.page, f"{SITE}/map"), floor.bounding_box()
    assert box is not None
    right, up = (x - box["x"]) / box["width"], 1 - (y - box["y"]) / box["height"]
    width_m, height_m = (plan[size] * plan["resolution_m"] for size in ("width", "height"))
    return plan["origin"]["x"] + right * width_m, plan["origin"]["y"] + up * height_m


def said(text: Locator) -> tuple[float, float]:
    """Return the first point (metres) that a text names."""
    x, y = re.findall(r"-?\d+\.\d+", text.inner_text())[:2]
    return float(x), float(y)


def view_of(page: Page) -> str:
    """Return how the map that is seen from nearer is moved and scaled."""
    return str(page.locator("svg[data-nearer] > g").get_attribute("transform"))


def test_a_tool_that_is_taken_from_nearer_leaves_the_view_and_puts_things_under_the_pointer(sign_in: SignIn) -> None:
    page = sign_in("admin", MAP)
    x, y, _ = box_of(page, IN_A_CORNER)
    page.mouse.move(x, y)
    page.mouse.wheel(0, -700)
    expect(page.get_by_role("button", name="The whole map")).to_be_enabled()
    page.get_by_role("button", name="Nearer").focus()
    seen = view_of(page)
    page.get_by_role("button", name="Measure").click()
    floor = page.get_by_role("application", name="The map, to measure on")
    expect(floor).to_be_focused()
    assert view_of(page) == seen
    page.get_by_role("button", name="Nearer").focus()
    under = on_floor(floor, x + 60, y + 150)
    page.mouse.click(x + 60, y + 150)
    heard = page.get_by_role("region", name="Measure").get_by_role("status")
    expect(heard).to_contain_text("One end is at")
    assert said(heard) == pytest.approx(under, abs=0.1)
    assert view_of(page) == seen

    page.get_by_role("button", name="Edit places").click()
    page.get_by_role("button", name="Add a place").click()
    floor, where = page.get_by_role("button", name="Put the new place"), page.get_by_text("Click elsewhere on the map")
    expect(floor).to_be_focused()
    assert view_of(page) == seen
    for spot in ((x + 60, y + 150), (x + 160, y + 120)):  # the second time the form has the focus
        under = on_floor(floor, *spot)
        page.mouse.click(*spot)
        wait_for("the place under the pointer", lambda at=under: said(where) == pytest.approx(at, abs=0.03))
        assert view_of(page) == seen
    page.keyboard.press("Escape")

    page.get_by_role("button", name="Edit zones").click()
    page.get_by_role("button", name="Add a zone").click()
    expect(page.get_by_role("button", name="Draw the new zone")).to_be_focused()
    assert view_of(page) == seen


def remove(page: Page, path: str) -> None:
    headers = {"X-CSRFToken": ask(page, "/api/me")["csrf"], "Referer": page.url}
    assert page.request.delete(address_of(page, f"{SITE}/{path}"), headers=headers).status == 204


def whole_box(thing: Locator) -> tuple[float, float, float, float]:
    box = thing.bounding_box()
    assert box is not None
    return box["x"], box["y"], box["width"], box["height"]


def middle_outside(page: Page, thing: Locator) -> tuple[float, float]:
    """Come nearer and move the map until a thing's middle is left of the pane; return a spot of it that is seen."""
    x, y, width, height = whole_box(thing)
    page.mouse.move(x + width / 2, y + height / 2)
    page.mouse.wheel(0, -420)
    pane = page.locator("svg[data-nearer]")
    expect(pane).to_be_visible()
    left, top, wide, _ = whole_box(pane)
    x, y, width, height = whole_box(thing)
    shows = min(120.0, width / 3)
    start = left + wide - 100, top + 300
    page.mouse.move(*start)
    page.mouse.down(button="middle")
    page.mouse.move(start[0] + left + shows - (x + width), start[1], steps=4)
    page.mouse.up(button="middle")
    x, y, width, height = whole_box(thing)
    assert x + width / 2 < left
    return x + width - shows / 2, y + height / 2


def test_what_is_pressed_from_nearer_leaves_the_view_and_a_press_that_trembles_moves_nothing(sign_in: SignIn) -> None:
    page = sign_in("admin", MAP)
    corners = [[2.0, -10.0], [8.0, -10.0], [8.0, -6.0], [2.0, -6.0]]
    tell(page, f"{SITE}/zones", {"name": "Aisle", "rule": "preferred", "points": corners})
    changes: list[str] = []
    page.on("request", lambda request: changes.append(request.url) if request.method == "PATCH" else None)
    for mode, thing in (
        ("Move machines", page.get_by_role("button", name=re.compile(f"^{OVEN} at"))),
        ("Edit zones", page.get_by_role("button", name="Aisle").first),
    ):
        page.get_by_role("button", name=mode).click()
        x, y = middle_outside(page, thing)
        seen, before = view_of(page), whole_box(thing)
        page.mouse.move(x, y)
        page.mouse.down()
        expect(thing).to_be_focused()
        page.mouse.move(x + 1, y)
        page.mouse.up()
        assert view_of(page) == seen
        assert whole_box(thing) == before
        page.get_by_role("button", name="The whole map").press("Enter")
        expect(page.locator("svg[data-nearer]")).to_have_count(0)
    assert changes == []

    corner = page.get_by_role("button", name="Corner 1 at")
    x, y, width, height = whole_box(corner)
    page.mouse.move(x + 4, y + 4)  # beside its middle, where a finger may be
    page.mouse.down()
    page.mouse.move(x + 6, y + 5)
    page.mouse.up()
    assert whole_box(corner) == (x, y, width, height)
    page.mouse.down()
    page.mouse.move(x + 34, y - 16, steps=4)
    assert whole_box(corner) == pytest.approx((x + 28, y - 21, width, height), abs=1)
    assert changes == []
    page.mouse.up()
    wait_for("the corner where it was put", lambda: zone_points(page)[1:] == corners[1:] != zone_points(page))
    remove(page, "zones/aisle")


def zone_points(page: Page) -> list[list[float]]:
    zone = next(zone for zone in ask(page, f"{SITE}/map")["zones"] if zone["id"] == "aisle")
    return [list(point) for point in zone["points"]]


def shape_of(thing: Locator) -> str:
    """Return where something is on the map, wherever the page is scrolled to."""
    return str(thing.evaluate("element => element.getAttribute('transform') ?? element.getAttribute('d')"))


Touch = Callable[..., None]


def finger_on(page: Page) -> Touch:
    """Let the page be touched; return what tells it of a touch: what happens, and where the finger is."""
    cdp = page.context.new_cdp_session(page)
    cdp.send("Emulation.setTouchEmulationEnabled", {"enabled": True, "maxTouchPoints": 5})

    def touch(kind: str, *spots: tuple[float, float]) -> None:
        cdp.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [{"x": x, "y": y} for x, y in spots]})

    return touch


def drag(touch: Touch, thing: Locator, up: int) -> None:
    """Put a finger on a thing and move it up by so many pixels, without letting go."""
    before, (left, top, wide, high) = shape_of(thing), whole_box(thing)
    x, y = left + wide / 2, top + high / 2
    touch("touchStart", (x, y))
    for part in range(1, 9):
        touch("touchMove", (x, y - part * up / 8))
    wait_for("what is dragged", lambda: shape_of(thing) != before)


def test_a_finger_drags_what_is_on_the_whole_map_while_it_is_changed(sign_in: SignIn) -> None:
    page = sign_in("admin", MAP, width=820, height=1180)
    tell(page, f"{SITE}/places", {"name": "Stool", "kind": "point", "x": 10.0, "y": -8.0})
    corners = [[9.0, -8.9], [11.0, -8.9], [11.0, -7.1], [9.0, -7.1]]
    tell(page, f"{SITE}/zones", {"name": "Ramp", "rule": "preferred", "points": corners})
    lying = tell(page, f"{SITE}/obstacles", {"x": 12.0, "y": -8.3, "size_m": 0.5})
    touch = finger_on(page)
    expect(page.locator("svg").filter(has=page.get_by_role("button", name=OVEN))).to_have_css("touch-action", "auto")
    for mode, thing in (
        ("Edit places", page.get_by_role("button", name="Stool at")),
        ("Edit zones", page.get_by_role("button", name="Ramp").first),
        ("Move machines", page.get_by_role("button", name=re.compile(f"^{OVEN} at"))),
        ("Put obstacles", page.get_by_role("button", name="Obstacle, 50").first),
    ):
        page.get_by_role("button", name=mode).click()
        before = shape_of(thing)
        drag(touch, thing, 64)
        touch("touchCancel")
        wait_for(f"what is given up: {mode}", lambda thing=thing, shape=before: shape_of(thing) == shape)
    for path in ("places/stool", "zones/ramp", f"obstacles/{lying['id']}"):
        remove(page, path)


def test_what_a_finger_has_dragged_and_let_go_is_kept(sign_in: SignIn) -> None:
    page = sign_in("admin", MAP, width=820, height=1180)
    tell(page, f"{SITE}/places", {"name": "Bench", "kind": "point", "x": 8.0, "y": -8.0})
    corners = [[9.0, -8.9], [11.0, -8.9], [11.0, -7.1], [9.0, -7.1]]
    tell(page, f"{SITE}/zones", {"name": "Lane", "rule": "preferred", "points": corners})
    lying = tell(page, f"{SITE}/obstacles", {"x": 12.0, "y": -8.3, "size_m": 0.5})
    touch = finger_on(page)

    def kept() -> dict[str, tuple[float, float]]:
        plan = ask(page, f"{SITE}/map")
        found = {each["name"]: (each["x"], each["y"]) for each in plan["places"] if each["id"] == "bench"}
        found |= {each["name"]: tuple(each["points"][0]) for each in plan["zones"] if each["id"] == "lane"}
        return found | {str(each["id"]): (each["x"], each["y"]) for each in plan["obstacles"]}

    for mode, thing, name in (
        ("Edit places", page.get_by_role("button", name="Bench at"), "Bench"),
        ("Edit zones", page.get_by_role("button", name="Lane").first, "Lane"),
        ("Put obstacles", page.get_by_role("button", name="Obstacle, 50").first, str(lying["id"])),
    ):
        page.get_by_role("button", name=mode).click()
        before, lay = kept(), shape_of(thing)
        drag(touch, thing, 32)
        assert kept() == before, "nothing is sent under the finger"
        touch("touchEnd")
        wait_for(f"what was let go: {mode}", lambda name=name, before=before: kept()[name] != before[name])
        now = kept()
        assert {**now, name: before[name]} == before, "nothing else has moved"
        assert now[name][0] == pytest.approx(before[name][0], abs=0.06)
        assert 0.3 < now[name][1] - before[name][1] < 3.0, "upwards, as the finger"
        page.wait_for_timeout(300)
        assert shape_of(thing) != lay, "it stays where it was put"
    for path in ("places/bench", "zones/lane", f"obstacles/{lying['id']}"):
        remove(page, path)
