"""`vipo call`: tell a device to do something, wait for what comes of it, and say so."""

from __future__ import annotations

import argparse
import getpass
import json
import time
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime, timedelta
from typing import TYPE_CHECKING, Any

from vipo_device.protocol.faults import printable
from vipo_site.cli.terminal import CLEAN, FAULTY, Unusable, complain, set_up, write, write_json

if TYPE_CHECKING:
    from execution.services import CallView

POLL_S = 0.2
GRACE = timedelta(seconds=3)
"""So much later than VIPO itself a call is given up here."""
NEVER_SENT = "It was never sent. Look whether VIPO and its gateway run."
WHAT = "Tell a device to carry out one of its methods, and wait until it is done."


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Describe what stands behind `vipo call`."""
    sub.add_argument("device", help="the device's id")
    sub.add_argument("method", help="one of its methods")
    sub.add_argument("args", nargs="*", metavar="NAME=VALUE", help="its arguments, or all of them as one JSON object")
    sub.add_argument("--site", default="", help="the device's site; a device of another site is refused")
    sub.add_argument("--json", action="store_true", help="write the whole call as JSON")
    sub.set_defaults(run=call_device)


def call_device(options: argparse.Namespace) -> int:
    """Call and wait; return 0 when it is done, 1 when it is not.

    Raises:
        Unusable, VipoError: it cannot be asked for.
    """
    set_up()
    # Django has to be set up before models can be imported
    from execution.services import call_to_json

    try:
        call = _call(options)
    except ValueError as error:
        raise Unusable(str(error), "bad_arguments") from error
    if options.json:
        write_json(call_to_json(call))
    else:
        write(_in_words(call))
    return CLEAN if call.status == "done" else FAULTY


def _call(options: argparse.Namespace) -> CallView:
    from execution import services as execution
    from registry import services as registry

    device = registry.find_device(device_id=options.device)
    if device is None or options.site not in {"", device.site}:
        where = f" at the site {options.site!r}" if options.site else ""
        raise Unusable(f"There is no device {options.device!r}{where}. Try: vipo devices", "not_found")
    method = device.canonical.method(options.method)
    types = {parameter.name: parameter.type for parameter in method.parameters} if method else {}
    arguments = read_arguments(options.args, types)
    call = execution.call_method(
        site=device.site,
        device_id=device.id,
        method=options.method,
        arguments=arguments,
        by=f"{_person()} (vipo)",
    )
    try:
        return _wait(device.site, call)
    except KeyboardInterrupt:
        cancel = f"POST /api/sites/{device.site}/calls/{call.id}/cancel"
        complain(f"{device.id} may go on with {options.method}. Its page can end that, and so can {cancel}.")
        raise


def _wait(site: str, call: CallView) -> CallView:
    """Return the call when it is over; it is given up in time even where nothing of VIPO runs that would do it."""
    from execution import services as execution

    given_up_at = call.expires_at + GRACE
    while not call.is_over:
        time.sleep(POLL_S)
        if datetime.now(UTC) > given_up_at:
            execution.expire_calls(now=datetime.now(UTC))
        call = execution.get_call(site=site, call_id=call.id)
    return call


def _person() -> str:
    try:
        return getpass.getuser()
    except (KeyError, OSError):  # a container may run as a number without a name
        return "somebody"


def read_arguments(words: Sequence[str], types: Mapping[str, str]) -> dict[str, Any]:
    """Return arguments out of `name=value` words, or of one JSON object. Raises ValueError."""
    if len(words) == 1 and words[0].lstrip().startswith("{"):
        return _json_object(words[0])
    found: dict[str, Any] = {}
    for word in words:
        name, equals, text = word.partition("=")
        if not equals or not name or name in found:
            raise ValueError(f"{word!r} is no argument. Write each once, as name=value.")
        found[name] = _value(name, text, types.get(name, "text"))
    return found


def _json_object(text: str) -> dict[str, Any]:
    try:
        body: dict[str, Any] = json.loads(text)
    except json.JSONDecodeError as error:
        raise ValueError(f"The arguments are not JSON: {error.msg.lower()}, column {error.colno}.") from error
    except RecursionError as error:
        raise ValueError("The arguments are nested too deep.") from error
    return body


def _value(name: str, text: str, type_name: str) -> Any:
    if type_name not in {"number", "boolean", "location"}:
        return text
    try:
        return json.loads(text)
    except (json.JSONDecodeError, RecursionError) as error:
        examples = {"number": "5 or 2.5", "boolean": "true or false", "location": "[3.2,-4.1]"}
        raise ValueError(f"{name}={text} is no {type_name}. Write {examples[type_name]}.") from error


def _in_words(call: CallView) -> str:
    result = "".join(f", {name} {value}" for name, value in call.result.items())
    sent = call.sent_at or call.status != "timed_out"
    why = f": {call.why if sent else NEVER_SENT}" if call.why else ""
    return printable(f"{call.device}: {call.method} is {call.status.replace('_', ' ')}{result}{why}")
