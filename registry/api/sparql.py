"""SPARQL over HTTP, as the SPARQL 1.1 Protocol has it; queries only."""

from __future__ import annotations

from typing import Literal, get_args

from django.http import HttpRequest, HttpResponse
from django.http.request import MediaType
from ninja import Router

from registry import services
from registry.people.access import require
from registry.requests import sends, signed_in
from registry.sparql.queries import MOST_QUERY_CHARACTERS, BadQuery

router = Router(tags=["registry"])
ResultForm = Literal["json", "xml", "csv", "turtle", "n-triples", "json-ld"]
_ACCEPTED: dict[str, ResultForm] = {
    "application/sparql-results+json": "json",
    "application/json": "json",
    "text/turtle": "turtle",
    "application/sparql-results+xml": "xml",
    "application/xml": "xml",
    "text/csv": "csv",
    "application/n-triples": "n-triples",
    "application/ld+json": "json-ld",
}
_ELSEWHERE = ("default-graph-uri", "named-graph-uri")
"""Fields of the SPARQL Protocol that ask for other graphs, as FROM and FROM NAMED do."""
_SENDS = sends(*(name for name in _ACCEPTED if name not in ("application/json", "application/xml")))


@router.get("/sites/{slug}/sparql", openapi_extra=_SENDS)
def ask(request: HttpRequest, slug: str, query: str = "", format: ResultForm | None = None) -> HttpResponse:
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
        query, format = request.POST.get("query", ""), format or _form_of(request.POST.get("format", ""))
    else:
        raise BadQuery("Send the query as application/sparql-query, or as the field `query` of a form.")
    return _answer(request, slug, query, format)


def _form_of(named: str) -> ResultForm | None:
    found = next((form for form in get_args(ResultForm) if form == named), None)
    if named and found is None:
        raise BadQuery(f"There is no form {named[:40]!r}. Choose {', '.join(get_args(ResultForm))}.")
    return found


def _answer(request: HttpRequest, slug: str, query: str, form: ResultForm | None) -> HttpResponse:
    if any(name in given for name in _ELSEWHERE for given in (request.GET, request.POST)):
        raise BadQuery(f"{' and '.join(_ELSEWHERE)} are not allowed: a query is answered from this site alone.")
    person = signed_in(request).pk
    found = services.run_query(site=slug, query=query, forms=[form] if form else _accepted(request), person=person)
    headers = {"Vary": "Accept"}
    return HttpResponse(found.body, content_type=f"{found.media_type}; charset=utf-8", headers=headers)


def _accepted(request: HttpRequest) -> list[str]:
    """Return the forms that the header Accept names, the dearest first; none where any will do."""
    named = [MediaType(f"{wanted.main_type}/{wanted.sub_type}") for wanted in request.accepted_types]
    return list(dict.fromkeys(form for wanted in named for name, form in _ACCEPTED.items() if wanted.match(name)))
