"""What there can be alerts about; pure.

Each cause has a code, how bad it is, and a sentence; what nobody can foresee, such as a device's own words, follows it
as `why`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import timedelta
from typing import Any, Literal

from vipo_device.protocol.batteries import is_charge

Severity = Literal["info", "warning", "error"]
AlertCode = Literal[
    "offline_at_work",
    "offline",
    "error",
    "warning",
    "battery_low",
    "newcomer_waits",
    "description_refused",
    "messages_dropped",
    "messages_refused",
    "flapping",
    "wrong_key",
    "foreign_knock",
    "command_rejected",
    "command_failed",
    "command_timed_out",
    "became_slower",
    "became_faster",
]
SOON = timedelta(minutes=10)
LOW_BATTERY_PERCENT = 15.0


def is_battery_low(charge: object, unit: str) -> bool:
    """Tell whether a battery is low by what a device says of it, in the unit that its description has."""
    if isinstance(charge, bool) or not isinstance(charge, int | float):
        return False
    return is_charge(unit) and charge < LOW_BATTERY_PERCENT


@dataclass(frozen=True, slots=True)
class Cause:
    """What one code means.

    `quiet` is after how long without another one it is over by itself; None where something else ends it. `anew` is
    how long after somebody has seen it another one makes it unseen again. `role` is the least role that it concerns.
    """

    severity: Severity
    text: str
    quiet: timedelta | None = None
    anew: timedelta = timedelta(hours=1)
    role: Literal["viewer", "admin"] = "viewer"


CAUSES: Mapping[AlertCode, Cause] = {
    "offline_at_work": Cause("error", "It went offline while it was needed for work"),
    "offline": Cause("warning", "It has been offline for long"),
    "error": Cause("error", "It reports an error"),
    "warning": Cause("warning", "It reports a warning"),
    "battery_low": Cause("warning", "Its battery is low"),
    "newcomer_waits": Cause("info", "It has been waiting for approval for more than an hour", role="admin"),
    "description_refused": Cause("warning", "Its description was refused"),
    "messages_dropped": Cause("warning", "It sends too many messages; some were dropped", quiet=SOON),
    "messages_refused": Cause("warning", "Messages of it were refused", quiet=SOON),
    "flapping": Cause(
        "warning",
        "It comes and leaves all the time: its network is bad, or two connections with its id displace each other",
        quiet=SOON,
    ),
    "wrong_key": Cause(
        "warning", "Somebody tried to connect as this device with a wrong key", quiet=timedelta(hours=1)
    ),
    "foreign_knock": Cause("warning", "Somebody wanted to enrol as it with another key", quiet=timedelta(hours=1)),
    "command_rejected": Cause("warning", "It refused {method}", quiet=timedelta(days=1), anew=timedelta(minutes=1)),
    "command_failed": Cause("error", "It did not finish {method}", quiet=timedelta(days=1), anew=timedelta(minutes=1)),
    "command_timed_out": Cause(
        "error", "It did not answer {method} in time", quiet=timedelta(days=1), anew=timedelta(minutes=1)
    ),
    "became_slower": Cause("warning", "{method} takes it {percent} % longer than it used to", quiet=timedelta(days=7)),
    "became_faster": Cause("info", "{method} takes it {percent} % less time than it used to", quiet=timedelta(days=7)),
}


def sentence_of(code: AlertCode, args: Mapping[str, Any]) -> str:
    """Return an alert as an English sentence."""
    named = {"method": args.get("method", "a command"), "percent": args.get("percent", "some")}
    sentence = CAUSES[code].text.format_map(named)
    why = str(args.get("why", ""))
    return f"{sentence}: {why}" if why else f"{sentence}."
