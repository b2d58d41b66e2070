"""How many files and rooms the paths of docs/architecture.md go through, and how many transactions, as they run.

A file counts if a function of it is called on the path, a room is its folder; tests, Django and libraries do not count,
nor what was called only to prepare. What waits for a socket or a broker stands in `ENDS`, for it is not run here.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from types import FrameType
from typing import Any
from uuid import uuid4

from bench.flow import ROOT

OURS = ("vipo_device", "registry", "editor", "simulation", "execution")
ENDS = {
    "a description to the browser": (
        "vipo_device/protocol/mqtt_client.py",
        "execution/gateway/gateway.py",
        "registry/api/site_socket.py",
    ),
    "an edit to the script": (
        "editor/rooms/socket.py",
        "editor/rooms/member.py",
        "editor/rooms/yjs_protocol.py",
        "editor/rooms/room.py",
        "editor/rooms/runner.py",
        "editor/rooms/stream.py",
        "editor/rooms/compiled_form.py",
    ),
    "a rehearsal": ("execution/rehearsals/rehearsals.py",),
}


@contextmanager
def _files_called() -> Iterator[set[str]]:
    """Give the files of ours in which functions are called within the block, by their paths in the repository."""
    files: set[str] = set()

    def note(frame: FrameType, event: str, _argument: Any) -> None:
        path = frame.f_code.co_filename
        if event == "call" and path.startswith(str(ROOT)) and frame.f_code.co_name != "<module>":
            name = os.path.relpath(path, ROOT)
            if name.split("/")[0] in OURS:
                files.add(name)

    sys.setprofile(note)
    try:
        yield files
    finally:
        sys.setprofile(None)


def _figure(path: str, files: set[str], **more: object) -> dict[str, object]:
    from bench.figures import figure

    whole = files | set(ENDS.get(path, ()))
    rooms = {str(Path(name).parent) for name in whole}
    return figure(path, len(whole), "files", rooms=len(rooms), **more, names=sorted(whole))


def measure() -> Iterator[dict[str, object]]:
    """Count each path in a process and a database of its own."""
    for path in PATHS:
        with tempfile.TemporaryDirectory() as folder:
            environment = {**os.environ, "VIPO_STATE_DIR": folder, "VIPO_LOG": "ERROR", "VIPO_MODE": "embedded"}
            environment["DJANGO_SETTINGS_MODULE"] = "vipo_site.settings"
            command = [sys.executable, "-m", "bench.paths", path]
            done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError(done.stderr)
        yield json.loads(done.stdout.splitlines()[-1])


def _measure_here(path: str) -> dict[str, object]:
    import django

    django.setup()
    # Django has to be set up before models can be imported
    from django.core.management import call_command

    call_command("migrate", verbosity=0, interactive=False)
    return PATHS[path](path)


def _describe(path: str) -> dict[str, object]:
    """Let a known device describe itself anew, from the gateway's inbox to the news of the site."""
    from collections import Counter
    from threading import Event
    from unittest.mock import Mock

    from execution.gateway.ingest import Ingester
    from execution.gateway.queue import Entry, Inbox
    from registry import services
    from tests.kit.sites import MIXER, describe, hear_news, make_hall
    from vipo_device.descriptions.reader import write_description

    make_hall()
    describe()
    ingester, inbox = Ingester(Mock(), Counter()), Inbox()

    def say(name: str) -> None:
        message = Mock(payload=write_description(replace(MIXER, name=name)).encode(), retained=False)
        inbox.put(Entry(message, MIXER.id, "desc"))

    say("Warmed up")
    ingester.ingest_all(inbox.get_all(0, 10), Event())
    say("Mixer Two")
    with hear_news() as heard, _files_called() as files:
        ingester.ingest_all(inbox.get_all(0, 10), Event())
    if not heard or services.get_device(site="hall", device_id=MIXER.id).name != "Mixer Two":
        raise RuntimeError("The description did not arrive.")
    return _figure(path, files)


def _edit(path: str) -> dict[str, object]:
    """Change a step of a program that is open in a room, and check it as its runner does."""
    from bench.programs import make_program, with_step
    from editor import services
    from editor.language import compiled_to_json
    from editor.language.compiler import EditedProgram
    from editor.programs.checking import build_surroundings
    from editor.programs.compiled_patch import make_patch
    from tests.kit.sites import make_hall

    make_hall()
    before = make_program(40)
    services.create_program(site="hall", name="Edited", document=before)
    around, edited = build_surroundings(site="hall"), EditedProgram()
    first = compiled_to_json(edited.look(before, around).compiled(with_plan=False), 1)
    after = with_step(before, "s0", {**before["steps"]["s0"], "pos": [9, 9]})
    with _files_called() as files:
        form = compiled_to_json(edited.look(after, around).compiled(with_plan=False), 2)
        make_patch(first, form)
    return _figure(path, files)


def _command(path: str) -> dict[str, object]:
    """Let a machine answer that it is done, from the gateway to the run's next command as it goes out."""
    from collections import Counter
    from threading import Event
    from unittest.mock import Mock

    from django.db import connection
    from django.test.utils import CaptureQueriesContext

    from bench.hall import OVEN, SITE, fill_hall
    from editor.language import plan_to_json
    from editor.language.expressions.nodes import Constant, PlaceRef
    from editor.language.plan.instructions import Call, End, Instruction, Plan
    from execution import services
    from execution.engine.drive import advance_site
    from execution.gateway.ingest import Ingester
    from execution.gateway.queue import Entry

    heat = Call(PlaceRef(device=OVEN), "heat", {"value": Constant(1)})
    plan = Plan((*(Instruction(heat, step) for step in ("one", "two", "three")), Instruction(End())))
    fill_hall(3)
    prepared = services.Prepared(uuid4(), SITE, "Heating", 1, {}, {}, plan_to_json(plan), {})
    services.start_run(prepared=prepared, by="Ada")
    ingester = Ingester(Mock(), Counter())

    def go_on(last: tuple[services.OutgoingCommand, ...]) -> tuple[services.OutgoingCommand, ...]:
        for command in last:
            ack = json.dumps({"id": command.id, "st": "DONE"}).encode()
            ingester.ingest_all([Entry(Mock(payload=ack, retained=False), OVEN, "ack")], Event())
        advance_site(SITE)
        return services.claim_commands(limit=10)

    first = go_on(())
    second = go_on(first)
    with CaptureQueriesContext(connection) as asked, _files_called() as files:
        third = go_on(second)
    if not (len(first) == len(second) == len(third) == 1):
        raise RuntimeError("A command did not go out.")
    begun = sum(each["sql"].startswith("BEGIN") for each in asked.captured_queries)
    return _figure(path, files, transactions=begun)


def _rehearse(path: str) -> dict[str, object]:
    """Rehearse the smallest task, from the job as its process reads it to the result."""
    from editor.language import compile_document, plan_to_json
    from execution.rehearsals.child_process import run_job, scene_to_json
    from tests.kit import demo_floor
    from tests.kit.demo_site import factory
    from tests.kit.programs import TASK

    compiled = compile_document(TASK, factory())
    if compiled.plan is None:
        raise RuntimeError("The program is not sound.")
    scene = scene_to_json(demo_floor.scene(), demo_floor.places())
    job = {"plan": plan_to_json(compiled.plan), "scene": scene, "driver": "kinematic"}
    with _files_called() as files:
        result = run_job(job)
    if not result["ok"]:
        raise RuntimeError("The rehearsal did not end well.")
    return _figure(path, files)


PATHS: Mapping[str, Callable[[str], dict[str, object]]] = {
    "a description to the browser": _describe,
    "an edit to the script": _edit,
    "a command and its answer": _command,
    "a rehearsal": _rehearse,
}

if __name__ == "__main__":
    print(json.dumps(_measure_here(sys.argv[1])))
