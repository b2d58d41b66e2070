"""The root of every refusal that a person may read; each app has a root of its own below it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


class VipoError(Exception):
    """A refusal: `code` for machines, `status` for HTTP, the message says what is wrong and how to mend it.

    `retry_after_s` says when to come again, where load was why (429, 503). `facts` are what a screen says it from in
    another language.
    """

    code = "refused"
    status = 400
    retry_after_s = 5

    def __init__(self, detail: str, facts: Mapping[str, Any] | None = None) -> None:
        super().__init__(detail)
        self.detail, self.facts = detail, facts or {}


class MqttError(VipoError):
    """The MQTT client cannot do what it was asked."""

    code = "mqtt"
    status = 503
