"""Fill in the painting factory: site, map, places, people, and the keys of the devices that are expected."""

from __future__ import annotations

import json
import os
import secrets
from math import pi
from pathlib import Path
from typing import Any

from registry.demo.accounts import FILE, read_accounts
from registry.demo.devices import PENDING_DEVICE, SITE, describe_devices
from registry.demo.factory import FOLDER, MAP_NAME, read_plan
from registry.devices.enrolment import expect_device
from registry.floorplan.map_server import read_map
from registry.maps.site_maps import save_map
from registry.models import Site, SiteMap, User
from registry.people.passwords import draw_password
from registry.people.sign_in import create_user
from registry.sites.members import set_member
from registry.sites.quota import USUAL_SITES, set_site_quota
from registry.sites.sites import create_site, save_places, set_enrolment_key
from registry.sites.views import PlaceView

SITE_NAME = "Painting Factory"
PEOPLE = (("admin@vipo.example", "Ada Meyer", "admin"), ("author@vipo.example", "Otto Brandt", "author"))
ROOM_CENTRES = {
    "Goods in": (3.1, -4.6),
    "Paint store": (8.8, -4.6),
    "Mixing": (13.2, -3.4),
    "Painting": (20.6, -5.5),
    "Corridor": (7.0, -8.0),
    "Dispatch": (3.6, -12.75),
    "Curing": (12.8, -11.4),
    "Dock bay": (17.2, -10.2),
}


def seed_demo(*, state: Path) -> list[dict[str, str]]:
    """Make what is missing of the demo and return its accounts; doing it again changes nothing."""
    if not Site.objects.filter(slug=SITE).exists():
        create_site(name=SITE_NAME, slug=SITE)
    if not SiteMap.objects.filter(site__slug=SITE).exists():
        header, image = (FOLDER / f"{MAP_NAME}.yaml").read_bytes(), (FOLDER / f"{MAP_NAME}.pgm").read_bytes()
        save_map(site=SITE, grid=read_map(header, image), source="demo")
        save_places(site=SITE, places=demo_places())
    _seed_devices(state)
    return _seed_people(state)


def demo_places() -> list[PlaceView]:
    """Return the rooms and docks of the floor plan."""
    plan = read_plan()
    labels = {room["name"]: room["label_at"] for room in plan["rooms"]}
    rooms = [
        PlaceView(_key(name), name, "room", x, y, 0.0, label=(labels[name][0], -labels[name][1]))
        for name, (x, y) in ROOM_CENTRES.items()
    ]
    docks = [
        PlaceView(f"dock{number}", f"Dock {number}", "dock", x, -y, round(pi / 2, 4))
        for number, (x, y) in enumerate(plan["docks"], 1)
    ]
    return rooms + docks


def _key(name: str) -> str:
    first, *rest = name.split()
    return first.lower() + "".join(word.capitalize() for word in rest)


def _seed_devices(state: Path) -> None:
    """Make a key for each device, once; the pending one has one too, but nobody has approved it."""
    path = state / "secrets" / "devices.json"
    keys: dict[str, str] = _read(path, {})
    for device in describe_devices():
        keys.setdefault(device.id, secrets.token_urlsafe(32))
        expect_device(site=SITE, device_id=device.id, credential=keys[device.id], approved=device.id != PENDING_DEVICE)
    _write_private(path, json.dumps(keys, indent=1))
    _seed_enrolment_key(state / "secrets" / "join")


def _seed_enrolment_key(path: Path) -> None:
    if not path.exists():
        _write_private(path, secrets.token_urlsafe(32))
    set_enrolment_key(site=SITE, key=path.read_text().strip())


def _seed_people(state: Path) -> list[dict[str, str]]:
    """Make the accounts; the file's passwords hold for a new database, new ones are made when the file is gone."""
    passwords = {a["email"]: a["password"] for a in read_accounts(state=state)}
    accounts = []
    for email, name, role in PEOPLE:
        password = passwords.get(email) or draw_password(email=email, display_name=name)
        user = User.objects.filter(email=email).first()
        if user is None:
            create_user(email=email, password=password, display_name=name)
        elif email not in passwords:
            user.set_password(password)
            user.save(update_fields=["password"])
        if user is None and role == "admin":
            set_site_quota(email=email, sites=USUAL_SITES)
        set_member(site=SITE, email=email, role=role)
        accounts.append({"email": email, "password": password, "role": role})
    if passwords != {a["email"]: a["password"] for a in accounts}:
        _write_private(state / FILE, json.dumps(accounts, indent=1))
    return accounts


def _read(path: Path, default: Any) -> Any:
    return json.loads(path.read_text()) if path.exists() else default


def _write_private(path: Path, text: str) -> None:
    """Write a file that only its owner may read, whole or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
    part = path.with_name(path.name + ".part")
    part.unlink(missing_ok=True)
    with os.fdopen(os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w") as file:
        file.write(text)
    part.replace(path)
