"""The JSON that devices and the server exchange over MQTT, read with suspicion; see docs/protocol.md."""

from __future__ import annotations

import hashlib
import json
import re
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from math import isfinite
from typing import Any, Literal, cast, get_args

from vipo_device.protocol.description import DeviceState, Pose, Scalar
from vipo_device.protocol.errors import VipoError
from vipo_device.protocol.faults import JSON_SYNTAX, Fault, bare, facts_of, fault
from vipo_device.protocol.texts import normal_json, unfit_texts
from vipo_device.protocol.topics import STAND_IN_KINDS

AckStatus = Literal["ACCEPTED", "RUNNING", "DONE", "FAILED", "REJECTED", "CANCELED"]
CONTROLS = frozenset({"pause", "resume", "cancel"})
"""Methods that every device has, about another command; their argument `command` is its id."""
EXPLORE = "explore"
"""The method by which a robot maps a floor by itself: it drives where it likes."""
MAX_BYTES = 16 * 1024
MAX_DEPTH = 16
MAX_PROPERTIES = 64
MAX_TEXT = 256
MAX_WHOLE = 2**53
MAX_METRES = 1e6
MESSAGE = "The message"
_ID = re.compile(r"[A-Za-z0-9_.-]{1,64}")
_UNFIT = re.compile(r"[^A-Za-z0-9_.-]")
_JOIN = re.compile(r"vipo/v1/join/([a-zA-Z0-9_-]{1,64})/([^/+#]{1,256})")
_MARKS = r'"(?:[^"\\]|\\.)*+(?:"|\\?\Z)|[\[{]|[\]}]'
"""Texts and brackets. A text that nobody closes is one mark to the end: looked for anew from each quote in it, it would
cost the square of its length."""
_MARK = re.compile(_MARKS, re.DOTALL)
_TOKEN = re.compile(_MARKS + r'|[^\s,:"\[\]{}]+', re.DOTALL)
_COLON = re.compile(r"\s*:")
_UP = re.compile(r"vipo/v1/dev/([A-Za-z0-9_.-]{1,64})/up/([a-z]{1,16})")
_STAND_IN_UP = re.compile(rf"vipo/v1/sim/([A-Za-z0-9_.-]{{1,64}})/up/({'|'.join(STAND_IN_KINDS)})")
Voice = Literal["dev", "sim"]
"""Who speaks and is told as a device: the device itself, or its stand-in (docs/protocol.md)."""


class BadMessage(VipoError):
    """A message that does not fit the protocol; the sentence says where."""

    code = "bad_message"
    status = 422

    def __init__(self, reason: Fault | str) -> None:
        self.fault = reason if isinstance(reason, Fault) else bare(reason)
        super().__init__(self.fault.sentence, facts_of([self.fault]))


@dataclass(frozen=True, slots=True)
class Presence:
    """Whether a device is there; `boot` counts its starts."""

    online: bool
    boot: int


@dataclass(frozen=True, slots=True)
class AckMessage:
    """A device's answer to a command."""

    command: str
    status: AckStatus
    why: str = ""
    result: Mapping[str, Scalar] = field(default_factory=dict)

    @property
    def is_final(self) -> bool:
        """True when the command is over."""
        return is_final(self.status)


def is_final(status: AckStatus) -> bool:
    """Tell whether nothing comes after this answer."""
    return status not in {"ACCEPTED", "RUNNING"}


def is_device_id(text: str) -> bool:
    """Tell whether a device may be called so."""
    return _ID.fullmatch(text) is not None


def fit_device_id(plain: str, source: str, *, is_unambiguous: bool = True) -> str:
    """Return a device's id for a name of another world; a hash of `source` tells those apart that would look alike."""
    fit = _UNFIT.sub("-", plain)
    if fit == plain and is_unambiguous and len(fit) <= 64:
        return fit
    return f"{fit[:57]}-{hashlib.sha256(source.encode()).hexdigest()[:6]}"


def up_topic(device_id: str, kind: str, voice: Voice = "dev") -> str:
    """Return the topic on which a device speaks: `desc`, `presence`, `state`, `ack` or `map`."""
    return f"vipo/v1/{voice}/{device_id}/up/{kind}"


def down_topic(device_id: str, method: str, voice: Voice = "dev") -> str:
    """Return the topic on which a device, or its stand-in, is told to do something."""
    return f"vipo/v1/{voice}/{device_id}/down/{method}"


def read_up_topic(topic: str) -> tuple[str, str] | None:
    """Return (device id, kind) of an `up` topic, or None for any other."""
    found = _UP.fullmatch(topic)
    return (found.group(1), found.group(2)) if found else None


def read_stand_in_topic(topic: str) -> tuple[str, str] | None:
    """Return (device id, kind) of what a stand-in says, or None for any other topic."""
    found = _STAND_IN_UP.fullmatch(topic)
    return (found.group(1), found.group(2)) if found else None


def read_join_topic(topic: str) -> tuple[str, str] | None:
    """Return (site, id) of an enrolment's topic, or None for any other; the id may be one that no device can have."""
    found = _JOIN.fullmatch(topic)
    return (found.group(1), found.group(2)) if found else None


def parse_json(payload: bytes, *, max_bytes: int = MAX_BYTES, max_depth: int = MAX_DEPTH) -> Any:
    """Return the JSON value of a payload, its texts by the one rule and in their normal form.

    Raises BadMessage for what no text may hold, and for all that two readers could understand differently.
    """
    value = parse_plain_json(payload, max_bytes=max_bytes, max_depth=max_depth)
    if next(unfit_texts(read := normal_json(value)), None):
        raise BadMessage(fault("json_no_text", it=MESSAGE))
    return read


def parse_plain_json(payload: bytes, *, max_bytes: int, max_depth: int) -> Any:
    """Return the JSON value of a payload with its texts as they came. Raises BadMessage."""
    if len(payload) > max_bytes:
        raise BadMessage(fault("too_many_bytes", it=MESSAGE, bytes=len(payload), most=max_bytes))
    try:
        text = payload.decode("utf-8")
    except UnicodeDecodeError as error:
        raise BadMessage(fault("not_utf8", it=MESSAGE)) from error
    _check_depth(text, max_depth)
    try:
        value = json.loads(
            text, object_pairs_hook=_unique, parse_constant=_no_constant, parse_float=_finite, parse_int=_whole
        )
    except json.JSONDecodeError as error:
        code = next((code for words, code in JSON_SYNTAX.items() if error.msg.startswith(words)), "json_unclear")
        raise BadMessage(fault(code, error.lineno, error.colno, it=MESSAGE, reason=error.msg.lower())) from error
    except _Refused as error:
        raise BadMessage(_with_place(text, error.code, error.said)) from error
    return value


class _Refused(Exception):
    """Something that Python's reader takes and two readers could understand differently."""

    def __init__(self, code: str, said: str) -> None:
        self.code, self.said = code, said


def _with_place(text: str, code: str, said: str) -> Fault:
    """Say where what is refused stands: the first such number, or the key when an object has it for the second time."""
    at = _second_key(text, said) if code == "json_twice" else _first_number(text, said)
    line, column = (text.count("\n", 0, at) + 1, at - text.rfind("\n", 0, at)) if at >= 0 else (0, 0)
    return fault(code, line, column, it=MESSAGE, **{"key" if code == "json_twice" else "value": said[:64]})


def _first_number(text: str, said: str) -> int:
    tokens = _TOKEN.finditer(text)
    return next((found.start() for found in tokens if found.group() == said), -1)


def _second_key(text: str, key: str) -> int:
    """Return where an object has a key for the second time, -1 where that cannot be told."""
    counts: list[int] = []
    for found in _TOKEN.finditer(text):
        mark = found.group()
        if mark in "[{":
            counts.append(0)
        elif mark in "]}":
            counts.pop()
        elif mark.startswith('"') and counts and _COLON.match(text, found.end()) and json.loads(mark) == key:
            counts[-1] += 1
            if counts[-1] > 1:
                return found.start()
    return -1


def _check_depth(text: str, most: int) -> None:
    depth = 0
    for found in _MARK.finditer(text):
        mark = found.group()[0]
        depth += (mark in "[{") - (mark in "]}")
        if depth > most:
            raise BadMessage(fault("json_deep", it=MESSAGE, most=most))


def _unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) != len(pairs):
        raise _Refused("json_twice", Counter(name for name, _ in pairs).most_common(1)[0][0])
    return found


def _no_constant(name: str) -> Any:
    raise _Refused("json_constant", name)


def _finite(text: str) -> float:
    number = float(text)
    if not isfinite(number):
        raise _Refused("json_large", text)
    return number


def _whole(text: str) -> int:
    if len(text) > 17 or abs(int(text)) > MAX_WHOLE:
        raise _Refused("json_large", text)
    return int(text)


def parse_presence(payload: bytes) -> Presence:
    """Read `{"s": "online", "boot": 7}`."""
    fields = _object(parse_json(payload))
    said = fields.get("s")
    if said not in ("online", "offline"):
        raise BadMessage(fault("presence_said"))
    return Presence(said == "online", _count(fields, "boot"))


def parse_state(payload: bytes) -> DeviceState:
    """Read `{"boot", "seq", "done", "cmd"?, "loc"?: [x, y, z, theta], "props"?: {…}}`."""
    fields = _object(parse_json(payload))
    done = fields.get("done")
    if not isinstance(done, bool):
        raise BadMessage(fault("state_done"))
    return DeviceState(
        boot=_count(fields, "boot"),
        seq=_count(fields, "seq"),
        done=done,
        pose=_location(fields.get("loc")),
        command=_text(fields, "cmd", 64),
        properties=_scalars(fields.get("props"), "props"),
    )


def parse_ack(payload: bytes) -> AckMessage:
    """Read `{"id", "st", "why"?, "result"?: {…}}`."""
    fields = _object(parse_json(payload))
    command, status = _text(fields, "id", 64), fields.get("st")
    if not command:
        raise BadMessage(fault("answer_id"))
    if status not in get_args(AckStatus):
        raise BadMessage(fault("answer_status", choices=", ".join(get_args(AckStatus))))
    return AckMessage(
        command, cast("AckStatus", status), _text(fields, "why", MAX_TEXT), _scalars(fields.get("result"), "result")
    )


def _object(value: Any) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise BadMessage(fault("no_object", it=MESSAGE))
    return value


def _count(fields: dict[str, Any], name: str) -> int:
    value = fields.get(name)
    if not isinstance(value, int) or isinstance(value, bool) or value < 0:
        raise BadMessage(fault("need_count", key=name))
    return value


def _text(fields: dict[str, Any], name: str, longest: int) -> str:
    value = fields.get(name)
    if value is None:
        return ""
    if not isinstance(value, str) or len(value) > longest:
        raise BadMessage(fault("text_length", key=name, most=longest))
    return value


def _location(value: Any) -> Pose | None:
    if value is None:
        return None
    if not isinstance(value, list) or len(value) not in (3, 4) or not all(_is_metres(v) for v in value):
        raise BadMessage(fault("state_location"))
    x, y, z, theta = (float(v) for v in (*value, 0.0)[:4])
    return Pose(x, y, z, theta)


def _is_metres(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) <= MAX_METRES


def _scalars(value: Any, name: str) -> dict[str, Scalar]:
    if value is None:
        return {}
    if not isinstance(value, dict) or len(value) > MAX_PROPERTIES:
        raise BadMessage(fault("many_values", key=name, most=MAX_PROPERTIES))
    for key, inner in value.items():
        if not 1 <= len(key) <= 64 or isinstance(inner, dict | list):
            raise BadMessage(fault("no_plain_value", key=name, name=key[:40]))
        if isinstance(inner, str) and len(inner) > MAX_TEXT:
            raise BadMessage(fault("value_length", key=name, most=MAX_TEXT, name=key))
    return value


def presence_payload(presence: Presence) -> bytes:
    """Write what parse_presence reads."""
    return _dump({"s": "online" if presence.online else "offline", "boot": presence.boot})


def state_payload(state: DeviceState) -> bytes:
    """Write what parse_state reads."""
    body: dict[str, Any] = {"boot": state.boot, "seq": state.seq, "done": state.done, "cmd": state.command}
    if state.pose:
        body["loc"] = [state.pose.x, state.pose.y, state.pose.z, state.pose.theta]
    return _dump({**body, "props": dict(state.properties)})


def ack_payload(ack: AckMessage) -> bytes:
    """Write what parse_ack reads."""
    return _dump({"id": ack.command, "st": ack.status, "why": ack.why, "result": dict(ack.result)})


def command_payload(command: str, arguments: Mapping[str, object], ttl_s: float, fence: int = 0) -> bytes:
    """Write a command: `{"id", "v": {…}, "ttl_s", "fence"?}`; there is no fence where a stop was never pressed."""
    body = {"id": command, "v": dict(arguments), "ttl_s": ttl_s}
    return _dump({**body, "fence": fence} if fence else body)


def _dump(body: Mapping[str, Any]) -> bytes:
    return json.dumps(body, ensure_ascii=False, separators=(",", ":"), allow_nan=False).encode()


@dataclass(frozen=True, slots=True)
class DeviceCommand:
    """A command as its device hears it: its id, the method, and the arguments by name."""

    id: str
    method: str
    arguments: Mapping[str, object]
    fence: int | None = None


@dataclass(frozen=True, slots=True)
class StopMessage:
    """A site's stop as devices hear it; None as `fence` where none was said."""

    active: bool
    fence: int | None = None


def read_command(method: str, payload: bytes) -> DeviceCommand | None:
    """Read `{"id", "v", "ttl_s", "fence"?}`; None when it is no command."""
    try:
        body = parse_json(payload)
    except BadMessage:
        return None
    command, arguments = (body.get("id"), body.get("v", {})) if isinstance(body, dict) else (None, None)
    if not isinstance(command, str) or not 0 < len(command) <= 64 or not is_device_id(method):
        return None
    return DeviceCommand(command, method, arguments, _fence(body)) if isinstance(arguments, dict) else None


def read_stop(payload: bytes) -> StopMessage:
    """Read a site's stop; what cannot be read stops, what is empty does not."""
    if not payload:
        return StopMessage(active=False)
    try:
        body = json.loads(payload)
    except (ValueError, RecursionError):
        return StopMessage(active=True)
    if not isinstance(body, dict):
        return StopMessage(active=True)
    return StopMessage(body.get("active") is not False, _fence(body))


def _fence(body: Mapping[str, Any]) -> int | None:
    said = body.get("fence")
    return said if isinstance(said, int) and not isinstance(said, bool) and 0 <= said <= MAX_WHOLE else None
