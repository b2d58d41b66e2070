"""What the HTTP APIs of all apps share: who asks, what a call sends, and the shapes of the registry's own answers.

The frontend's types are made from the shapes.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from django.http import HttpRequest, HttpResponse
from ninja import Field, Schema
from ninja.schema import DjangoGetter
from pydantic import AfterValidator, ConfigDict, GetCoreSchemaHandler, Strict, ValidationError, model_validator
from pydantic_core import CoreSchema, InitErrorDetails, PydanticCustomError, core_schema

from registry.bounds.parts import MOST_AT_ONCE, Listed, Part
from registry.devices.views import Status
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


def refuses(*statuses: int) -> dict[str, Any]:
    """Say in the OpenAPI file that a call may be refused with statuses that others are not."""
    return {"responses": {status: {} for status in statuses}}


def signed_in(request: HttpRequest) -> User:
    """Return who asks; the API lets nobody else through."""
    assert isinstance(request.user, User)
    return request.user


def link_to_next(request: HttpRequest, **changed: object) -> str:
    """Return the header Link that names the next part of a list: the same address with another place to go on from."""
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

    def part(self) -> Part:
        """Return the part that is meant."""
        return Part(self.limit, self.before)


def tell_rest(request: HttpRequest, response: HttpResponse, listed: Listed[Any]) -> list[Any]:
    """Return a part of a list for its answer, whose header `Link` names the next one, if there is one."""
    if listed.rest:
        response["Link"] = link_to_next(request, before=listed.rest)
    return list(listed)


Role = Literal["viewer", "commenter", "operator", "author", "admin"]
Kind = Literal["robot", "machine"]
Lifecycle = Literal["pending", "approved", "retired"]
Reading = Annotated[Any, Unchecked(bool | int | float | str | None)]


class Person(Schema):
    """Somebody who is signed in."""

    id: int
    name: str
    initials: str
    email: str


class DemoAccount(Schema):
    """An account that the demo shows on its sign-in page."""

    email: str
    password: str
    role: Role


class Me(Schema):
    """Who asks, whether they may make a site, and what their next request needs."""

    user: Person | None
    may_create_sites: bool
    csrf: str
    demo_accounts: list[DemoAccount]


class SignIn(Asked):
    """What somebody signs in with."""

    email: Line = Field(max_length=254)
    password: Annotated[str, AsTyped()] = Field(max_length=1000)
    code: Line = Field("", max_length=40, description="Of an authenticator app, or a recovery code.")


class NewPassword(Asked):
    """The password that somebody has, and the one that they want."""

    old: Annotated[str, AsTyped()] = Field(max_length=1000)
    new: Annotated[str, AsTyped()] = Field(max_length=1000)


class Stop(Schema):
    """The latched stop of a site."""

    active: bool
    by: str
    at: str | None


class SiteShape(Schema):
    """A site as its member sees it; `held_role` is what they are once they have the second factor that it demands."""

    slug: str
    name: str
    role: Role
    machines: int
    robots: int
    online: int
    pending: int
    has_map: bool
    stop: Stop
    simulated: bool
    held_role: Role | None


class Origin(Schema):
    """Where the grid's bottom left corner is, in metres and radians."""

    x: float
    y: float
    yaw: float


class PlaceShape(Schema):
    """A named place; `label` is where its name is written, if not beside it."""

    id: str
    name: str
    kind: str
    x: float
    y: float
    theta: float
    label: tuple[float, float] | None


ZoneRule = Literal["keep_out", "slow", "one_at_a_time"]


class SiteZoneShape(Schema):
    """A zone of a site: corners in metres in the map frame; `speed_m_s` is how fast one may drive where it is slow."""

    id: str
    name: str
    rule: ZoneRule
    points: list[tuple[float, float]]
    speed_m_s: float | None


class MapShape(Schema):
    """A site's map without its cells."""

    version: int
    width: int
    height: int
    resolution_m: float
    origin: Origin
    places: list[PlaceShape]
    zones: list[SiteZoneShape]
    walls: list[tuple[float, float, float, float]]


class PoseShape(Schema):
    """Metres and radians in the map frame."""

    x: float
    y: float
    z: float = 0.0
    theta: float = 0.0


class SizeShape(Schema):
    """Metres."""

    x: float
    y: float
    z: float


class PropertyShape(Schema):
    """A reading and its last value."""

    name: str
    title: str
    type: str
    unit: str
    minimum: float | None
    maximum: float | None
    options: list[str]
    value: Reading


class ParameterShape(Schema):
    """An argument of a method."""

    name: str
    type: str
    unit: str
    minimum: float | None
    maximum: float | None
    options: list[str]
    required: bool


class MethodShape(Schema):
    """Something a device can be told to do."""

    name: str
    title: str
    topic: str
    message_type: str
    parameters: list[ParameterShape]


class Activity(Schema):
    """What a device is doing, for screens in other languages; `args` by code as in registry/devices/activity.py."""

    code: str
    args: dict[str, Reading]


class DeviceShape(Schema):
    """A device as it is now."""

    id: str
    name: str
    kind: Kind
    device_class: str
    icon: str
    lifecycle: Lifecycle
    status: Status
    doing: str
    activity: Activity | None
    location: PoseShape
    size: SizeShape
    radius_m: float
    properties: list[PropertyShape]
    methods: list[MethodShape]
    asks: list[MethodShape]
    gives: list[str]
    takes: list[str]
    capacity: int
    carrying: dict[str, int]
    last_seen_at: str | None
    done: bool
    simulated: bool
    image: str
    description: str
    has_key: bool
    dropped: int


class ApprovedDevice(DeviceShape):
    """A device that was let in; `credential` is its new key, told this once, null where it keeps the one it has."""

    credential: str | None
    taken: bool


class NewCredential(Schema):
    """A device's new key, told this once; `taken` says whether the device has it already."""

    credential: str
    taken: bool


class ChangeShape(Schema):
    """A field of a description that changed: its JSON before and after, empty where it was or is not there."""

    path: str
    before: str
    after: str


class DeviceEventShape(Schema):
    """One line of a device's history; `code` and `args` are what it is said from in another language."""

    at: str
    kind: str
    text: str
    code: str
    args: dict[str, Any]
    by: str
    changes: list[ChangeShape]


class Topic(Asked):
    """A topic that a device asks for, exactly as it names it."""

    topic: Line = Field(max_length=200)


class StandsAt(Asked):
    """Where a device stands: metres and radians in the map frame."""

    x: Number
    y: Number
    z: Number = 0.0
    theta: Number = 0.0


class DeviceEdit(Asked):
    """What people may say of a device; fields that are left out stay."""

    name: Line | None = Field(None, max_length=100)
    location: StandsAt | None = None
