"""`caretree serve-robot --record`: the truth of what stands behind the master, for the evaluator."""

import json
import subprocess
import sys

from .conftest import CARETREE

RECORDED = """
from caretree.sim.scripted.world import ScriptedWorld


class Recorded(ScriptedWorld):
    def attach_recorder(self, recorder, on_error):
        recorder.note(attached=True)
"""


def test_the_truth_is_recorded_until_the_robot_is_told_to_end(robot_of_its_own, tmp_path):
    world = tmp_path / "recorded.py"
    world.write_text(RECORDED)
    words = ("serve-robot", "--world", f"{world}:Recorded", "--record", str(tmp_path / "truth"))
    command = [sys.executable, "-u", "-c", CARETREE, *words]
    robot = subprocess.Popen(command, env=robot_of_its_own.env, text=True, stdout=subprocess.PIPE)
    assert robot.stdout is not None
    assert robot.stdout.readline().startswith("serving")
    robot.terminate()
    robot.communicate(timeout=60.0)
    assert robot.returncode == 0
    run = json.loads((tmp_path / "truth" / "run.json").read_text())
    assert run["attached"]
    assert run["reason"] == "The robot was told to end; how its tree ended stands in the tree's own record."


def test_a_world_without_a_truth_has_none_to_record(robot_of_its_own, tmp_path):
    done = robot_of_its_own.caretree("serve-robot", "--record", str(tmp_path / "truth"))
    assert done.returncode == 2
    needs = "--record needs a world with a ground truth, such as bullet: scripted has none"
    assert done.stderr == f"caretree: {needs}\n"
