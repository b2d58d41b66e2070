"""Sites and their places, the key for enrolment, and the stop that holds at a site."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from datetime import datetime, timedelta
from hashlib import sha256

from cryptography.fernet import InvalidToken
from django.db import IntegrityError, transaction
from django.utils import timezone
from django.utils.text import slugify

from registry.errors import RegistryError
from registry.models import Device, Membership, Place, SimulatedObstacle, Site, SiteMap, SiteZone, User
from registry.people.access import NotAMember, access_of, list_memberships
from registry.people.sealing import Sealing
from registry.sites.namespaces import is_in_use, may_have_device
from registry.sites.views import ObstacleView, PlaceView, SiteView, StopView, ZoneView
from vipo_device.protocol.credentials import broker_hash, secret_hash
from vipo_device.protocol.texts import find_unfit, normal

_SEALING = Sealing(lambda key: sha256(b"join-key:" + key.encode()).digest())
AT_ONCE = timedelta(seconds=10)
"""Who presses "new key" within this time after somebody else is told the same key."""


class BadName(RegistryError):
    """A name that nothing can be called by."""

    code = "bad_name"
    status = 422


class SiteNameTaken(RegistryError):
    """A new site's name is that of another site of whoever makes it."""

    code = "name_taken"
    status = 409


class NoEnrolmentKey(RegistryError):
    """A site's enrolment key that cannot be shown."""

    code = "no_join_key"
    status = 404


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
    found = Site.objects.filter(slug=site).values_list("pk", flat=True).first()
    return find_site(site).pk if found is None else found


def list_sites(*, user: User) -> tuple[SiteView, ...]:
    """Return the sites where the user is a member, by name."""
    members = list_memberships(user).order_by("site__name", "site__slug")
    return tuple(_site_view(m.site, access.role, access.held_role) for m in members if (access := access_of(user, m)))


def list_slugs() -> tuple[str, ...]:
    """Return the short names of all sites."""
    return tuple(Site.objects.order_by("slug").values_list("slug", flat=True))


def get_site(*, site: str, role: str = "", held_role: str = "") -> SiteView:
    """Return a site; `role` and `held_role` are written into the view as they are."""
    return _site_view(find_site(site), role, held_role)


def _site_view(site: Site, role: str, held_role: str = "") -> SiteView:
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
        simulated=bool(approved)
        and all(d.stand_in or (d.description and d.description["simulated"]) for d in approved),
        held_role=held_role,
    )


def create_site(*, name: str, admin: User | None = None, slug: str = "") -> SiteView:
    """Make an empty site; `admin` becomes its first member. Raises BadName, SiteNameTaken."""
    name = checked_name(name, admin)
    with transaction.atomic():
        site = _new_site(name, slug or slugify(name)[:50] or "site", admin, exact=bool(slug))
        if admin:
            Membership.objects.create(site=site, user=admin, role=Membership.Role.ADMIN, joined_at=timezone.now())
    return _site_view(site, Membership.Role.ADMIN if admin else "")


def checked_name(name: str, admin: User | None) -> str:
    """Return a name for a site in its normal form. Raises BadName, SiteNameTaken.

    It is told from those of the sites that `admin` sees, whatever their letters' case; nobody learns of other sites by
    it. Who makes several at once holds `lock_site_quota`.
    """
    name = normal(" ".join(name.split()))
    if not 1 <= len(name) <= 100 or find_unfit(name, is_line=True):
        raise BadName("A site needs a name of 1 to 100 characters that can be printed.")
    others = list_memberships(admin).values_list("site__name", flat=True) if admin else ()
    other = next((each for each in others if each.casefold() == name.casefold()), None)
    if other is not None:
        text = f"You have a site {other!r} already. Choose another name, so that nobody takes one for the other."
        raise SiteNameTaken(text, {"why": "site", "name": other})
    return name


def _new_site(name: str, slug: str, made_by: User | None, *, exact: bool) -> Site:
    """Insert under the first free slug; another request may take one between looking and inserting."""
    for number in range(1, 1000):
        wanted = slug if number == 1 else f"{slug}-{number}"
        if not exact and is_in_use(wanted):
            continue
        try:
            with transaction.atomic():
                return Site.objects.create(name=name, slug=wanted, made_by=made_by)
        except IntegrityError:
            if exact:
                raise BadName(f"There is already a site {slug!r}. Choose another name.") from None
    raise BadName("There are too many sites of this name. Choose another one.")


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


_PLACE = ("key", "name", "kind", "x", "y", "theta", "label")


def list_places(*, site: str) -> tuple[PlaceView, ...]:
    """Return the site's named places, by id; raises NotAMember where there is no such site."""
    rows = Place.objects.filter(site__slug=site).order_by("key")
    found = tuple(
        PlaceView(key, name, kind, x, y, theta, (label[0], label[1]) if label else None)
        for key, name, kind, x, y, theta, label in rows.values_list(*_PLACE)
    )
    if not found:
        find_site(site)
    return found


def list_strange_ids(*, site: str, ids: Collection[str]) -> tuple[str, ...]:
    """Return, in their order, the ids that are no device's of the site and cannot become one's; raises NotAMember."""
    row = find_site(site)
    homes = dict(Device.objects.filter(pk__in=ids).values_list("pk", "site_id"))
    return tuple(name for name in sorted(ids) if not may_have_device(row, name, homes.get(name)))


def list_zones(*, site: str) -> tuple[ZoneView, ...]:
    """Return the site's zones, by id; none where there is no such site."""
    rows = SiteZone.objects.filter(site__slug=site).order_by("key")
    return tuple(
        ZoneView(
            z.key,
            z.name,
            z.rule,
            tuple((float(x), float(y)) for x, y in z.points),
            z.speed_m_s,
            (z.robots or 1) if z.rule == SiteZone.Rule.ONE_AT_A_TIME else None,
            z.heading_deg,
            z.open_until,
        )
        for z in rows
    )


def list_obstacles(*, site: str) -> tuple[ObstacleView, ...]:
    """Return what people have put in the way of a site's simulated robots, oldest first; nothing without a site."""
    rows = SimulatedObstacle.objects.filter(site__slug=site).order_by("pk")
    return tuple(ObstacleView(o.pk, o.x, o.y, o.size_m) for o in rows)


def lock_site(slug: str) -> Site:
    """Lock a site's row until the transaction ends. Raises NotAMember.

    Whoever changes a thing of the site for which a line of the record is written takes this first: the line refers to
    the site's row, so that of two who begin at different ends each would wait for the other. Until then no row that
    refers to the site is kept, such as a new device's (`add_place` counts on it): a weaker lock (`no_key`) will not do.
    """
    return Site.objects.select_for_update().get(pk=find_site(slug).pk)


def set_site_stop(*, site: str, active: bool, by: str, at: datetime) -> None:
    """Keep for display that the site was stopped or set free; `execution` decides and tells the devices."""
    Site.objects.filter(slug=site).update(stop_active=active, stop_by=by, stop_at=at)


def set_enrolment_key(*, site: str, key: str) -> None:
    """Set the key with which devices that have none of their own may enrol at the site."""
    if len(key) < 20:
        raise BadName("An enrolment key needs at least 20 characters; make it at random.")
    with transaction.atomic():
        row = lock_site(site)
        if row.join_key_hash != secret_hash(key) or not row.join_broker_hash or not _unsealed(row):
            row.join_key_hash, row.join_broker_hash = secret_hash(key), broker_hash(key)
            row.join_key_sealed, row.join_key_at = _SEALING.seal(key), timezone.now()
            row.save(update_fields=["join_key_hash", "join_broker_hash", "join_key_sealed", "join_key_at"])


def get_enrolment_key(*, site: str) -> str:
    """Return the key with which devices may enrol at the site. Raises NoEnrolmentKey, NotAMember."""
    key = _unsealed(find_site(site))
    if not key:
        raise NoEnrolmentKey(
            f"The enrolment key of {site} cannot be shown: it was made by an earlier version, or with another "
            "VIPO_SECRET_KEY. Devices still enrol with it; --new makes another one."
        )
    return key


def has_enrolment_key(*, site: str) -> bool:
    """Tell whether devices may enrol at the site with any key. Raises NotAMember."""
    return bool(find_site(site).join_key_hash)


def replace_enrolment_key(*, site: str, key: str) -> str:
    """Set the enrolment key, and return which one holds: of several people at once all are told the same."""
    row = lock_site(site)
    just_made = row.join_key_at is not None and timezone.now() - row.join_key_at < AT_ONCE
    if just_made and (known := _unsealed(row)):
        return known
    set_enrolment_key(site=site, key=key)
    return key


def _unsealed(row: Site) -> str:
    """Return a site's key; empty where there is none, or it was sealed with a secret that nobody names any more.

    What a former secret has sealed is sealed anew, so that that one can go.
    """
    if not row.join_key_sealed:
        return ""
    try:
        key, is_of_today = _SEALING.unseal(row.join_key_sealed)
    except InvalidToken:
        return ""
    if not is_of_today:
        rows = Site.objects.filter(pk=row.pk, join_key_sealed=row.join_key_sealed)
        rows.update(join_key_sealed=_SEALING.seal(key))
    return key
