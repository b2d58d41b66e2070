"""Rows written with statements that are planned once: what an owner writes with every turn costs no query's making."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

from django.db import connection, models

from execution import database

Fields = tuple["models.Field[Any, Any]", ...]


def insert_all(batch: database.Batch, model: type[models.Model], rows: Iterable[models.Model]) -> None:
    """Insert new rows; those that have no key of their own are given one by the database and do not learn it."""
    fields, into = _insert(model)
    batch.insert(into, [[_stored(field, row) for field in fields] for row in rows])


@dataclass(frozen=True, slots=True)
class Guarded:
    """Rows that are written each from an epoch: how many there are, and the cursor that knows how many were."""

    count: int
    answer: Any = None

    @property
    def is_whole(self) -> bool:
        """Tell, behind its batch, whether all of them had that epoch; if not, all is to be rolled back."""
        return not self.count or bool(self.answer.rowcount == self.count)


def update_all(
    batch: database.Batch, model: type[models.Model], names: Sequence[str], rows: Iterable[tuple[models.Model, int]]
) -> Guarded:
    """Write these columns of rows and count their `epoch` up, each from the epoch that it is said to have."""
    fields, statement = _update(model, tuple(names))
    values = [[*(_stored(field, row) for field in fields), _stored(_key(model), row), epoch] for row, epoch in rows]
    return Guarded(len(values), batch.ask_many(statement, values)) if values else Guarded(0)


def _stored(field: models.Field[Any, Any], row: models.Model) -> Any:
    return field.get_db_prep_save(getattr(row, field.attname), connection)


def _key(model: type[models.Model]) -> models.Field[Any, Any]:
    key = model._meta.pk
    assert key is not None
    return key


@cache
def _insert(model: type[models.Model]) -> tuple[Fields, str]:
    fields = tuple(field for field in model._meta.concrete_fields if not isinstance(field, models.AutoField))
    columns = ", ".join(f'"{field.column}"' for field in fields)
    return fields, f'INSERT INTO "{model._meta.db_table}" ({columns})'


@cache
def _update(model: type[models.Model], names: tuple[str, ...]) -> tuple[Fields, str]:
    by_name = {field.name: field for field in model._meta.concrete_fields}
    fields = tuple(by_name[name] for name in names)
    sets = ", ".join(f'"{field.column}" = %s' for field in fields)
    where = f'"{_key(model).column}" = %s AND epoch = %s'
    return fields, f'UPDATE "{model._meta.db_table}" SET {sets}, epoch = epoch + 1 WHERE {where}'  # noqa: S608 - as above
