from pathlib import Path
import pytest
from PIL import Image, ImageDraw
from tests.e2e.screens import violations, ask, tell
pytestmark = pytest.mark.browser
OUT = Path("/tmp/maps/shots"); OUT.mkdir(exist_ok=True, parents=True)
def test_look(sign_in, tmp_path, faults):
    img = Image.new("RGB", (900, 600), "white"); d = ImageDraw.Draw(img)
    d.rectangle((60,60,840,540), outline="black", width=6); d.line((400,60,400,380), fill="black", width=5); d.rectangle((600,100,700,200), outline="#888", width=3)
    img.save(tmp_path/"plan.jpg")
    for dark in (False, True):
        for w,h in ((1600,1000),(820,1180)):
            tag=f"{w}{'d' if dark else ''}"
            page = sign_in("admin", "/sites/new", width=w, height=h, dark=dark)
            page.get_by_label("Choose both files, or drop them here").set_input_files(tmp_path/"plan.jpg")
            page.get_by_label("How long is the line?").fill("12")
            page.wait_for_timeout(500); page.screenshot(path=OUT/f"picture-{tag}.png"); print(tag, violations(page))
            page.goto(page.url.replace("/sites/new","/sites/painting-factory/map/edit"))
            page.get_by_role("application").wait_for(); page.wait_for_timeout(700)
            box=page.get_by_role("application").bounding_box()
            cx,cy=box["x"]+box["width"]/2, box["y"]+box["height"]/2
            page.mouse.move(cx-60,cy-20); page.mouse.down(); page.mouse.move(cx+60,cy+30,steps=4); page.mouse.up()
            page.keyboard.press("m")
            page.mouse.move(cx-160,cy-60); page.mouse.down(); page.mouse.move(cx+60,cy-60,steps=4); page.mouse.up()
            page.wait_for_timeout(300); page.screenshot(path=OUT/f"edit-{tag}.png"); print(tag, violations(page))
            page.get_by_role("button", name="Save").click()
            page.get_by_role("dialog").get_by_text("It becomes a new version").wait_for(); page.wait_for_timeout(1500)
            page.screenshot(path=OUT/f"save-{tag}.png"); print(tag, violations(page))
            page.keyboard.press("Escape")
            page.get_by_role("link", name="Close").click(); page.wait_for_timeout(300)
            page.screenshot(path=OUT/f"leave-{tag}.png")
            page.get_by_role("button", name="Leave without saving").click(); page.wait_for_timeout(700)
            page.screenshot(path=OUT/f"map-{tag}.png"); print(tag, violations(page))
    page = sign_in("admin", "/", language="de")
    page.wait_for_timeout(500); page.screenshot(path=OUT/"home.png")
    page.goto(page.url+"sites/new"); page.get_by_label("Name des Standorts").fill("Leer")
    page.get_by_role("button", name="Vorerst ohne Karte").click(); page.wait_for_timeout(1000)
    page.screenshot(path=OUT/"start-de.png"); print(violations(page))
    page.set_viewport_size({"width":820,"height":1180}); page.wait_for_timeout(400); page.screenshot(path=OUT/"start-820.png")
