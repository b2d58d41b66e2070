"""The Things of some sites, a page at a time, as a Thing Description Directory lists them (WoT Discovery)."""

from __future__ import annotations

import json
from collections.abc import Collection, Iterable
from dataclasses import dataclass
from typing import Any, Literal
from urllib.parse import urlencode

from django.http import HttpResponse
from ninja import Field, Schema

from registry.devices.things import newest_news, thing_tag, thing_to_json
from registry.devices.views import DeviceView, view_of
from registry.errors import RegistryError
from registry.models import Device
from vipo_device.descriptions.forms import TD_CONTEXT

DISCOVERY_CONTEXT = "https://www.w3.org/2022/wot/discovery"
SORTED_BY = ("id", "title")
MOST_AT_ONCE = 100


class NotSorted(RegistryError):
    """An order in which Things are not listed."""

    code = "not_sorted"
    status = 501


class Page(Schema):
    """Which part of the Things, in which form and order."""

    offset: int = Field(0, ge=0)
    limit: int = Field(50, ge=1, le=MOST_AT_ONCE)
    format: Literal["array", "collection"] = "array"
    sort_by: str = "id"
    sort_order: Literal["asc", "desc"] = "asc"


@dataclass(frozen=True, slots=True)
class Listed:
    """A page of Things; `tag` stands for all of them, and is another once one comes, goes or changes."""

    views: tuple[DeviceView, ...]
    total: int
    tag: str


def list_page(*, sites: Collection[str], page: Page) -> Listed:
    """Return a page of the approved devices of these sites. Raises NotSorted."""
    if page.sort_by not in SORTED_BY:
        raise NotSorted(f"Things cannot be sorted by {page.sort_by[:64]!r}. Choose {' or '.join(SORTED_BY)}.")
    rows = Device.objects.filter(site__slug__in=sites, lifecycle="approved", description__isnull=False)
    names = rows.values_list("pk", "name_override", "description__name")
    ids = _in_order(names, page)
    chosen = ids[page.offset : page.offset + page.limit]
    found = {row.pk: row for row in rows.filter(pk__in=chosen).select_related("site").defer("source")}
    views = tuple(view_of(found[pk], found[pk].site.slug) for pk in chosen if pk in found)
    return Listed(views, len(ids), thing_tag(f"{newest_news()} {' '.join(sorted(ids))}"))


def _in_order(names: Iterable[tuple[str, str, str]], page: Page) -> list[str]:
    """Return the ids in the page's order: bytewise, and by id where titles are the same."""
    keys = {pk: (renamed or said, pk) if page.sort_by == "title" else (pk, pk) for pk, renamed, said in names}
    return sorted(keys, key=keys.__getitem__, reverse=page.sort_order == "desc")


def answer_page(*, root: str, base: str, page: Page, listed: Listed) -> HttpResponse:
    """Return a page as an array or a collection; `base` is the list's address, `root` where VIPO is served.

    The header Link names the next page.
    """
    members = [thing_to_json(view, root) for view in listed.views]
    end = page.offset + page.limit
    following = _address(base, page, end) if end < listed.total else ""
    body: Any = members if page.format == "array" else _collection(base, page, members, listed.total, following)
    response = HttpResponse(json.dumps(body, ensure_ascii=False), content_type="application/ld+json")
    links = [f'<{following}>; rel="next"'] if following else []
    response["Link"] = ", ".join([*links, f'<{base}>; rel="canonical"; etag={listed.tag}'])
    return response


def _address(base: str, page: Page, offset: int) -> str:
    order = {"sort_by": page.sort_by} if page.sort_by != "id" else {}
    order |= {"sort_order": page.sort_order} if page.sort_order != "asc" else {}
    return f"{base}?{urlencode({'offset': offset, 'limit': page.limit, 'format': page.format, **order})}"


def _collection(base: str, page: Page, members: list[Any], total: int, following: str) -> dict[str, Any]:
    body = {
        "@context": [DISCOVERY_CONTEXT, TD_CONTEXT],
        "@type": "ThingCollection",
        "@id": _address(base, page, page.offset),
        "total": total,
        "members": members,
    }
    return {**body, "next": following} if following else body
