"""Measured paces: kept, read, taken over and given up by those who may, and used by rehearsals and tests."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from typing import Any
from uuid import uuid4

import pytest

from editor import services as editor
from execution.mirror.calibrations import find_paces
from execution.mirror.measurements import keep_job, list_of_run
from execution.mirror.paces import KEPT
from execution.models import Command, Measurement, Rehearsal
from execution.program_tests.site_digests import digests_of, what_changed
from execution.rehearsals.child_process import scene_from_json
from registry import services as registry
from registry.audit.queries import list_audit
from simulation.mirror.device_copy import Job, Measured
from tests.kit.programs import SITE, TASK
from tests.kit.sign_in import EVERYBODY, from_role, join_and_sign_in, post_json

pytestmark = pytest.mark.django_db(transaction=True)
OVEN, ROBOT = "curingOven01", "robot01"
AT = datetime(2026, 11, 26, 12, tzinfo=UTC)
PACES = f"/api/sites/{SITE}/devices/{OVEN}/paces"
CURE = f"{PACES}/curePaint"


def measure(pace: float, count: int = 1, *, device: str = OVEN, method: str = "curePaint", begin: int = 0) -> None:
    site = registry.get_site_id(site=SITE)
    for number in range(count):
        Measurement.objects.create(
            site_id=site, device=device, method=method, command=uuid4(), real_s=10 * pace, predicted_s=10,
            at=AT + timedelta(seconds=begin + number),
        )  # fmt: skip


def command(run: Any = None, step: str = "", method: str = "move", device: str = ROBOT) -> Command:
    return Command.objects.create(
        id=uuid4(), site_id=registry.get_site_id(site=SITE), position=Command.objects.count(), device=device,
        method=method, run=run, step=step, status="done", send_after=AT, created_at=AT,
    )  # fmt: skip


def measured(of: Command, real_s: float, predicted_s: float) -> Measured:
    return Measured(of.device, str(of.pk), of.method, real_s, predicted_s)


def test_the_pieces_of_a_move_are_one_measurement_and_a_job_is_kept_once(factory: Any) -> None:
    run = uuid4()
    pieces = [command(run, "fetch") for _ in range(3)]
    pick = command(run, "fetch", "pick")
    job = Job((*(measured(piece, 4, 3) for piece in pieces), measured(pick, 2, 2)), 0.4)
    for _ in range(2):
        keep_job(job=job, at=AT)
    assert list_of_run(run=run) == [
        {
            "step": "fetch",
            "device": ROBOT,
            "method": "move",
            "count": 1,
            "real_s": 12,
            "predicted_s": 9,
            "apart_m": 0.4,
        },
        {"step": "fetch", "device": ROBOT, "method": "pick", "count": 1, "real_s": 2, "predicted_s": 2, "apart_m": 0.4},
    ]


def test_a_step_that_is_done_again_and_again_is_one_line(factory: Any) -> None:
    run = uuid4()
    for _ in range(KEPT + 5):
        keep_job(job=Job((measured(command(run, "fetch"), 4, 3),), None), at=AT)
    (line,) = list_of_run(run=run)
    assert (line["count"], line["real_s"], line["predicted_s"]) == (KEPT, 4 * KEPT, 3 * KEPT)


def test_what_is_too_short_or_of_nobody_is_not_kept(factory: Any) -> None:
    known = command()
    short, gone = measured(known, 0.1, 0.1), Measured(ROBOT, str(uuid4()), "move", 4, 3)
    assert keep_job(job=Job((short, gone, Measured(ROBOT, "no number", "move", 4, 3)), None), at=AT) == []
    assert not Measurement.objects.exists()


def test_of_each_method_the_newest_are_kept(factory: Any) -> None:
    measure(1, KEPT + 20, device=ROBOT, method="move", begin=-2 * KEPT)
    keep_job(job=Job((measured(command(), 3, 3),), None), at=AT)
    assert Measurement.objects.filter(device=ROBOT, method="move").count() == KEPT


def test_a_pace_is_taken_over_used_and_given_up(factory: Any) -> None:
    measure(1.2, 5)
    operator = join_and_sign_in("operator", SITE)
    (found,) = operator.get(PACES).json()
    assert (found["method"], found["count"], found["usual"], found["can_be_taken"]) == ("curePaint", 5, 1.2, True)
    before = digests_of(SITE)
    taken = operator.put(CURE).json()
    assert taken["calibrated"]["pace"] == 1.2
    assert taken["calibrated"]["by"]
    assert not taken["can_be_taken"]
    assert find_paces(site=SITE) == {OVEN: {"curePaint": 1.2}}
    assert what_changed(before, digests_of(SITE)) == {"what": "devices", "devices": [OVEN]}
    assert operator.delete(CURE).json()["calibrated"] is None
    assert find_paces(site=SITE) == {}
    assert what_changed(before, digests_of(SITE)) is None
    assert operator.delete(CURE).status_code == 404
    codes = [line.code for line in list_audit(site=SITE)]
    assert codes[:2] == ["calibration_dropped", "calibration_taken"]


@pytest.mark.parametrize(
    ("pace", "count", "why"), [(1.2, 4, "few_measured"), (25.0, 9, "far_from_model"), (0.01, 9, "far_from_model")]
)
def test_what_says_too_little_is_not_taken_over(factory: Any, pace: float, count: int, why: str) -> None:
    measure(pace, count)
    operator = join_and_sign_in("operator", SITE)
    assert operator.get(PACES).json()[0]["can_be_taken"] is False
    refused = operator.put(CURE)
    assert (refused.status_code, refused.json()["args"]["why"]) == (409, why)


def test_what_was_never_measured_or_is_not_there_cannot_be_taken_over(factory: Any) -> None:
    operator = join_and_sign_in("operator", SITE)
    assert operator.get(PACES).json() == []
    assert operator.put(CURE).status_code == 404
    assert operator.put(f"/api/sites/{SITE}/devices/nobody/paces/move").status_code == 404


def test_a_rehearsal_takes_measured_times_and_says_so(factory: Any) -> None:
    program = editor.create_program(site=SITE, name="Task", document=TASK).id
    client = join_and_sign_in("operator", SITE)
    usual = post_json(client, f"/api/programs/{program}/rehearsals", {}).json()
    measure(1.5, 6, device=ROBOT, method="move")
    assert client.put(f"/api/sites/{SITE}/devices/{ROBOT}/paces/move").status_code == 200
    slower = post_json(client, f"/api/programs/{program}/rehearsals", {}).json()
    assert (usual["asked"]["paces"], slower["asked"]["paces"]) == ({}, {ROBOT: {"move": 1.5}})
    jobs = Rehearsal.objects.order_by("created_at").values_list("job", flat=True)
    first, second = (scene_from_json(job["scene"])[0] for job in jobs)
    assert (first.paces, second.paces) == ({}, {ROBOT: {"move": 1.5}})


@pytest.mark.parametrize("role", EVERYBODY)
def test_who_may_look_may_read_and_operators_decide(factory: Any, role: str) -> None:
    measure(1.2, 5)
    client = join_and_sign_in(role, SITE)
    assert (client.get(PACES).status_code == 200) == (role in from_role("viewer"))
    for ask in (client.put, client.delete):
        assert (ask(CURE).status_code < 400) == (role in from_role("operator"))
