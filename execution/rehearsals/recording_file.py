"""A rehearsal as a file: JSON with all that is known of it, or MCAP, which tools for robots' recordings open; pure.

docs/simulation.md says what stands in either. In both, times are of the simulation: its beginning is 0.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from heapq import merge
from io import BytesIO
from math import ceil, cos, sin
from typing import Any, Final

from mcap.well_known import MessageEncoding, SchemaEncoding
from mcap.writer import CompressionType, Writer

from execution.rehearsals.views import RehearsalView, whole_rehearsal_to_json

FORMAT: Final = "vipo-rehearsal"
VERSION: Final = 1
MOST_POSES: Final = 100_000
"""More poses than these, of all robots, are thinned evenly: so a file takes a second or two to write."""
Message = tuple[float, str, dict[str, Any]]
"""Time (s), topic, content."""

_TIME: Final = {"type": "object", "properties": {"sec": {"type": "integer"}, "nsec": {"type": "integer"}}}


def _numbers(*names: str) -> dict[str, Any]:
    return {"type": "object", "properties": {name: {"type": "number"} for name in names}}


def _schema(**properties: Any) -> dict[str, Any]:
    return {"type": "object", "properties": properties}


_TEXT: Final = {"type": "string"}
_SCHEMAS: Final[Mapping[str, dict[str, Any]]] = {
    "foxglove.PoseInFrame": _schema(
        timestamp=_TIME,
        frame_id=_TEXT,
        pose=_schema(position=_numbers("x", "y", "z"), orientation=_numbers("x", "y", "z", "w")),
    ),
    "foxglove.Log": _schema(timestamp=_TIME, level={"type": "integer"}, message=_TEXT, name=_TEXT),
    "vipo.Carrying": _schema(objects={"type": "object", "additionalProperties": {"type": "integer"}}),
    "vipo.Busy": _schema(busy={"type": "boolean"}),
    "vipo.Reading": _schema(name=_TEXT, value={}),
    "vipo.Step": _schema(step=_TEXT, number=_TEXT, count={"type": "integer"}, status=_TEXT, robot=_TEXT, device=_TEXT),
    "vipo.Way": _schema(path={"type": "array", "items": {"type": "array", "items": {"type": "number"}}}),
    "vipo.Wait": _schema(duration_s={"type": "number"}, robot=_TEXT, reason=_TEXT),
    "vipo.Encounter": _schema(kind=_TEXT, a=_TEXT, b=_TEXT, distance_m={"type": "number"}, x={}, y={}),
    "vipo.Error": _schema(step=_TEXT, kind=_TEXT, message=_TEXT),
}
"""The two of foxglove are those that its tools draw without being told how."""
_KIND_OF: Final = {
    "pose": "foxglove.PoseInFrame", "carrying": "vipo.Carrying", "way": "vipo.Way", "busy": "vipo.Busy",
    "readings": "vipo.Reading", "steps": "vipo.Step", "waits": "vipo.Wait", "encounters": "vipo.Encounter",
    "errors": "vipo.Error", "log": "foxglove.Log",
}  # fmt: skip
"""The schema of a topic, by the last part of its name."""
_INFO, _ERROR = 2, 4
_MAP_FRAME: Final = "map"


def write_json(view: RehearsalView) -> bytes:
    """Return all that is known of a rehearsal, as JSON with a format and a version."""
    told = whole_rehearsal_to_json(view, None)
    for name in ("mine", "place", "progress", "course"):
        del told[name]
    return json.dumps({"format": FORMAT, "version": VERSION, "site": view.site, **told}, ensure_ascii=False).encode()


def write_mcap(view: RehearsalView) -> bytes:
    """Return the recording of a rehearsal that has a result as MCAP: messages in JSON, each with its schema."""
    stream = BytesIO()
    writer = Writer(stream, compression=CompressionType.ZSTD)
    writer.start(profile="", library=f"vipo {FORMAT} {VERSION}")
    writer.add_metadata(FORMAT, _facts(view))
    channels: dict[str, tuple[int, int]] = {}
    schemas: dict[str, int] = {}
    for t_s, topic, content in _messages(view.result or {}, view.compiled.get("numbers", {})):
        if topic not in channels:
            channels[topic] = (_register(writer, topic, schemas), 0)
        channel, sequence = channels[topic]
        channels[topic] = (channel, sequence + 1)
        at_ns = round(t_s * 1e9)
        data = json.dumps(content, ensure_ascii=False, separators=(",", ":")).encode()
        writer.add_message(channel, log_time=at_ns, publish_time=at_ns, sequence=sequence, data=data)
    writer.finish()  # type: ignore[no-untyped-call]  # theirs has no types
    return stream.getvalue()


def _facts(view: RehearsalView) -> dict[str, str]:
    """Return what is true of the whole of it; metadata of MCAP are texts."""
    result = view.result or {}
    facts = {
        "version": VERSION, "rehearsal": str(view.id), "program": str(view.program), "program_name": view.program_name,
        "site": view.site, "created_at": view.created_at.isoformat(), "ok": bool(result.get("ok")),
        "duration_s": result.get("duration_s", 0.0), "asked": dict(view.asked or {}),
    }  # fmt: skip
    return {name: value if isinstance(value, str) else json.dumps(value) for name, value in facts.items()}


def _register(writer: Writer, topic: str, schemas: dict[str, int]) -> int:
    name = _KIND_OF[topic.rsplit("/", 1)[1]]
    if name not in schemas:
        text = json.dumps({"title": name, **_SCHEMAS[name]}).encode()
        schemas[name] = writer.register_schema(name, SchemaEncoding.JSONSchema, text)
    return writer.register_channel(topic, MessageEncoding.JSON, schemas[name])


def _messages(result: Mapping[str, Any], numbers: Mapping[str, str]) -> Iterator[Message]:
    """Yield all that was recorded, oldest first."""
    if not result:
        return iter(())
    parts = [
        *_poses(result["frames"]),
        *([(t, f"/robots/{name}/carrying", {"objects": load}) for t, load in loads]
          for name, loads in result["carrying"].items()),
        *([(t, f"/machines/{name}/busy", {"busy": busy}) for t, busy in states]
          for name, states in result["machine_states"].items()),
        *([(t, f"/devices/{device}/readings", {"name": name, "value": value}) for t, name, value in values]
          for device, values in result["properties"].items()),
        [(way["t"], f"/robots/{way['robot']}/way", {"path": way["path"]}) for way in result["routes"]],
        _steps(result["steps"], numbers),
        [(wait["t"], "/waits", {name: wait[name] for name in ("duration_s", "robot", "reason")})
         for wait in result["waits"]],
        *([(met["t"], "/encounters", {"kind": kind, **{name: met[name] for name in ("a", "b", "distance_m", "x", "y")}})
           for met in result[kept]] for kept, kind in (("near_misses", "near_miss"), ("collisions", "collision"))),
        [(error["t"], "/errors", {name: error[name] for name in ("step", "kind", "message")})
         for error in result["errors"]],
        _log(result),
    ]  # fmt: skip
    ordered = (sorted(part, key=lambda message: message[0]) for part in parts)
    return merge(*ordered, key=lambda message: message[0])


def _poses(frames: Mapping[str, Any]) -> Iterator[list[Message]]:
    robots, dt_s = frames["robots"], frames["dt_s"]
    every = max(1, ceil(sum(len(poses) for poses in robots.values()) / MOST_POSES))
    for name, poses in robots.items():
        yield [
            (at * dt_s, f"/robots/{name}/pose", _pose(at * dt_s, *pose))
            for at, pose in enumerate(poses)
            if at % every == 0
        ]


def _pose(t_s: float, x: float, y: float, theta: float) -> dict[str, Any]:
    turned = {"x": 0.0, "y": 0.0, "z": round(sin(theta / 2), 6), "w": round(cos(theta / 2), 6)}
    pose = {"position": {"x": x, "y": y, "z": 0.0}, "orientation": turned}
    return {"timestamp": _time(t_s), "frame_id": _MAP_FRAME, "pose": pose}


def _time(t_s: float) -> dict[str, int]:
    sec, nsec = divmod(round(t_s * 1e9), 1_000_000_000)
    return {"sec": sec, "nsec": nsec}


def _steps(steps: list[dict[str, Any]], numbers: Mapping[str, str]) -> list[Message]:
    """A step is told when it begins and when it is over."""
    told: list[Message] = []
    for step in steps:
        same = {"step": step["step"], "number": numbers.get(step["step"], ""), "count": step["count"]}
        whose = {"robot": step["robot"], "device": step["device"]}
        told.append((step["started_s"], "/steps", {**same, "status": "running", **whose}))
        if step["ended_s"] is not None:
            told.append((step["ended_s"], "/steps", {**same, "status": step["status"], **whose}))
    return told


def _log(result: Mapping[str, Any]) -> list[Message]:
    wrong = {(error["t"], error["message"]) for error in result["errors"]}
    return [
        (line["t"], "/log", {"timestamp": _time(line["t"]), "message": line["text"], "name": line["device"],
                             "level": _ERROR if (line["t"], line["text"]) in wrong else _INFO})
        for line in result["log"]
    ]  # fmt: skip
