"""MTConnect documents as agents write them, in the words of the standard's versions 1.2, 1.7 and 2.0."""

from __future__ import annotations

from collections.abc import Iterable

LATHE = """
<Device id="d1" name="Lathe" uuid="M8010-1">
  <Description manufacturer="Mazak" serialNumber="1">Turning centre</Description>
  <DataItems><DataItem category="EVENT" id="avail" type="AVAILABILITY"/></DataItems>
  <Components>
    <Axes id="a" name="base"><Components>
      <Linear id="x" name="X"><DataItems>
        <DataItem category="SAMPLE" id="xpos" name="Xact" type="POSITION" subType="ACTUAL" units="MILLIMETER"
            nativeUnits="INCH"/>
        <DataItem category="SAMPLE" id="xload" name="load" type="LOAD" units="PERCENT"/>
        <DataItem category="CONDITION" id="xcond" type="POSITION"/>
      </DataItems></Linear>
      <Linear id="z" name="Z"><DataItems>
        <DataItem category="SAMPLE" id="zload" name="load" type="LOAD" units="PERCENT"/>
      </DataItems></Linear>
    </Components></Axes>
    <Controller id="c" name="controller">
      <DataItems>
        <DataItem category="EVENT" id="estop" type="EMERGENCY_STOP"/>
        <DataItem category="CONDITION" id="system" type="SYSTEM"/>
      </DataItems>
      <Components><Path id="p" name="path"><DataItems>
        <DataItem category="EVENT" id="exec" name="execution" type="EXECUTION"/>
        <DataItem category="EVENT" id="prog" name="program" type="PROGRAM"/>
        <DataItem category="EVENT" id="parts" name="parts" type="PART_COUNT"/>
        <DataItem category="SAMPLE" id="place" name="tip" type="PATH_POSITION" units="MILLIMETER_3D"/>
        <DataItem category="SAMPLE" id="wave" type="WATTAGE" units="WATT" representation="TIME_SERIES"/>
        <DataItem category="EVENT" id="vars" type="VARIABLE" representation="DATA_SET"/>
      </DataItems></Path></Components>
    </Controller>
  </Components>
</Device>
"""
CONDITIONS = ("Normal", "Warning", "Fault", "Unavailable")
SAMPLES = {"xpos": "Position", "xload": "Load", "zload": "Load", "place": "PathPosition"}
EVENTS = {
    "avail": "Availability",
    "exec": "Execution",
    "prog": "Program",
    "parts": "PartCount",
    "estop": "EmergencyStop",
}


def header(instance: int = 1, first: int = 1, following: int = 1, size: int = 1000) -> str:
    numbers = f'firstSequence="{first}" lastSequence="{max(following - 1, 1)}" nextSequence="{following}"'
    return (
        f'<Header version="1.2" creationTime="2026-01-01T00:00:00Z" sender="test" instanceId="{instance}" '
        f'bufferSize="{size}" {numbers}/>'
    )


def document(kind: str, inner: str, *, version: str = "1.2", head: str | None = None) -> bytes:
    text = (
        f'<?xml version="1.0" encoding="UTF-8"?>\n<MTConnect{kind} xmlns="urn:mtconnect.org:MTConnect{kind}:{version}">'
    )
    return f"{text}{head or header()}{inner}</MTConnect{kind}>".encode()


def probe(*devices: str, instance: int = 1, version: str = "1.2") -> bytes:
    agent = '<Agent id="ag" name="Agent" uuid="agent"/>' if version > "1.6" else ""
    inner = f"<Devices>{agent}{''.join(devices or (LATHE,))}</Devices>"
    return document("Devices", inner, version=version, head=header(instance))


def told(item: str, text: str, number: int, *, level: str = "", code: str = "") -> str:
    """Return an observation's element; of a condition `level` is its name."""
    facts = f'dataItemId="{item}" timestamp="2026-01-01T00:00:00Z" sequence="{number}"'
    name = level or SAMPLES.get(item) or EVENTS.get(item, "Message")
    more = f' type="SYSTEM" nativeCode="{code}"' if code else ' type="SYSTEM"' if level else ""
    return f"<{name} {facts}{more}>{text}</{name}>"


def streams(*observations: str, head: str, version: str = "1.2", machine: str = "M8010-1") -> bytes:
    """Return MTConnectStreams; each kind of observation stands in its own part, as the schema wants it."""
    inner = "".join(f"<{part}>{''.join(some)}</{part}>" for part, some in _in_parts(observations) if some)
    stream = f'<ComponentStream component="Device" componentId="d1" name="Lathe">{inner}</ComponentStream>' * bool(
        inner
    )
    inner = f'<Streams><DeviceStream name="Lathe" uuid="{machine}">{stream}</DeviceStream></Streams>'
    return document("Streams", inner, version=version, head=head)


def _in_parts(observations: Iterable[str]) -> list[tuple[str, list[str]]]:
    parts: dict[str, list[str]] = {"Samples": [], "Events": [], "Condition": []}
    for text in observations:
        name = text[1:].split()[0]
        kind = "Condition" if name in CONDITIONS else "Samples" if name in SAMPLES.values() else "Events"
        parts[kind].append(text)
    return list(parts.items())


def refusal(code: str, *, instance: int = 1) -> bytes:
    return document("Error", f'<Errors><Error errorCode="{code}">No.</Error></Errors>', head=header(instance))
