"""The execution app."""

from django.apps import AppConfig


class ExecutionConfig(AppConfig):
    """Settings of the execution app."""

    name = "execution"
