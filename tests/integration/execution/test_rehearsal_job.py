import json
import subprocess
import sys

from editor.language import plan_to_json
from editor.language.expressions.nodes import Constant
from editor.language.plan.instructions import End, Instruction, Plan, Wait
from execution.rehearsals.child_process import scene_to_json
from execution.rehearsals.program_file import rehearse_program
from simulation.world import Scene
from tests.kit import demo_floor
from tests.kit.files import ROOT


def scene():
    return Scene(demo_floor.grid(), demo_floor.devices(), seed=1)


def test_the_example_programs_rehearse_without_errors():
    for name in ("pick-and-drop", "paint-order"):
        body = json.loads((ROOT / "examples" / f"{name}.json").read_text())
        site = body["site"]
        if isinstance(site, str):
            site = json.loads((ROOT / "examples" / site).read_text())
        grid = {"yaml": str(ROOT / "registry" / "demo" / "painting-factory.yaml")}
        result = rehearse_program(body["document"], {**site, "grid": grid}, 1, "kinematic")
        assert (result["ok"], result["errors"], result["collisions"], result["near_misses"]) == (True, [], [], [])


def test_the_child_process_writes_progress_and_the_result():
    plan = Plan((Instruction(Wait(Constant(30)), "w"), Instruction(End())))
    job = {
        "plan": plan_to_json(plan),
        "scene": scene_to_json(demo_floor.scene(), demo_floor.places()),
        "driver": "kinematic",
    }
    child = subprocess.run(
        [sys.executable, "-m", "execution.rehearsals.child_process"],
        input=json.dumps(job), capture_output=True, text=True, cwd=ROOT, timeout=120,
    )  # fmt: skip
    lines = [json.loads(line) for line in child.stdout.splitlines()]
    assert child.returncode == 0
    assert lines[0] == {"begun": True}
    course = lines[1]["course"]
    assert (course["steps"], course["end_known"], course["share"]) == (1, True, 0.0)
    assert course["virtual_s"] <= 30.0
    assert lines[-1]["result"]["ok"] is True
    assert lines[-1]["result"]["duration_s"] == 30.0


def test_a_broken_job_is_answered_with_a_sentence():
    child = subprocess.run(
        [sys.executable, "-m", "execution.rehearsals.child_process"],
        input="{}",
        capture_output=True,
        text=True,
        cwd=ROOT,
    )
    assert child.returncode == 1
    begun, broke = (json.loads(line) for line in child.stdout.splitlines())
    assert begun == {"begun": True}
    assert broke["error"].startswith("The rehearsal broke off")
