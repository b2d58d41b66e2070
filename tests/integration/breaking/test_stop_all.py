"""Stop all, pause, resume and cancel in the middle of a run."""

from __future__ import annotations

import time
from concurrent.futures import ThreadPoolExecutor

from tests.integration.breaking.site import SLUG, Factory
from tests.kit.programs import carry_document
from tests.kit.waiting import wait_for


def stand_still(factory: Factory) -> bool:
    """Tell whether all robots stay where they are for a moment."""
    before = factory.poses()
    time.sleep(1.5)
    return factory.poses() == before


def times_told(factory: Factory, run: str) -> int:
    return sum(command["tries"] for command in factory.commands(run))


def test_stop_all_holds_the_robots_and_the_run_goes_on_after_a_reset(factory: Factory) -> None:
    run = factory.start(factory.plant({"Stopped task": carry_document()})["Stopped task"])
    before = factory.poses()
    wait_for("a robot that drives", lambda: factory.poses() != before)
    stop = factory.admin.post(f"/api/sites/{SLUG}/stop").json()
    assert stop["active"] is True
    told = times_told(factory, run)
    wait_for("robots that stand still", lambda: stand_still(factory))
    assert times_told(factory, run) <= told, "no robot was sent on until it had come to its end"
    view = factory.wait_run(run, "paused")
    assert view["reason"] == f"{stop['by']} stopped all devices of the site"

    refused = factory.order(run, "resume")
    assert refused.status_code == 409
    assert refused.json()["detail"] == "The site is stopped. Reset the stop, then resume the run."
    assert factory.admin.post(f"/api/sites/{SLUG}/stop/reset").json()["active"] is False
    assert factory.order(run, "resume").status_code == 200
    factory.wait_run(run, "finished")
    assert {c["status"] for c in factory.commands(run)} == {"done"}


def test_two_people_pause_resume_and_cancel_at_once(factory: Factory) -> None:
    run = factory.start(factory.plant({"Quarrel": carry_document()})["Quarrel"])
    factory.wait_command(run, "move", "accepted", "running", "done")
    people = [factory.signed_in("admin"), factory.signed_in("admin")]
    with ThreadPoolExecutor(2) as both:
        for word, status in (("pause", "paused"), ("resume", "running"), ("pause", "paused"), ("cancel", "cancelled")):
            answers = list(both.map(lambda person, word=word: factory.order(run, word, person).status_code, people))
            assert set(answers) <= {200, 409}, (word, answers)
            assert 200 in answers
            factory.wait_run(run, status)
    over = factory.order(run, "resume")
    assert over.status_code == 409
    assert "is over (cancelled)" in over.json()["detail"]
