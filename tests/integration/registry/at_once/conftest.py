"""A site on PostgreSQL, which other threads reach, too."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from pytest_django import DjangoDbBlocker

from registry import services
from tests.kit.databases import on_database
from tests.kit.sign_in import add_person
from tests.kit.sites import make_hall
from vipo_site.settings import postgres


@pytest.fixture
def url(database_url: str, django_db_blocker: DjangoDbBlocker) -> Iterator[str]:
    """A site of which there are two admins, on a PostgreSQL that other threads reach, too."""
    with django_db_blocker.unblock(), on_database(**postgres(database_url)):
        make_hall()
        services.set_member(site="hall", email=add_person("chief").email, role="admin")
        yield database_url
