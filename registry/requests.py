"""What requests say, how operations describe themselves, answers that are files, and parts of lists."""

from __future__ import annotations

from collections.abc import AsyncIterator, Iterator, Mapping
from typing import Annotated, Any
from unicodedata import category

from asgiref.sync import sync_to_async
from django.core.handlers.asgi import ASGIRequest
from django.http import HttpRequest, HttpResponse
from django.utils.http import content_disposition_header
from ninja import Field, Schema
from ninja.schema import DjangoGetter
from pydantic import AfterValidator, ConfigDict, GetCoreSchemaHandler, Strict, ValidationError, model_validator
from pydantic_core import CoreSchema, InitErrorDetails, PydanticCustomError, core_schema

from registry.bounds.pagination import MOST_AT_ONCE, Listed, Page
from registry.models import User
from vipo_device.protocol.texts import cleaned_json, normal, normal_json, refusal_of, unfit_texts

LOCATION = {
    "description": "The address of what was made.",
    "schema": {"type": "string", "format": "uri-reference"},
}
"""How the OpenAPI file describes the header `Location`."""


def sends(*content_types: str) -> dict[str, Any]:
    """Say in the OpenAPI file that a call answers with something else than JSON of a shape."""
    return {"responses": {200: {"content": {name: {"schema": {"type": _type_of(name)}} for name in content_types}}}}


def _type_of(content_type: str) -> str | list[str]:
    if content_type == "application/ld+json":
        return ["object", "array"]
    return "object" if content_type.endswith(("json", "yaml")) else "string"


_NOT_IN_NAMES = frozenset('"*/:;<>?\\|%')
_MOST_NAME = 150


def as_file(name: str) -> dict[str, str]:
    """Return the header that makes an answer a file of this name, as RFC 6266 writes it.

    What a header, a file system or a reader could stumble over becomes `_`: quotes, folders, signs that are not shown.
    """
    fit = "".join("_" if _is_unfit_in_name(sign) else sign for sign in name)
    value = content_disposition_header(as_attachment=True, filename=fit[-_MOST_NAME:].strip(" .") or "file")
    assert value is not None  # it is an attachment
    return {"Content-Disposition": value}


def file_response(content: bytes | str, name: str, content_type: str) -> HttpResponse:
    """Return an answer that browsers keep as a file of this name."""
    return HttpResponse(content, content_type=content_type, headers=as_file(name))


def one_by_one(request: HttpRequest, parts: Iterator[str]) -> Iterator[str] | AsyncIterator[str]:
    """Return the parts of a long answer so that each is made when the one before was sent.

    Django gathers a plain iterator whole before it sends anything, where it is served asynchronously.
    """
    return _made_elsewhere(parts) if isinstance(request, ASGIRequest) else parts


async def _made_elsewhere(parts: Iterator[str]) -> AsyncIterator[str]:
    following = sync_to_async(lambda: next(parts, None))
    while (part := await following()) is not None:
        yield part


def _is_unfit_in_name(sign: str) -> bool:
    return sign in _NOT_IN_NAMES or (category(sign)[0] in "CZ" and sign != " ")


def refuses(*statuses: int) -> dict[str, Any]:
    """Say in the OpenAPI file that a call may be refused with statuses that others are not."""
    return {"responses": {status: {} for status in statuses}}


def signed_in(request: HttpRequest) -> User:
    """Return who asks; the API lets nobody else through."""
    assert isinstance(request.user, User)
    return request.user


def origin_of(request: HttpRequest) -> str:
    """Return where somebody reached VIPO, such as `https://vipo.example/`."""
    return request.build_absolute_uri("/")


def link_to_next(request: HttpRequest, **changed: object) -> str:
    """Return the header Link that names the next page of a list: the same address with another place to go on from."""
    query = request.GET.copy()
    for name, value in changed.items():
        query[name] = str(value)
    return f'<{request.path}?{query.urlencode()}>; rel="next"'


class Unchecked:
    """`Annotated[Any, Unchecked(Shape)]` looks like `Shape` in the OpenAPI file and passes through as it is.

    Reading a rehearsal of 700 kB a second time would only cost time; tests hold such values against their shapes.
    """

    def __init__(self, shape: Any) -> None:
        self._shape = shape

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        """Return the shape for JSON, from which descriptions are made, and anything at all for Python's values."""
        return core_schema.json_or_python_schema(
            json_schema=handler.generate_schema(self._shape),
            python_schema=core_schema.any_schema(),
            serialization=core_schema.plain_serializer_function_ser_schema(_as_it_is),
        )


def _as_it_is(value: Any) -> Any:
    return value


class Repaired:
    """`Annotated[…, Repaired()]` in what is asked: texts are cleaned and not refused, as in a document on reading."""


class AsTyped:
    """`Annotated[str, AsTyped()]` in what is asked: a fit text stays as it came, as a password has to."""


class ReadLater:
    """`Annotated[str, ReadLater()]` in what is asked: what reads the text says itself what it cannot take."""


def _one_line(text: str) -> str:
    if refusal := refusal_of(text, is_line=True):
        raise PydanticCustomError("line", "This text {refusal}", {"refusal": refusal})
    return normal(text)


Line = Annotated[str, AfterValidator(_one_line)]
"""A text of one line, as names are; `Field(max_length=…)` says how long."""
Flag = Annotated[bool, Strict()]
"""True or false, and nothing that could be meant so."""
Number = Annotated[float, Strict(), Field(allow_inf_nan=False)]
"""A number, and no text or truth value that could be meant so."""


class Asked(Schema):
    """What a request says, the base of all of them: no field that is not named here, and texts by the one rule."""

    model_config = ConfigDict(extra="forbid")

    @model_validator(mode="before")
    @classmethod
    def _read_texts(cls, values: Any) -> Any:
        """Refuse texts that are none, and bring the others to their normal form."""
        said = values._obj if isinstance(values, DjangoGetter) else values
        if not isinstance(said, Mapping):
            return said
        marks = {field.alias or name: field.metadata for name, field in cls.model_fields.items()}
        return {name: _read_field(name, value, marks.get(name, [])) for name, value in said.items()}


def _read_field(name: str, value: Any, marks: list[Any]) -> Any:
    kinds = {type(mark) for mark in marks}
    if ReadLater in kinds:
        return value
    if Repaired in kinds:
        return cleaned_json(value)
    read = value if AsTyped in kinds else normal_json(value)
    for where, text in unfit_texts({name: read}):
        why = PydanticCustomError("text", "This text {refusal}", {"refusal": refusal_of(text)})
        raise ValidationError.from_exception_data("text", [InitErrorDetails(type=why, loc=where, input=None)])
    return read


class PartAsked(Asked):
    """Which part of a long list is asked for; `before` is as the header `Link` of the part before it names it."""

    limit: int = Field(MOST_AT_ONCE, ge=1, le=MOST_AT_ONCE)
    before: str = Field("", max_length=500)

    def page(self) -> Page:
        """Return the page that is meant."""
        return Page(self.limit, self.before)


def tell_rest(request: HttpRequest, response: HttpResponse, listed: Listed[Any]) -> list[Any]:
    """Return a page of a list for its answer, whose header `Link` names the next one, if there is one."""
    if listed.rest:
        response["Link"] = link_to_next(request, before=listed.rest)
    return list(listed)
