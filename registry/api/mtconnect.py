"""MTConnect over HTTP: probe, current and sample of a site or of one of its devices, for the site's members."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from django.http import HttpRequest, HttpResponse, StreamingHttpResponse
from django.utils import timezone
from ninja import Field, Query, Router, Schema

from registry.mtconnect import agent as mtconnect_agent
from registry.mtconnect import streams
from registry.mtconnect.agent import AgentError, Answer, Question
from registry.mtconnect.documents import Agent, ErrorCode, write_error
from registry.mtconnect.streams import Listener
from registry.people.access import require
from registry.people.sessions import session_of
from registry.requests import signed_in

router = Router(tags=["mtconnect"])
XML, STREAM = "application/xml", "multipart/x-mixed-replace"
_TEXT: dict[str, Any] = {"schema": {"type": "string"}}
_ERRORS: dict[int, Any] = {status: {"content": {XML: _TEXT}} for status in (400, 404, 429)}
_SENDS: dict[str, Any] = {"responses": {200: {"content": {XML: _TEXT}}, **_ERRORS}}
_STREAMS: dict[str, Any] = {"responses": {200: {"content": {XML: _TEXT, STREAM: _TEXT}}, **_ERRORS}}
_STATUS: dict[ErrorCode, int] = {"NO_DEVICE": 404, "TOO_MANY": 429}
Write = Callable[[Agent, Question], Answer]


class CurrentAsked(Schema):
    """Which items, and of when: texts, since what cannot be read is answered with an MTConnect error."""

    path: str | None = None
    at: str | None = None
    interval: str | None = None


class SampleAsked(Schema):
    """Which observations: texts, since what cannot be read is answered with an MTConnect error."""

    path: str | None = None
    begin: str | None = Field(None, alias="from")
    count: str | None = None
    interval: str | None = None
    heartbeat: str | None = None


@router.get("/sites/{slug}/mtconnect/probe", openapi_extra=_SENDS)
def probe(request: HttpRequest, slug: str) -> HttpResponse:
    """Send MTConnectDevices: the site's approved devices and what they tell."""
    return _probe(request, slug, "")


@router.get("/sites/{slug}/mtconnect/current", openapi_extra=_STREAMS)
def current(request: HttpRequest, slug: str, asked: Query[CurrentAsked]) -> Any:
    """Send MTConnectStreams: how the devices are; with `at` how they were, with `interval` again and again."""
    return _current(request, slug, "", asked)


@router.get("/sites/{slug}/mtconnect/sample", openapi_extra=_STREAMS)
def sample(request: HttpRequest, slug: str, asked: Query[SampleAsked]) -> Any:
    """Send MTConnectStreams: what the devices have said, from the sequence number `from` on, `count` at most."""
    return _sample(request, slug, "", asked)


@router.get("/sites/{slug}/mtconnect/{device}/probe", openapi_extra=_SENDS)
def probe_device(request: HttpRequest, slug: str, device: str) -> HttpResponse:
    """Send MTConnectDevices of one device, named by its id or uuid."""
    return _probe(request, slug, device)


@router.get("/sites/{slug}/mtconnect/{device}/current", openapi_extra=_STREAMS)
def current_of_device(request: HttpRequest, slug: str, device: str, asked: Query[CurrentAsked]) -> Any:
    """Send MTConnectStreams of one device: how it is."""
    return _current(request, slug, device, asked)


@router.get("/sites/{slug}/mtconnect/{device}/sample", openapi_extra=_STREAMS)
def sample_of_device(request: HttpRequest, slug: str, device: str, asked: Query[SampleAsked]) -> Any:
    """Send MTConnectStreams of one device: what it has said."""
    return _sample(request, slug, device, asked)


def _probe(request: HttpRequest, slug: str, device: str) -> HttpResponse:
    return _answer(request, slug, mtconnect_agent.probe_site, Question(device))


def _current(request: HttpRequest, slug: str, device: str, asked: CurrentAsked) -> Any:
    question = Question(device, asked.path, at=asked.at)
    if asked.interval is None:
        return _answer(request, slug, mtconnect_agent.current_of_site, question)
    require(signed_in(request), slug, "viewer")
    listener = Listener(session_of(request), slug, mtconnect_agent.current_of_site, question, is_sample=False)
    return _stream(listener, asked.interval, None)


def _sample(request: HttpRequest, slug: str, device: str, asked: SampleAsked) -> Any:
    question = Question(device, asked.path, asked.begin, asked.count)
    if asked.interval is None:
        return _answer(request, slug, mtconnect_agent.sample_of_site, question)
    require(signed_in(request), slug, "viewer")
    listener = Listener(session_of(request), slug, mtconnect_agent.sample_of_site, question, is_sample=True)
    return _stream(listener, asked.interval, asked.heartbeat)


def _answer(request: HttpRequest, slug: str, write: Write, question: Question) -> HttpResponse:
    require(signed_in(request), slug, "viewer")
    agent = mtconnect_agent.agent_of(site=slug, now=timezone.now())
    try:
        return HttpResponse(write(agent, question).document, content_type=XML)
    except AgentError as error:
        return _refusal(agent, error)


def _stream(listener: Listener, interval: str, heartbeat: str | None) -> HttpResponse | StreamingHttpResponse:
    agent = mtconnect_agent.agent_of(site=listener.site, now=timezone.now())
    try:
        rhythm = streams.read_rhythm(listener.question, interval, heartbeat)
        streams.check_room(listener)
        first = listener.write(agent, listener.question)
    except AgentError as error:
        return _refusal(agent, error)
    parts = streams.stream_documents(listener, rhythm, first)
    response = StreamingHttpResponse(parts, content_type=streams.MEDIA_TYPE)
    response["Cache-Control"] = "no-store"
    response["X-Accel-Buffering"] = "no"
    return response


def _refusal(agent: Agent, error: AgentError) -> HttpResponse:
    document = write_error(agent, error.code, error.sentence)
    return HttpResponse(document, content_type=XML, status=_STATUS.get(error.code, 400))
