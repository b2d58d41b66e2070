"""The whole journey: two people, two browsers, one factory."""

from __future__ import annotations

import re
from functools import partial

import pytest
from playwright.sync_api import Browser, Page, Route, expect

from tests.e2e.conftest import SignIn, listen
from tests.e2e.screens import (
    SITE,
    TASK,
    ask,
    chip,
    click_floor,
    device,
    draw_task,
    machine,
    make_program,
    make_program_by_form,
    open_program,
    problems,
    reading,
    run_state,
    same_steps,
    script_lines,
    start_run,
    steps_in_list,
    the_map,
)
from tests.kit.demo import Demo
from tests.kit.waiting import wait_for

pytestmark = pytest.mark.browser


@pytest.fixture
def sign_in(sign_in: SignIn) -> SignIn:
    """Everybody here sees what moves move."""
    return partial(sign_in, motion=True)


PAPERS_LINES = [
    "class Task(object):",
    "    def new_task(self):",
    "        self.robot.move(self.item_inventory.location)",
    '        self.robot.pick({"value": 1, "object": "box"})',
    "        self.robot.move(self.painting_machine.location)",
    '        self.robot.drop({"value": 1, "object": "box"})',
    "",
    "    def run(self, ctx):",
    '        self.robot = ctx.any("pick", "drop")',
    '        self.item_inventory = ctx.get("itemInventory01")',
    '        self.painting_machine = ctx.get("paintMachine01")',
    "        self.new_task()",
]


def test_a_wrong_password_is_refused_in_a_sentence_and_the_right_one_opens_home(
    demo: Demo, chromium: Browser, faults: list[str]
) -> None:
    context = chromium.new_context(locale="en-GB")
    listen(context, faults)
    page = context.new_page()
    page.goto(f"{demo.url}/sign-in")
    account = demo.account("author")
    page.get_by_label("Email address").fill(account.email)
    password = page.get_by_label("Password", exact=True)
    password.fill("not the password")
    password.press("Tab")
    expect(page.get_by_role("button", name="Show the password")).to_be_focused()
    page.keyboard.press("Space")
    expect(password).to_have_attribute("type", "text")
    page.get_by_role("button", name="Sign in", exact=True).click()
    expect(page.get_by_role("alert")).to_have_text(re.compile(r"^[A-Z].*(password|e-?mail).*\.$", re.IGNORECASE))
    faults.clear()
    password.fill(account.password)
    page.get_by_role("button", name="Sign in", exact=True).click()
    expect(page.get_by_role("heading", name="Home")).to_be_visible()
    expect(page.get_by_role("heading", name="Painting Factory", exact=True)).to_be_visible()
    page.goto(f"{demo.url}/sites/painting-factory/programs")  # Home shows only those that were edited last
    expect(page.get_by_role("link", name="Paint order", exact=True)).to_be_visible()
    expect(page.get_by_role("link", name="First task", exact=True)).to_be_visible()
    page.goto(f"{demo.url}/runs/0273d92d-9312")  # a link that was cut off on its way
    expect(page.get_by_role("heading", name="There is no page at this address")).to_be_visible()
    context.close()


def test_the_new_device_takes_part_once_an_admin_has_approved_it(sign_in: SignIn) -> None:
    admin, author = sign_in("admin", "/"), sign_in("author", "/sites/painting-factory/devices/paintMixer03")
    expect(author.get_by_text("An admin of this site can approve it.")).to_be_visible()
    admin.get_by_role("navigation").get_by_role("link", name=re.compile("^Devices")).first.click()
    row = admin.get_by_role("row", name=re.compile("^paintMixer03"))
    expect(row).to_contain_text("Waiting for approval")
    row.get_by_role("link").click()
    admin.get_by_role("button", name="Approve", exact=True).click()
    key = admin.get_by_role("dialog", name="Key of paintMixer03")
    expect(key.get_by_label("Key", exact=True)).to_have_value(re.compile(r"^[\w-]{32}$"))
    expect(key).to_contain_text("The device has taken it by itself.")
    key.get_by_role("button", name="I have it").click()
    expect(admin.get_by_text("paintMixer03 takes part from now on.")).to_be_visible()
    expect(row).to_contain_text("Idle")
    expect(admin.get_by_role("button", name="Approve", exact=True)).to_have_count(0)
    expect(author.get_by_role("row", name=re.compile("^paintMixer03"))).to_contain_text("Idle")
    assert device(admin, "paintMixer03")["lifecycle"] == "approved"


def test_every_device_of_the_factory_is_online(sign_in: SignIn) -> None:
    page = sign_in("author", "/sites/painting-factory/devices")
    expect(page.locator("tbody tr")).to_have_count(11, timeout=180_000)
    expect(page.get_by_role("row", name=re.compile("Offline"))).to_have_count(0)
    found = {each["id"]: each for each in ask(page, f"{SITE}/devices")}
    assert len(found) == 11
    assert [name for name, each in found.items() if each["status"] == "offline"] == []


def test_two_people_draw_one_program(sign_in: SignIn) -> None:
    author, admin = sign_in("author"), sign_in("admin")
    for page in (author, admin):
        open_program(page, "First task")
        expect(page).to_have_title("First task · VIPO")
    draw_task(author)
    shared = chip(admin, f"1, {TASK}")
    expect(shared).to_be_visible()
    expect(chip(author, f"1, {TASK}")).to_contain_text("Move added for you")
    expect(shared.get_by_text("OB", exact=True)).to_be_visible()
    see_the_pointer(author, admin)
    edit_both_at_once(author, admin)
    undo_ones_own(author, admin)


def see_the_pointer(author: Page, admin: Page) -> None:
    box = the_map(author).bounding_box()
    assert box is not None
    author.mouse.move(box["x"] + 500, box["y"] + 300)
    author.mouse.move(box["x"] + 520, box["y"] + 320)
    expect(admin.get_by_text("Otto Brandt", exact=True)).to_be_visible()


def edit_both_at_once(author: Page, admin: Page) -> None:
    author.get_by_role("toolbar", name="Tools").get_by_role("button", name="Wait").click()
    admin.get_by_role("toolbar", name="Tools").get_by_role("button", name="Operate").click()
    click_floor(author, 0.42, 0.26)
    machine(admin, "Painting Machine").click()
    author.get_by_label("Time", exact=True).fill("5")
    admin.get_by_label("time", exact=True).fill("2")
    for page in (author, admin):
        expect(
            page.get_by_role("application").get_by_role("group", name=re.compile(r"^\d, (Wait|Operate)"))
        ).to_have_count(2)
        expect(page.get_by_role("banner").get_by_role("button", name=re.compile("error"))).to_have_count(0)
    wanted = ["Operate, Paint · 2 min at Painting Machine", TASK, "Wait, wait 5 s"]
    wait_for("all three", lambda: sorted(step[3:] for step in steps_in_list(author)) == wanted)
    same_steps(author, admin)


def undo_ones_own(author: Page, admin: Page) -> None:
    """The author's undo takes back what the author did, though the admin's edit came later."""
    undo = author.get_by_role("group", name="Undo and redo").get_by_role("button", name="Undo")
    while undo.is_enabled():
        undo.click()
    for page in (author, admin):
        expect(page.get_by_role("treeitem")).to_have_count(1)
        expect(
            page.get_by_role("treeitem", name=re.compile(r"Operate, Paint · 2\smin at Painting Machine"))
        ).to_be_visible()
    redo = author.get_by_role("group", name="Undo and redo").get_by_role("button", name="Redo")
    while redo.is_enabled():
        redo.click()
    for page in (author, admin):
        expect(page.get_by_role("treeitem")).to_have_count(3)


def test_a_novice_needs_one_key_and_three_clicks(sign_in: SignIn) -> None:
    page = sign_in("author")
    make_program_by_form(page, "Four presses")
    page.evaluate(
        "presses = 0; for (const kind of ['pointerdown', 'keydown']) addEventListener(kind, () => presses++, true)"
    )
    draw_task(page)
    expect(chip(page, f"1, {TASK}")).to_be_visible()
    expect(page.get_by_text("Nothing to fix")).to_be_visible()
    assert page.evaluate("presses") == 4


def test_the_script_has_the_papers_lines_and_leads_to_its_steps(sign_in: SignIn) -> None:
    page = sign_in("author")
    make_program(page, "Script and drawing")
    draw_task(page)
    expect(page.get_by_text("self.robot.drop").first).to_be_visible()
    lines = script_lines(page)
    assert lines[: len(PAPERS_LINES)] == PAPERS_LINES
    draw_task(page, "Painting Machine", "Curing Oven")
    second = chip(page, "2, Pick-and-Drop, 1 \u00d7 box from Painting Machine to Curing Oven")
    expect(second).to_be_visible()
    expect(page.get_by_role("complementary", name="Selected step")).to_contain_text("Step 2")
    page.get_by_text('self.robot.pick({"value": 1, "object": "box"})').first.click()
    expect(page.get_by_role("complementary", name="Selected step")).to_contain_text("Step 1")
    second.click()
    expect(page.get_by_role("complementary", name="Selected step")).to_contain_text("Step 2")
    expect(page.locator(".vipo-line-selected").first).to_contain_text("self.robot.pick")
    assert script_lines(page).index("        self.robot.move(self.curing_oven.location)") == 7


def test_a_missing_value_is_marked_everywhere_and_its_button_mends_it(sign_in: SignIn) -> None:
    page = sign_in("author")
    make_program(page, "Something is missing")
    draw_task(page, load="Other")
    marked = chip(page, "1, Pick-and-Drop, ? \u00d7 box")
    expect(marked).to_be_visible()
    expect(marked).to_have_attribute("aria-label", re.compile(", 1 error$"))
    quantity = page.get_by_role("combobox", name="Quantity")
    expect(quantity).to_have_attribute("aria-invalid", "true")
    row = problems(page).filter(has_text="carry")
    expect(row).to_have_count(1)
    expect(page.get_by_role("banner").get_by_role("button", name="Run", exact=True)).to_be_disabled()
    row.get_by_role("button", name=re.compile("1$")).click()
    expect(chip(page, f"1, {TASK}")).to_be_visible()
    expect(quantity).to_have_value("1")
    expect(page.get_by_text("Nothing to fix")).to_be_visible()
    expect(page.get_by_role("banner").get_by_role("button", name="Run", exact=True)).to_be_enabled()


def test_a_rehearsal_is_shown_on_the_map_and_in_3d_at_the_same_moment(sign_in: SignIn) -> None:
    page = sign_in("author")
    make_program(page, "To be rehearsed")
    draw_task(page)
    expect(page.get_by_text("Nothing to fix")).to_be_visible()
    page.get_by_role("button", name="Simulate", exact=True).click()
    expect(page.get_by_role("progressbar")).to_be_visible()
    expect(page.get_by_role("region", name="Result")).to_contain_text("Finishes without errors", timeout=180_000)
    scene = page.get_by_role("region", name="3D view")
    expect(scene.locator("canvas")).to_be_visible()
    expect(scene.get_by_text("Curing Oven")).to_be_visible()
    moment = page.get_by_role("slider", name="Moment of the recording")
    picture = scene.get_by_role("img")
    moment.fill(str(float(moment.get_attribute("max") or 0) - 20))
    expect(picture).to_have_accessible_name(re.compile("carries 1 \u00d7 box"))
    step = chip(page, "1, Pick-and-Drop")
    expect(step.locator("[data-state]")).to_have_attribute("data-state", "running")
    page.get_by_role("button", name="To the end").click()
    expect(step.locator("[data-state]")).to_have_attribute("data-state", "done")
    page.get_by_role("button", name="Back to the start").click()
    expect(moment).to_have_value("0")
    page.get_by_role("button", name="Play", exact=True).click()
    expect(moment).not_to_have_value("0")
    expect(page.get_by_role("button", name="Pause", exact=True)).to_be_visible()


def test_a_run_carries_the_box_to_the_painting_machine(sign_in: SignIn) -> None:
    page = sign_in("author")
    make_program(page, "To be run")
    draw_task(page)
    expect(page.get_by_text("Nothing to fix")).to_be_visible()
    stock = reading(page, "itemInventory01", "stock")
    start_run(page)
    line = page.get_by_role("region", name="Steps", exact=True).get_by_role("button")
    expect(line).to_have_accessible_name(re.compile("^Running 1"))
    lit = chip(page, "1, Pick-and-Drop").locator("[data-state]")
    expect(lit).to_have_attribute("data-state", "running")
    expect(run_state(page)).to_contain_text("Finished", timeout=180_000)
    expect(lit).to_have_attribute("data-state", "done")
    expect(line).to_have_accessible_name(re.compile("^Done 1"))
    page.get_by_role("tab", name="Logs").click()
    log = page.get_by_role("tabpanel", name="Logs").get_by_role("listitem")
    expect(log.filter(has_text="pick(Item Inventory, box, 1)")).to_have_count(1)
    expect(log.filter(has_text=re.compile("TurtleBot . is done: pick"))).to_have_count(1)
    expect(log.filter(has_text="drop(Painting Machine, box, 1)")).to_have_count(1)
    expect(log.filter(has_text=re.compile("TurtleBot . is done: drop"))).to_have_count(1)
    assert reading(page, "itemInventory01", "stock") == stock - 1
    robots = [device(page, f"robot0{number}") for number in (1, 2, 3)]
    assert [robot["carrying"] for robot in robots] == [{}, {}, {}]
    assert any(abs(robot["location"]["x"] - 20.9) < 1 and robot["location"]["y"] > -6 for robot in robots)


def test_a_run_pauses_resumes_is_stopped_for_everybody_and_cancelled(sign_in: SignIn) -> None:
    author, admin = sign_in("author"), sign_in("admin", "/")
    make_program(author, "To be held")
    draw_task(author)
    author.get_by_role("toolbar", name="Tools").get_by_role("button", name="Wait").click()
    click_floor(author, 0.42, 0.26)
    author.get_by_label("Time", exact=True).fill("3600")  # it is under way however long the presses take
    expect(chip(author, "2, Wait")).to_be_visible()
    expect(author.get_by_text("Nothing to fix")).to_be_visible()
    start_run(author)
    expect(run_state(author)).to_contain_text("Running")
    author.get_by_role("button", name="Pause", exact=True).click()
    expect(run_state(author)).to_contain_text("Paused")
    author.get_by_role("button", name="Resume", exact=True).click()
    expect(run_state(author)).to_contain_text("Running")
    admin.get_by_role("button", name="Stop all").click()
    for page in (author, admin):
        dialog = page.get_by_role("dialog", name="Painting Factory is stopped")
        expect(dialog).to_contain_text(re.compile("Ada.* pressed Stop all"))
        expect(page.get_by_role("button", name="Stopped")).to_be_attached()
    expect(run_state(author)).to_contain_text("Paused")
    hold(admin, "Hold for 2 seconds to reset")
    for page in (author, admin):
        expect(page.get_by_role("dialog", name="Painting Factory is stopped")).to_have_count(0)
        expect(page.get_by_role("button", name="Stop all")).to_be_visible()
    expect(run_state(author)).to_contain_text("Paused")
    author.get_by_role("button", name="Cancel run").click()
    author.get_by_role("dialog").get_by_role("button", name="Cancel run").click()
    expect(run_state(author)).to_contain_text("Cancelled")


def hold(page: Page, name: str) -> None:
    """Hold a button for a moment, which does nothing, and then until it has acted."""
    button = page.get_by_role("button", name=name)
    button.click(delay=200)
    expect(button).to_be_visible()
    button.hover()
    page.mouse.down()
    expect(button).to_have_count(0, timeout=30_000)
    page.mouse.up()


def test_a_function_is_made_saved_found_by_another_person_and_used(sign_in: SignIn) -> None:
    author, admin = sign_in("author"), sign_in("admin")
    make_program(author, "Where a function comes from")
    draw_task(author)
    draw_task(author, "Painting Machine", "Curing Oven")
    author.keyboard.press("Control+a")
    expect(author.get_by_text("2 steps selected")).to_be_visible()
    author.keyboard.press("Control+g")
    author.get_by_label("Name for a function of 2 steps").fill("bringAndCure")
    author.get_by_role("button", name="Make the function").click()
    expect(chip(author, "1, Function, bringAndCure")).to_be_visible()
    expect(author.get_by_text("Nothing to fix")).to_be_visible()
    author.get_by_role("button", name="Save to the library").click()
    author.get_by_label("What it does").fill("Brings a box to paint and on to the oven")
    author.get_by_role("dialog").get_by_label("Who sees it").select_option("Everybody at the site")
    author.get_by_role("dialog").get_by_role("button", name="Save", exact=True).click()
    expect(author.get_by_text("bringAndCure is in the library as version 1")).to_be_visible()
    make_program(admin, "Where a function is used")
    admin.get_by_role("button", name="or import a function").click()
    held: list[Route] = []
    admin.route(re.compile(r"/library\?.*\bq=oven"), lambda route: held.append(route))
    with admin.expect_request(re.compile(r"/library\?.*\bq=oven")):
        admin.get_by_label("Search by name or what it does").fill("oven")
    admin.get_by_role("button", name=re.compile("^bringAndCure v1")).click()  # the answer is still under way
    expect(chip(admin, "1, Function, bringAndCure")).to_be_visible()
    for route in held:
        route.continue_()
    expect(admin.get_by_text("Nothing to fix")).to_be_visible()
    assert "        self.bring_and_cure()" in script_lines(admin)
    library = author.url.partition("/programs/")[0] + "/sites/painting-factory/library"
    author.goto(library)
    author.get_by_role("link", name="bringAndCure").click()
    sees = author.get_by_role("complementary", name="bringAndCure").get_by_label("Who sees it")
    expect(sees).to_have_value("site")
    sees.select_option("Only its author")
    expect(author.get_by_role("listitem").get_by_role("img", name="Only its author")).to_be_visible()
    admin.goto(library)
    admin.get_by_label("Search by name or what it does").fill("bringAndCure")
    expect(admin.get_by_text("Nothing fits this search")).to_be_visible()


def test_the_paint_order_is_sound_and_rehearses(sign_in: SignIn) -> None:
    page = sign_in("author")
    open_program(page, "Paint order")
    expect(page.get_by_text("Nothing to fix")).to_be_visible()
    names = steps_in_list(page)
    for kind in ("Parallel", "Function", "Operate", "Try", "While", "Wait", "If", "Move", "Pick-and-Drop"):
        assert any(re.search(f", {kind}(,|$)", name) for name in names), f"{kind} is not in {names}"
    page.get_by_role("button", name="Simulate", exact=True).click()
    result = page.get_by_role("region", name="Result")
    expect(result).to_contain_text("Finishes without errors", timeout=180_000)
    expect(result).to_contain_text("by 2 robots")
    programs = ask(page, f"{SITE}/programs")
    assert next(each["errors"] for each in programs if each["name"] == "Paint order") == 0
