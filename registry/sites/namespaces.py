"""Which names a site may give, where several sites share one broker: ids of devices and legacy topics are global there.

The site that was there first (or the default one) gives plain names, every other site names that begin with its own.
So whether a new name is taken never tells what there is at another site, and no site can take another's names.
"""

from __future__ import annotations

from collections.abc import Mapping

from django.conf import settings

from registry.models import Device, Site, TopicClaim

OF_IDS, OF_TOPICS = ".", "/"
"""What stands between a site's short name and the rest: `hall.robot1`, `hall/robot1/move`."""


def may_name(site: Site, name: str, separator: str) -> bool:
    """Tell whether a site may give a new id or topic of this name, whatever names there are."""
    return not find_foreign({name: site}, separator)


def find_foreign(names: Mapping[str, Site], separator: str) -> frozenset[str]:
    """Return those of new ids or topics that the site of each may not give; at most three questions for all."""
    parts = {name: name.partition(separator) for name in names}
    asked = {name: site for name, site in names.items() if parts[name][:2] != (site.slug, separator)}
    if not asked:
        return frozenset()
    slugs = {first for first, found, _ in map(parts.__getitem__, asked) if found}
    taken = set(Site.objects.filter(slug__in=slugs).values_list("slug", flat=True)) if slugs else set()
    plain = _find_plain_site()
    return frozenset(
        name for name, site in asked.items() if site.pk != plain or (parts[name][1] and parts[name][0] in taken)
    )


def may_have_device(site: Site, device_id: str, home: int | None) -> bool:
    """Tell whether a device of this id is a site's or can become its; `home` is the site's row that has it, if any."""
    return may_name(site, device_id, OF_IDS) if home is None else home == site.pk


def _find_plain_site() -> int | None:
    """Return the row of the site that gives plain names."""
    default = Site.objects.filter(slug=settings.VIPO_DEFAULT_SITE).values_list("pk", flat=True).first()
    return default or Site.objects.order_by("pk").values_list("pk", flat=True).first()


def is_in_use(slug: str) -> bool:
    """Tell whether some device's id or topic begins like those of a site of this short name would."""
    topics = TopicClaim.objects.filter(topic__startswith=slug + OF_TOPICS)
    return Device.objects.filter(pk__startswith=slug + OF_IDS).exists() or topics.exists()
