"""SPARQL over HTTP, as the SPARQL 1.1 Protocol has it; queries only."""

from __future__ import annotations

from typing import Literal

from django.http import HttpRequest, HttpResponse
from ninja import Router

from registry import services
from registry.access import require
from registry.api import signed_in
from registry.sparql import MOST_QUERY_CHARACTERS, BadQuery

router = Router(tags=["registry"])
ResultForm = Literal["json", "csv", "turtle", "n-triples", "json-ld"]
_ACCEPTED: dict[str, ResultForm] = {
    "application/sparql-results+json": "json",
    "application/json": "json",
    "text/csv": "csv",
    "text/turtle": "turtle",
    "application/n-triples": "n-triples",
    "application/ld+json": "json-ld",
}
_CONTENT = {name: {"schema": {"type": "string"}} for name in _ACCEPTED if name != "application/json"}
_SENDS = {"responses": {200: {"content": _CONTENT}}}


@router.get("/sites/{slug}/sparql", openapi_extra=_SENDS)
def ask(request: HttpRequest, slug: str, query: str, format: ResultForm | None = None) -> HttpResponse:
    """Answer a SPARQL query over the site's descriptions; as `format`, or else the header Accept, says."""
    require(signed_in(request), slug, "viewer")
    return _answer(request, slug, query, format)


@router.post("/sites/{slug}/sparql", openapi_extra=_SENDS)
def post_query(request: HttpRequest, slug: str, format: ResultForm | None = None) -> HttpResponse:
    """Answer a query that comes as `application/sparql-query`, or as the field `query` of a form."""
    require(signed_in(request), slug, "viewer")
    if request.content_type == "application/sparql-query":
        if len(request.body) > 4 * MOST_QUERY_CHARACTERS:
            raise BadQuery(f"A query has 1 to {MOST_QUERY_CHARACTERS} characters.")
        query = request.body.decode("utf-8", errors="replace")
    elif request.content_type == "application/x-www-form-urlencoded":
        query = request.POST.get("query", "")
    else:
        raise BadQuery("Send the query as application/sparql-query, or as the field `query` of a form.")
    return _answer(request, slug, query, format)


def _answer(request: HttpRequest, slug: str, query: str, form: ResultForm | None) -> HttpResponse:
    found = services.run_query(site=slug, query=query, form=form or _accepted(request))
    return HttpResponse(found.body, content_type=f"{found.media_type}; charset=utf-8")


def _accepted(request: HttpRequest) -> str:
    """Return the first form of the header Accept that there is; empty where any will do."""
    named = (part.partition(";")[0].strip() for part in request.headers.get("Accept", "").split(","))
    return next((_ACCEPTED[name] for name in named if name in _ACCEPTED), "")
