"""MTConnect over HTTP: probe, current and sample of a site, for its members."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from django.http import HttpRequest, HttpResponse
from django.utils import timezone
from ninja import Field, Query, Router, Schema

from registry import mtconnect_agent
from registry.access import require
from registry.api import signed_in
from registry.mtconnect import Agent, write_error
from registry.mtconnect_agent import AgentError

router = Router(tags=["mtconnect"])
XML = "application/xml"
_SENDS: dict[str, Any] = {"responses": {200: {"content": {XML: {"schema": {"type": "string"}}}}}}


def _answer(request: HttpRequest, slug: str, write: Callable[[Agent], bytes]) -> HttpResponse:
    require(signed_in(request), slug, "viewer")
    agent = mtconnect_agent.agent_of(site=slug, now=timezone.now())
    try:
        return HttpResponse(write(agent), content_type=XML)
    except AgentError as error:
        status = 404 if error.code == "NO_DEVICE" else 400
        return HttpResponse(write_error(agent, error.code, error.sentence), content_type=XML, status=status)


@router.get("/sites/{slug}/mtconnect/probe", openapi_extra=_SENDS)
def probe(request: HttpRequest, slug: str) -> HttpResponse:
    """Send MTConnectDevices: the site's approved devices and what they tell."""
    return _answer(request, slug, lambda agent: mtconnect_agent.probe_site(agent=agent))


@router.get("/sites/{slug}/mtconnect/current", openapi_extra=_SENDS)
def current(request: HttpRequest, slug: str) -> HttpResponse:
    """Send MTConnectStreams: how the devices are."""
    return _answer(request, slug, lambda agent: mtconnect_agent.current_of_site(agent=agent))


class Asked(Schema):
    """Which observations: texts, since what is no number is answered with an MTConnect error."""

    begin: str | None = Field(None, alias="from")
    count: str | None = None
    interval: str | None = None


@router.get("/sites/{slug}/mtconnect/sample", openapi_extra=_SENDS)
def sample(request: HttpRequest, slug: str, asked: Query[Asked]) -> HttpResponse:
    """Send MTConnectStreams: what the devices have said, from the sequence number `from` on, `count` at most."""

    def write(agent: Agent) -> bytes:
        if asked.interval is not None:
            raise AgentError("UNSUPPORTED", "Streams with `interval` are not served. Ask again with `from`.")
        return mtconnect_agent.sample_of_site(agent=agent, begin=asked.begin, count=asked.count)

    return _answer(request, slug, write)
