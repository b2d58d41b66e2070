"""Long lists, given a page at a time: what is added or goes meanwhile neither moves nor doubles what follows.

A page ends with a mark, which says where the next one begins: what the list is ordered by, and the row. It is signed,
so that nobody can put into it what the database cannot compare.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar

from django.core import signing
from django.db.models import Model, Q, QuerySet

from vipo_device.protocol.errors import VipoError

MOST_AT_ONCE = 200
_SALT = "vipo.part"
Row = TypeVar("Row", bound=Model)
View = TypeVar("View")


class BadMark(VipoError):
    """A mark that no list has told, or that another one has."""

    code = "bad_mark"
    status = 422


@dataclass(frozen=True, slots=True)
class Page:
    """How much is asked for at most, and after which mark; empty: from the beginning."""

    limit: int = MOST_AT_ONCE
    before: str = ""


FIRST = Page()


class Listed(tuple[View, ...]):
    """A page of a list; `rest` is the mark after which it goes on, empty where nothing follows."""

    rest: str = ""


def take_page(*, rows: QuerySet[Row], by: str, page: Page, view: Callable[[Row], View]) -> Listed[View]:
    """Return a page of the rows, ordered by a field (`-field`: the greatest first) and then by their key.

    Raises BadMark.
    """
    field, is_falling = by.removeprefix("-"), by.startswith("-")
    ordered = rows.order_by(by, "-pk" if is_falling else "pk")
    if page.before:
        ordered = ordered.filter(_behind(field, "lt" if is_falling else "gt", rows, page.before))
    found = list(ordered[: page.limit + 1])
    listed = Listed(view(row) for row in found[: page.limit])
    if len(found) > page.limit:
        listed.rest = _mark(rows, field, found[page.limit - 1])
    return listed


def _mark(rows: QuerySet[Row], field: str, row: Row) -> str:
    texts = [_field(rows, name).value_to_string(row) for name in (field, _key(rows))]
    return signing.dumps([rows.model._meta.label, field, *texts], salt=_SALT)


def _behind(field: str, way: str, rows: QuerySet[Row], mark: str) -> Q:
    try:
        of, by, *texts = signing.loads(mark, salt=_SALT)
    except signing.BadSignature:
        of, by, texts = "", "", []
    if (of, by) != (rows.model._meta.label, field):
        raise BadMark("This list has no such mark. Take the next address from its header Link, or begin anew.")
    value, key = (_field(rows, name).to_python(text) for name, text in zip((field, _key(rows)), texts, strict=True))
    return Q(**{f"{field}__{way}": value}) | Q(**{field: value, f"pk__{way}": key})


def _field(rows: QuerySet[Row], name: str) -> Any:
    return rows.model._meta.get_field(name)


def _key(rows: QuerySet[Row]) -> str:
    return rows.model._meta.pk.name
