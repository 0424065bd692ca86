"""A simulated robot begins anew and plays faults of physics when a campaign asks; a real one does neither."""

import json

ASKED = """
import json
import numpy as np
from caretree.sim.abilities import SupportsFaults, SupportsRestart
from caretree.sim.ros1.world import Ros1World
from caretree.sim.world import BaseVelocity, GripperOpening


def wait(world, seconds):
    world.clock.wait_until(world.clock.now() + seconds)


def told(world):
    seen = world.observe()
    load, offset = seen.wrench_hand_in_map[0][2], world.person_offset
    return {"time": world.clock.now(), "base": seen.pose_base_in_map.tolist(), "load": load, "moved": offset.tolist()}


world = Ros1World()
assert isinstance(world, SupportsFaults) and isinstance(world, SupportsRestart)
world.restart()
first = told(world)
world.send(GripperOpening(side="left", opening=0.0))
world.send(BaseVelocity(velocity=np.array((0.2, 0.0, 0.0)), duration=1.0))
wait(world, 2.0)
held = told(world)
world.fault_grip_slip("left")
world.fault_move_person()
wait(world, 0.5)
slipped = told(world)
world._ask(1e6)  # time passes for hours: who asks to begin anew does not wait for that
world.restart()
wait(world, 0.1)
print(json.dumps([first, held, slipped, told(world)]))
world.close()
"""

REAL = """
from caretree.sim.ros1 import rehearsal
from caretree.sim.ros1.ros import node
from caretree.sim.world import WorldError

rehearsal.BEGIN_ANEW, rehearsal.PERSON_MOVES = "/nobody/begins", "/nobody/moves"
asked = rehearsal.Rehearsal(node("tree"))
for ask in (lambda: asked.begin_anew(0.2), asked.move_person):
    try:
        ask()
    except WorldError as error:
        print(error)
"""


def test_it_plays_faults_and_is_as_at_first_afterwards(baxter):
    done = baxter.python(ASKED)
    assert done.returncode == 0, done.stderr
    first, held, slipped, anew = json.loads(done.stdout)
    assert held["base"] != first["base"]
    assert held["load"] < -1.0 < slipped["load"], "what hung on the hand is gone [N]"
    assert (held["moved"], slipped["moved"]) == ([0.0, 0.0, 0.0], [0.1, 0.0, 0.0])
    assert anew["base"] == first["base"]
    assert anew["moved"] == [0.0, 0.0, 0.0]
    assert anew["time"] < 0.5 < slipped["time"], "a world's clock begins with it"


def test_a_robot_that_nobody_simulates_does_neither(baxter):
    done = baxter.python(REAL)
    assert done.returncode == 0, done.stderr
    only = "only a simulated robot does, `caretree serve-robot`"
    assert done.stdout.splitlines() == [
        f"nobody takes {topic}: {only}" for topic in ("/nobody/begins", "/nobody/moves")
    ]


def test_faults_are_survived_through_the_master(waving_robot, tmp_path):
    words = ("--fault", "grip_slip", "--fault", "lost_command", "--sample", "5", "--out", str(tmp_path))
    done = waving_robot.caretree("inject", "wave", "--world", "ros1", *words)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "5 faults to try" in done.stdout


def test_runs_that_share_a_robot_are_not_tried_two_at_a_time(waving_robot, tmp_path):
    done = waving_robot.caretree("inject", "wave", "--world", "ros1", "--jobs", "2", "--out", str(tmp_path))
    assert done.returncode == 2
    assert done.stderr == "caretree: Ros1World has one robot for all runs: no --jobs, no --address\n"


def test_a_stage_begins_where_the_robot_does(baxter, tmp_path):
    words = ("--stage", "lay", "--world", "ros1", "--senses", "scripted", "--out", str(tmp_path / "out"))
    done = baxter.caretree("run", "dressing", *words)
    assert done.returncode == 2
    assert "the simulated robot begins with 'gown_on_hook', not 'gown_in_hands'" in done.stderr
