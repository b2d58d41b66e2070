"""A device that vanishes in the middle of a command."""

from __future__ import annotations

import os
import signal

from tests.integration.breaking.site import Factory
from tests.kit.programs import document, operate, step
from tests.kit.waiting import wait_for


def test_a_machine_that_is_killed_comes_back_and_does_not_begin_its_work_anew(factory: Factory) -> None:
    run = factory.start(factory.plant({"Mix": document({"mix": operate("paintMixer02", "mixPaint", time=1)})})["Mix"])
    factory.wait_command(run, "mixPaint", "running")
    killed = factory.children()["firmware"]
    os.kill(killed, signal.SIGKILL)
    wait_for("a new firmware", lambda: factory.children().get("firmware") not in (None, killed))
    assert "the power was cut while it was under way" in factory.wait_run(run, "failed")["reason"]
    assert [c["status"] for c in factory.commands(run)] == ["failed"]


def test_a_machine_that_freezes_is_offline_and_can_be_caught(factory: Factory) -> None:
    mix = operate("paintMixer02", "mixPaint", ("guard", "body"), time=30)
    caught = {"guard": step("try", kinds=["offline"]), "mix": mix, "rest": step("wait", ("guard", "catch"), seconds=1)}
    run = factory.start(factory.plant({"Guarded mix": document(caught)})["Guarded mix"])
    factory.wait_command(run, "mixPaint", "running")
    frozen = factory.children()["firmware"]
    os.kill(frozen, signal.SIGSTOP)
    try:
        factory.wait_run(run, "finished", timeout_s=100)
        assert any("offline" in line for line in factory.journal(run)), factory.journal(run)
        assert factory.device("paintMixer02")["status"] == "offline"
    finally:
        os.kill(frozen, signal.SIGCONT)
    factory.wait_online("paintMixer02")
