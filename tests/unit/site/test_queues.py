"""Each task has its queue, and nobody who works on runs does anything else."""

from __future__ import annotations

import yaml

from tests.kit import served
from tests.kit.files import ROOT
from vipo_site.celery import app, make_app


def queue_of(task: str) -> str:
    return str(app.amqp.router.route({}, task)["queue"].name)


def listens_to(command: list[str]) -> set[str]:
    return set(command[command.index("-Q") + 1].split(","))


def test_runs_and_rehearsals_have_queues_of_their_own_and_all_else_is_upkeep() -> None:
    app.loader.import_default_modules()
    queues = {name.removeprefix("execution.tasks."): queue_of(name) for name in app.tasks if "." in name}
    ours = {name: queue for name, queue in queues.items() if not name.startswith("celery.")}
    assert {queue for name, queue in queues.items() if name.startswith("celery.")} == {"upkeep"}
    assert ours.pop("rehearse") == "rehearsals"
    assert {ours.pop(name) for name in ("advance_run", "advance_site")} == {"runs"}
    assert set(ours.values()) <= {"runs", "upkeep"}
    assert queue_of("execution.tasks.drive_site") == "runs"
    assert queue_of("anything.else") == "upkeep"


def test_every_queue_has_a_worker_and_those_of_runs_do_nothing_else() -> None:
    services = yaml.safe_load((ROOT / "docker-compose.yml").read_text())["services"]
    commands = {name: each.get("command") or [] for name, each in services.items()}
    workers = {name: listens_to(command) for name, command in commands.items() if "celery" in command}
    assert workers == {"worker-1": {"runs"}, "worker-2": {"runs"}, "rehearsals": {"rehearsals", "upkeep"}}
    assert (listens_to(served.WORKER), listens_to(served.REHEARSALS)) == ({"runs"}, {"rehearsals", "upkeep"})


def test_a_second_application_of_a_process_has_the_same_tasks_and_is_not_the_one_that_sends() -> None:
    other = make_app()
    other.loader.import_default_modules()
    assert {name for name in other.tasks if name.startswith("execution.")} == {
        name for name in app.tasks if name.startswith("execution.")
    }
    assert app.amqp.queues is not other.amqp.queues
