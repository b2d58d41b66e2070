"""The connectors as a Django app, for their commands."""

from django.apps import AppConfig


class ConnectorsConfig(AppConfig):
    """The connectors keep nothing in the database."""

    name = "connectors"
