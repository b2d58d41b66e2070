"""After a backup came back another map may have a lost one's number: it is not taken for that one."""

import gzip

import pytest

from registry import services as registry
from registry.models import RobotMap, SiteMap
from tests.integration.execution.maps.brought_maps import PLAN, bring, say_map, tag_of, walled, widened
from tests.kit.programs import SITE
from tests.kit.sign_in import join_and_sign_in, post_json

pytestmark = pytest.mark.django_db(transaction=True)


def lost_to_a_backup(grid):
    """Save a map and bring back the backup from before it; the next map has its number."""
    lost = registry.save_map(site=SITE, grid=grid)
    yield lost
    SiteMap.objects.get(site__slug=SITE, version=lost.version).delete()
    yield registry.save_map(site=SITE, grid=widened())


def test_a_map_of_the_same_number_after_a_backup_is_another(factory):
    client = join_and_sign_in("admin", SITE)
    story = lost_to_a_backup(walled(7, -8, 7.5, -7.5))
    lost, known = next(story), tag_of(client)
    old = f"/api/sites/{SITE}/map/versions/{lost.version}"
    assert client.get(old).json()["tag"] == client.get(f"{old}/cells")["ETag"] == known
    assert next(story).version == lost.version
    for cells in (f"/api/sites/{SITE}/map/cells", f"{old}/cells"):
        again = client.get(cells, headers={"If-None-Match": known})
        assert (again.status_code, gzip.decompress(again.content)) == (200, widened().cells)
        assert client.get(cells, headers={"If-None-Match": again["ETag"]}).status_code == 304
    refused = bring(client, PLAN, known)
    assert (refused.status_code, refused.json()["code"]) == (412, "map_overtaken")
    assert registry.get_map(site=SITE).grid == widened()


def test_a_map_that_took_a_lost_ones_number_is_not_restored_in_its_place(factory):
    client = join_and_sign_in("admin", SITE)
    story = lost_to_a_backup(walled(7, -8, 7.5, -7.5))
    next(story)
    known, first = client.get(f"/api/sites/{SITE}/map/versions").json()
    assert known["tag"] == tag_of(client) != first["tag"]
    next(story)
    body = {"version": 1, "replaces": 2, "tag": first["tag"]}
    refused = restore(client, {**body, "replaces_tag": known["tag"]})
    assert (refused.status_code, refused.json()["args"]) == (409, {"why": "site"})
    assert restore(client, {**body, "replaces_tag": tag_of(client)}).json() == {"version": 3}
    body = {"version": 2, "replaces": 3, "tag": known["tag"]}
    refused = restore(client, body)
    assert (refused.status_code, refused.json()["args"]) == (409, {"why": "version"})
    assert registry.get_map(site=SITE).grid == PLAN
    assert restore(client, {"version": 2, "replaces": 3}).json() == {"version": 4}, "an older page knows no tags"


def restore(client, body):
    return post_json(client, f"/api/sites/{SITE}/map/restore", body)


def test_a_robots_map_of_the_same_number_after_a_backup_is_another(factory):
    client = join_and_sign_in("viewer", SITE)
    cells = f"/api/sites/{SITE}/devices/robot01/map/cells"
    say_map(widened(), number=1)
    known = client.get(cells)["ETag"]
    assert client.get(f"/api/sites/{SITE}/devices/robot01/map").json()["tag"] == known
    assert client.get(cells, headers={"If-None-Match": known}).status_code == 304
    RobotMap.objects.all().delete()
    say_map(PLAN, number=2)
    again = client.get(cells, headers={"If-None-Match": known})
    assert (again.status_code, gzip.decompress(again.content)) == (200, PLAN.cells)


def test_a_robots_map_that_took_a_lost_ones_number_is_not_used_in_its_place(factory):
    client = join_and_sign_in("admin", SITE)
    say_map(widened(), number=1)
    seen = client.get(f"/api/sites/{SITE}/devices/robot01/map/difference").json()
    assert seen["tag"] == client.get(f"/api/sites/{SITE}/devices/robot01/map").json()["tag"]
    assert seen["replaces_tag"] == tag_of(client)
    body = {"device": "robot01", **{name: seen[name] for name in ("version", "tag", "replaces", "replaces_tag")}}
    RobotMap.objects.all().delete()
    say_map(PLAN, number=2)
    path = f"/api/sites/{SITE}/map/from-device"
    refused = post_json(client, path, body)
    assert (refused.status_code, refused.json()["args"]) == (409, {"why": "robot"})
    now = client.get(f"/api/sites/{SITE}/devices/robot01/map/difference").json()
    assert post_json(client, path, {**body, "tag": now["tag"]}).json() == {"version": 2}
    SiteMap.objects.all().delete()
    none = client.get(f"/api/sites/{SITE}/devices/robot01/map/difference").json()
    assert (none["replaces"], none["replaces_tag"]) == (0, "")
