"""The painting factory on a PostgreSQL that other threads and processes reach, too."""

import pytest

from tests.kit.databases import on_database
from vipo_site.settings import postgres


@pytest.fixture
def db(database_url, django_db_blocker):
    with django_db_blocker.unblock(), on_database(**postgres(database_url)):
        yield database_url
