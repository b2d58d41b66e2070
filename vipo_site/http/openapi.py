"""The API described in OpenAPI, with the refusals that every call may give."""

from __future__ import annotations

import functools
import json
from collections.abc import Callable
from functools import cached_property
from http import HTTPStatus
from typing import Any

from django.http import HttpRequest
from ninja import NinjaAPI, Schema
from ninja.errors import ValidationError
from ninja.openapi.schema import OpenAPISchema
from ninja.operation import Operation

from vipo_site.http.location_header import describe_address


class FieldProblem(Schema):
    """A field of the request that does not fit, and why."""

    field: str
    message: str


class Problem(Schema):
    """A refusal (RFC 9457): `detail` is a sentence for people, `code` is for programs, `args` for other languages."""

    type: str
    title: str
    status: int
    detail: str
    code: str
    fields: list[FieldProblem] = []
    args: dict[str, Any] = {}


_KEY = {
    "name": "Idempotency-Key",
    "in": "header",
    "required": False,
    "description": "Of requests with the same key one is carried out; the others are given its answer.",
    "schema": {"type": "string", "minLength": 1, "maxLength": 257},
}


_REFUSALS = {
    400: "It cannot be read.",
    401: "Nobody is signed in, or the token is not valid.",
    403: "The role or the token's scope does not suffice, or X-CSRFToken is missing.",
    404: "It does not exist, or the asker is no member of its site.",
    409: "Not in the state that things are in.",
    410: "It was there, and is over.",
    412: "It is not any more what the asker knows (If-Match).",
    413: "It is longer than it may be.",
    415: "Its content type is not one that is taken here.",
    422: "The request does not fit; `fields` says which part of it, and why.",
    428: "The header If-Match is missing.",
    429: "Too much at once: wait as long as the header Retry-After says.",
    500: "A fault of VIPO's own.",
    501: "The standard knows it, and VIPO does not offer it.",
    503: "What it takes is away; nothing was changed.",
}
"""What calls are refused with; `default` says how any other refusal would be told."""
_RARE = (410, 412, 413, 415, 428, 501)
"""Only of calls that say so themselves (`refuses`)."""


def _refused(path: str, method: str, call: dict[str, Any]) -> list[int]:
    """Return the statuses with which a call may be refused, by what it asks for."""
    names = {each["name"] for each in call.get("parameters", ())}
    holds = {
        401: "security" in call or call["operationId"] == "sign_in",
        403: "security" in call or method != "get",
        404: "{" in path or "site" in names,
        409: method != "get",
        **dict.fromkeys(_RARE, False),
    }
    return [status for status in _REFUSALS if holds.get(status, True) or status in call["responses"]]


def _refusals_of(path: str, method: str, call: dict[str, Any], refusal: dict[str, Any]) -> dict[int, Any]:
    """Return how a call's refusals look; some calls tell them in a form of their own, too."""
    told = {}
    for status in _refused(path, method, call):
        own = call["responses"].get(status, {}).get("content")
        shared = {"$ref": f"#/components/responses/Refused{status}"}
        both = {"description": _REFUSALS[status], "content": {**refusal["content"], **(own or {})}}
        told[status] = both if own else shared
    return told


_READ_ELSEWHERE = dict.fromkeys(("ask", "post_query"), ("default-graph-uri", "named-graph-uri"))
"""Names in addresses that a call knows without taking them: it says itself why not."""


class DescribedAPI(NinjaAPI):
    """An API whose description also says what refusals look like, and names calls whatever module they stand in.

    What an address may say after its `?` is what the description names; a call is told of any other name.
    """

    @cached_property
    def query_names(self) -> dict[str, frozenset[str]]:
        """What may stand after the `?` of each call's address."""
        calls = [call for methods in self.get_openapi_schema()["paths"].values() for call in methods.values()]
        return {
            call["operationId"]: frozenset(
                [each["name"] for each in call.get("parameters", ()) if each["in"] == "query"]
            ).union(_READ_ELSEWHERE.get(call["operationId"], ()))
            for call in calls
        }

    def refuse_unknown_names(self, call: Callable[..., Any]) -> Callable[..., Any]:
        """Let a call be carried out if it knows every name in its address; goes around the call's own function."""

        @functools.wraps(call)
        def call_if_known(request: HttpRequest, *args: Any, **values: Any) -> Any:
            known = self.query_names.get(call.__name__, frozenset())
            if unknown := sorted(request.GET.keys() - known):
                may = f"known are {', '.join(sorted(known))}" if known else "the address takes none"
                why = f"There is no such name here; {may}."
                raise ValidationError([{"loc": ("query", name[:64]), "msg": why} for name in unknown[:20]])
            return call(request, *args, **values)

        return call_if_known

    def get_openapi_operation_id(self, operation: Operation) -> str:
        """Return the name of the call's function, by which programs made from the description call it."""
        return operation.view_func.__name__

    def get_openapi_schema(self, **options: Any) -> OpenAPISchema:
        """Return the description; every call has the refusal as its default answer."""
        schema = super().get_openapi_schema(**options)
        problem = Problem.model_json_schema(mode="serialization", ref_template="#/components/schemas/{model}")
        schema.schemas.update(problem.pop("$defs"))
        schema.schemas["Problem"] = problem
        refusal = {
            "description": "A refusal",
            "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}},
        }
        schema["components"]["responses"] = {
            f"Refused{status}": {**refusal, "description": why} for status, why in _REFUSALS.items()
        }
        for path, methods in schema["paths"].items():
            for method, call in methods.items():
                describe_address(call)
                call["responses"].update(_refusals_of(path, method, call, refusal), default=refusal)
                if method != "get" and "security" in call:
                    call["parameters"] = [*call.get("parameters", []), _KEY]
        return schema


def describe(api: NinjaAPI) -> str:
    """Return the API's OpenAPI file: the same bytes for the same API."""
    schema = json.loads(json.dumps(api.get_openapi_schema(path_prefix="api/"), default=_plain))
    for part in ("paths", "components"):
        schema[part] = _untitled(schema[part])
    return json.dumps(schema, indent=1, sort_keys=True, ensure_ascii=False) + "\n"


def _untitled(value: Any) -> Any:
    """Leave out the titles, which only repeat names; a property that is called `title` is no text and stays."""
    if isinstance(value, dict):
        return {k: _untitled(v) for k, v in value.items() if not (k == "title" and isinstance(v, str))}
    return [_untitled(item) for item in value] if isinstance(value, list) else value


def _plain(value: object) -> object:
    if isinstance(value, HTTPStatus):
        return int(value)
    raise TypeError(f"{value!r} cannot stand in an OpenAPI file")
