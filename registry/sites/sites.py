"""Sites, their maps, places and members."""

from __future__ import annotations

import zlib
from collections.abc import Sequence
from datetime import datetime
from functools import lru_cache

from django.db import IntegrityError, models, transaction
from django.utils.text import slugify

from registry.devices.views import MapView, PlaceView, SiteView, StopView, effective_description
from registry.floorplan.map_server import read_map
from registry.floorplan.plan import Box, FloorPlan, Grid, wall_boxes
from registry.live.fanout import publish
from registry.models import Device, Membership, Place, Site, SiteMap, User
from registry.people.access import ROLES, NotAMember
from vipo_device.protocol.credentials import broker_hash, secret_hash
from vipo_device.protocol.description import Description
from vipo_device.protocol.errors import RegistryError

MOST_VERSIONS = 50


class NoMap(RegistryError):
    """The site has no map yet."""

    code = "no_map"
    status = 404


class MapChanged(RegistryError):
    """The map that somebody looked at is not the newest any more."""

    code = "map_changed"
    status = 409


class BadName(RegistryError):
    """A name that nothing can be called by."""

    code = "bad_name"
    status = 422


class UnknownPerson(RegistryError):
    """Nobody signs in with that e-mail address."""

    code = "unknown_person"
    status = 422


def find_site(slug: str) -> Site:
    """Return the site's row; raises NotAMember, which looks like 404."""
    site = Site.objects.filter(slug=slug).first()
    if site is None:
        raise NotAMember(f"There is no site {slug[:64]!r}.")
    return site


def get_site_id(*, site: str) -> int:
    """Return the row number of a site, which other apps keep beside what is the site's; raises NotAMember."""
    return find_site(site).pk


def list_sites(*, user: User) -> tuple[SiteView, ...]:
    """Return the sites where the user is a member, by name."""
    members = Membership.objects.filter(user=user).select_related("site").order_by("site__name", "site__slug")
    return tuple(_site_view(m.site, m.role) for m in members)


def list_slugs() -> tuple[str, ...]:
    """Return the short names of all sites."""
    return tuple(Site.objects.order_by("slug").values_list("slug", flat=True))


def get_site(*, site: str, role: str = "") -> SiteView:
    """Return a site; `role` is written into the view as it is."""
    return _site_view(find_site(site), role)


def _site_view(site: Site, role: str) -> SiteView:
    rows = Device.objects.filter(site=site).exclude(lifecycle=Device.Lifecycle.RETIRED).defer("source")
    shown = [d for d in rows if d.description]
    approved = [d for d in shown if d.lifecycle == Device.Lifecycle.APPROVED]
    robots = sum(1 for d in approved if d.description and d.description["kind"] == "robot")
    return SiteView(
        slug=site.slug,
        name=site.name,
        role=role,
        machines=len(approved) - robots,
        robots=robots,
        online=sum(1 for d in approved if d.online),
        pending=len(shown) - len(approved),
        has_map=SiteMap.objects.filter(site=site).exists(),
        stop=StopView(site.stop_active, site.stop_by, site.stop_at),
        simulated=any(d.description and d.description["simulated"] for d in approved),
    )


def create_site(*, name: str, admin: User | None = None, slug: str = "") -> SiteView:
    """Make an empty site; `admin` becomes its first member. Raises BadName."""
    name = " ".join(name.split())
    if not 1 <= len(name) <= 100 or not name.isprintable():
        raise BadName("A site needs a name of 1 to 100 characters that can be printed.")
    with transaction.atomic():
        site = _new_site(name, slug or slugify(name)[:50] or "site", exact=bool(slug))
        if admin:
            Membership.objects.create(site=site, user=admin, role=Membership.Role.ADMIN)
    return _site_view(site, Membership.Role.ADMIN if admin else "")


def _new_site(name: str, slug: str, *, exact: bool) -> Site:
    """Insert under the first free slug; another request may take one between looking and inserting."""
    for number in range(1, 1000):
        wanted = slug if number == 1 else f"{slug}-{number}"
        try:
            with transaction.atomic():
                return Site.objects.create(name=name, slug=wanted)
        except IntegrityError:
            if exact:
                raise BadName(f"There is already a site {slug!r}. Choose another name.") from None
    raise BadName("There are too many sites of this name. Choose another one.")


def create_site_from_map(*, name: str, yaml: bytes, image: bytes | None, admin: User) -> SiteView:
    """Make a site from a ROS map; nothing is made when the map cannot be read. Raises BadMap, BadName."""
    grid = read_map(yaml, image)
    with transaction.atomic():
        view = create_site(name=name, admin=admin)
        save_map(site=view.slug, grid=grid, source="upload", by=admin)
    return get_site(site=view.slug, role=view.role)


def save_map(
    *, site: str, grid: Grid, source: str = "", by: User | None = None, replaces: int | None = None
) -> MapView:
    """Make a grid the site's map, as a new version, and tell browsers; the oldest beyond 50 versions are forgotten.

    `replaces` is the version (0: none) that the caller has seen. Raises MapChanged when another one holds by now.
    """
    with transaction.atomic():
        row = Site.objects.select_for_update().get(slug=site)
        latest = SiteMap.objects.filter(site=row).aggregate(models.Max("version"))["version__max"] or 0
        if replaces is not None and replaces != latest:
            raise MapChanged(
                "Somebody has changed the site's map meanwhile. Look at it again, then decide.", {"why": "site"}
            )
        saved = SiteMap.objects.create(
            site=row,
            version=latest + 1,
            width=grid.width,
            height=grid.height,
            resolution_m=grid.resolution_m,
            origin_x_m=grid.origin_x_m,
            origin_y_m=grid.origin_y_m,
            packed_cells=zlib.compress(grid.cells, 6),
            source=source,
            by=by,
        )
        SiteMap.objects.filter(site=row, version__lte=saved.version - MOST_VERSIONS).delete()
        transaction.on_commit(lambda: publish(site, {"type": "map", "version": saved.version}))
    return MapView(site, saved.version, grid)


def get_map(*, site: str) -> MapView:
    """Return the site's newest map. Raises NoMap."""
    row = find_site(site)
    latest = SiteMap.objects.filter(site=row).order_by("-version").values_list("pk", "version", "created_at").first()
    if latest is None:
        raise NoMap("This site has no map yet. Upload a ROS map (.yaml with its image).")
    return MapView(site, latest[1], _grid(latest[0], latest[2]))


@lru_cache(maxsize=8)
def _grid(map_id: int, created_at: datetime) -> Grid:
    """Unpack a map once in each process: it never changes; the time tells apart rows that were given the same key."""
    row = SiteMap.objects.get(pk=map_id)
    return Grid(row.width, row.height, row.resolution_m, row.origin_x_m, row.origin_y_m, row.cells)


@lru_cache(maxsize=8)
def get_walls(grid: Grid) -> tuple[Box, ...]:
    """Return the walls of a grid as boxes, worked out once."""
    return wall_boxes(grid)


def get_floor(*, site: str) -> FloorPlan:
    """Return what the map says about points and ways, approved machines being obstacles. Raises NoMap."""
    rows = Device.objects.filter(site__slug=site, lifecycle=Device.Lifecycle.APPROVED).order_by("id")
    described = [effective_description(d) for d in rows if d.description]
    return _floor(get_map(site=site).grid, tuple(d for d in described if d.kind == "machine"))


@lru_cache(maxsize=8)
def _floor(grid: Grid, machines: tuple[Description, ...]) -> FloorPlan:
    return FloorPlan(grid, machines)


def save_places(*, site: str, places: Sequence[PlaceView]) -> None:
    """Add the places, or change the ones that have the same id."""
    row = find_site(site)
    for place in places:
        Place.objects.update_or_create(
            site=row,
            key=place.id,
            defaults={
                "name": place.name,
                "kind": place.kind,
                "x": place.x,
                "y": place.y,
                "theta": place.theta,
                "label": list(place.label) if place.label else None,
            },
        )


def list_places(*, site: str) -> tuple[PlaceView, ...]:
    """Return the site's named places, by id."""
    rows = Place.objects.filter(site=find_site(site)).order_by("key")
    return tuple(
        PlaceView(p.key, p.name, p.kind, p.x, p.y, p.theta, (p.label[0], p.label[1]) if p.label else None) for p in rows
    )


def set_member(*, site: str, email: str, role: str) -> None:
    """Make a person a member, or change their role. Raises UnknownPerson."""
    if role not in ROLES:
        raise BadName(f"There is no role {role[:20]!r}. Choose {', '.join(ROLES)}.")
    person = User.objects.filter(email=email.strip().lower()).first()
    if person is None:
        raise UnknownPerson(f"Nobody signs in as {email[:100]!r}. Check the address.")
    Membership.objects.update_or_create(site=find_site(site), user=person, defaults={"role": role})
    transaction.on_commit(lambda: publish(site, {"type": "members"}))


def remove_member(*, site: str, email: str) -> None:
    """End a membership; the person's open pages of the site are closed."""
    Membership.objects.filter(site=find_site(site), user__email=email.strip().lower()).delete()
    transaction.on_commit(lambda: publish(site, {"type": "members"}))


def set_site_stop(*, site: str, active: bool, by: str, at: datetime) -> None:
    """Keep for display that the site was stopped or set free; `execution` decides and tells the devices."""
    Site.objects.filter(slug=site).update(stop_active=active, stop_by=by, stop_at=at)


def set_join_key(*, site: str, join_key: str) -> None:
    """Set the key with which devices that have none of their own may come to the site's door."""
    if len(join_key) < 20:
        raise BadName("A join key needs at least 20 characters; make it at random.")
    with transaction.atomic():
        row = Site.objects.select_for_update().get(pk=find_site(site).pk)
        if row.join_key_hash != secret_hash(join_key) or not row.join_broker_hash:
            row.join_key_hash, row.join_broker_hash = secret_hash(join_key), broker_hash(join_key)
            row.save(update_fields=["join_key_hash", "join_broker_hash"])
