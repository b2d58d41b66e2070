"""A demo that is stopped or killed in the middle of a run goes on with it."""

from __future__ import annotations

import json
from pathlib import Path

from tests.integration.breaking.site import Factory, complaints
from tests.kit.demo import running_demo
from tests.kit.programs import carry_document
from tests.kit.waiting import wait_for

BEGUN = ("accepted", "running", "done")


def is_alive(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


def held_by(machine: str, state: Path) -> dict[str, int]:
    """What the simulated world says is in a machine; machines do not tell it over MQTT."""
    memory = json.loads((state / "twin" / "painting-factory.json").read_text())
    held: dict[str, int] = memory["stocks"][machine]
    return held


def test_a_run_survives_ctrl_c_and_kill_9_and_does_each_thing_once(tmp_path: Path) -> None:
    state = tmp_path / "state"
    with running_demo(state, speed=3) as demo:
        first = Factory(demo)
        first.wait_online("robot01", "itemInventory01", "paintMachine01")
        boxes = first.reading("itemInventory01", "stock")
        run = first.start(first.plant({"Task": carry_document()})["Task"])
        first.wait_command(run, "move", *BEGUN)
        first.close()
    assert complaints(demo.log.read_text()) == []
    assert "WARNING" not in demo.log.read_text()

    with running_demo(state, speed=3) as demo:
        second = Factory(demo)
        second.wait_command(run, "pick", "done")
        second.close()
        children = second.children()
        demo.process.kill()
        demo.process.wait()
        assert children.keys() == {"twin", "firmware"}
        names = ", ".join(f"{name} (process {pid})" for name, pid in children.items())
        wait_for(f"end of {names}", lambda: not any(map(is_alive, children.values())))
    assert complaints(demo.log.read_text()) == []

    with running_demo(state, speed=10) as demo:
        third = Factory(demo)
        view = third.wait_run(run, "finished")
        assert (view["status"], view["reason"]) == ("finished", "")
        commands = third.commands(run)
        # On a busy machine a move may come too late for a device that was away for long; it is told anew.
        assert {c["status"] for c in commands if c["method"] != "move"} == {"done"}, commands
        assert [c["status"] for c in commands if c["method"] == "move"][-1] == "done", commands
        done = [c["method"] for c in commands if c["method"] != "move"]
        assert [m for m in done if m in ("pick", "drop")] == ["pick", "drop"]
        assert len({c["device"] for c in commands if c["method"] == "move"}) == 1
        robot = next(c["device"] for c in commands if c["method"] == "pick")
        wait_for("stock", lambda: third.reading("itemInventory01", "stock") == boxes - 1)
        assert third.device(robot)["carrying"] == {}
        third.close()
    assert held_by("paintMachine01", state) == {"box": 1}
    assert complaints(demo.log.read_text()) == []
