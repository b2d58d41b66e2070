"""The editor app."""

from django.apps import AppConfig


class EditorConfig(AppConfig):
    """Settings of the editor app."""

    name = "editor"
