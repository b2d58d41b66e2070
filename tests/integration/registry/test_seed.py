from __future__ import annotations

import json
import stat
from pathlib import Path
from typing import Any

import pytest

from registry import services
from registry.demo.devices import DEVICES
from registry.demo.seed import seed_demo
from registry.demo.workshop import WorkshopTaken, find_workshop, seed_workshop
from registry.models import Device, Membership, SiteMap, User
from tests.kit.sites import NOW

pytestmark = pytest.mark.django_db
SITE = "painting-factory"


def test_the_demo_is_seeded_once_and_again_without_change(tmp_path: Path) -> None:
    first = seed_demo(state=tmp_path)
    keys = (tmp_path / "secrets" / "devices.json").read_text()
    assert seed_demo(state=tmp_path) == first
    assert (tmp_path / "secrets" / "devices.json").read_text() == keys
    assert [(a["email"], a["role"]) for a in first] == [
        ("admin@vipo.example", "admin"),
        ("author@vipo.example", "author"),
    ]
    assert (SiteMap.objects.count(), Membership.objects.count(), Device.objects.count()) == (1, 2, 11)
    assert [p.id for p in services.list_places(site=SITE) if p.kind == "dock"] == ["dock1", "dock2", "dock3"]


def test_the_empty_site_is_made_once_and_stays_as_people_left_it() -> None:
    people = {"admin@vipo.example": "admin"}
    User.objects.create_user(email="admin@vipo.example", password="not used here", display_name="Ada")
    assert find_workshop() is None
    seed_workshop(people=people)
    workshop = find_workshop()
    assert workshop is not None
    site = services.get_site(site=workshop.site)
    assert (site.has_map, site.machines, site.robots, site.pending) == (False, 0, 0, 0)
    Membership.objects.filter(site__slug=workshop.site).update(role="viewer")
    seed_workshop(people=people)
    assert list(Membership.objects.values_list("role", flat=True)) == ["viewer"]


def test_a_site_of_that_name_which_somebody_made_is_left_alone() -> None:
    ada = User.objects.create_user(email="ada@x.example", password="not used here", display_name="Ada")
    assert services.create_site(name="Workshop", admin=ada).slug == "workshop"
    assert find_workshop() is None
    with pytest.raises(WorkshopTaken, match="RESET=1 begins anew"):
        seed_workshop(people={"ada@x.example": "admin"})
    assert find_workshop() is None


def test_its_secrets_can_be_read_by_their_owner_only_and_hold(tmp_path: Path) -> None:
    accounts = seed_demo(state=tmp_path)
    files = [tmp_path / "demo-accounts.json", tmp_path / "secrets" / "devices.json", tmp_path / "secrets" / "join"]
    assert [stat.S_IMODE(f.stat().st_mode) for f in files] == [0o600] * 3
    assert json.loads(files[0].read_text()) == accounts
    assert all(User.objects.get(email=a["email"]).check_password(a["password"]) for a in accounts)
    keys: dict[str, Any] = json.loads(files[1].read_text())
    assert all(services.check_device_password(username=i, password=k) for i, k in keys.items())
    assert len(set(keys.values())) == 11


def test_a_new_database_keeps_the_passwords_and_a_lost_file_makes_new_ones(tmp_path: Path) -> None:
    first = seed_demo(state=tmp_path)
    User.objects.all().delete()
    assert seed_demo(state=tmp_path) == first
    assert User.objects.get(email="admin@vipo.example").check_password(first[0]["password"])
    (tmp_path / "demo-accounts.json").unlink()
    second = seed_demo(state=tmp_path)
    assert second[0]["password"] != first[0]["password"]
    assert User.objects.get(email="admin@vipo.example").check_password(second[0]["password"])


def test_the_demos_devices_join_and_one_waits(tmp_path: Path) -> None:
    seed_demo(state=tmp_path)
    assert services.list_devices(site=SITE) == ()
    for path in DEVICES.glob("*.ttl"):
        services.ingest_description(device_id=path.stem, payload=path.read_bytes(), at=NOW)
    site = services.get_site(site=SITE)
    assert (site.machines, site.robots, site.pending, site.simulated) == (7, 3, 1, True)
    assert [d.id for d in services.list_devices(site=SITE, lifecycle="pending")] == ["paintMixer03"]
    floor = services.get_floor_plan(site=SITE)
    assert all(floor.is_free(p.x, p.y, 0.3) for p in services.list_places(site=SITE))
