"""How soon a person who stirs is noticed: `python benchmarks/person_moves.py FIRST LAST SKILL [SKILL ...]`.

Each run of the stage `dress` begins with the gown laid on the person; somewhere in the first `WITHIN` seconds of a
skill, drawn by the seed, both arms swing outwards by 15 degrees.  One line of JSON for each run, then the share that
was noticed in time.
"""

import json
import sys

import numpy as np
from caretree.sim.world_kind import EASY
from caretree.trees.campaign.success_rate import SuccessRate
from caretree.trees.run.runner import Run
from caretree.trees.run.task import load_task
from caretree.trees.run.worlds import make_world, prepare_stage

STAGE = "dress"
WITHIN = (0.5, 4.0)  # [s]
WATCHED = 1.5  # [s] after the person begins to move
GIVEN_UP = 300.0  # [s] where the skill does not run so long
ASKED = 0.3  # [s]


def noticed(seed: int, skill: str) -> dict[str, object]:
    """What came of one run: when the person moved, and how long after that it was noticed [s]."""
    task = load_task("dressing")
    world, senses = make_world("bullet", task, seed=seed, kind=EASY)
    delay = float(np.random.default_rng((seed, len(skill))).uniform(*WITHIN))
    running: list[float] = []  # when the skill started
    moved: list[float] = []

    def watch(name: str, phase: str) -> None:
        now = world.clock.now()
        if name == skill and phase == "start":
            running[:] = [now]
        elif name == skill and phase == "step" and not moved and now > running[0] + delay:
            moved.append(now)
            world.fault_move_person()

    def before_tick() -> None:
        if world.clock.now() > (moved[0] + WATCHED if moved else GIVEN_UP):
            run.request_stop()

    run = Run(task, world, seed=seed, senses=senses, params=task.parameters(STAGE), before_tick=before_tick)
    run.context.observers.append(watch)
    prepare_stage(world, task, STAGE)
    result = run.run()
    world.close()
    told = [event["t"] for event in run.trace.events if event.get("reason") == "PERSON_MOVED"]
    after = [round(t - moved[0], 3) for t in told if moved and t >= moved[0]]
    return {
        "seed": seed,
        "skill": skill,
        "moved": moved[0] if moved else None,
        "after": after[0] if after else None,
        "false_alarms": len({t for t in told if not moved or t < moved[0]}),
        "reason": result.reason,
    }


first, last, *skills = sys.argv[1:]
found = []
for seed in range(int(first), int(last) + 1):
    for skill in skills:
        found.append(noticed(seed, skill))
        print(json.dumps(found[-1]), flush=True)
moved = [each for each in found if each["moved"] is not None]
in_time = sum(each["after"] is not None and each["after"] <= ASKED + 1e-6 for each in moved)
print(
    f"noticed within {ASKED} s: {SuccessRate(successes=in_time, trials=len(moved))}; "
    f"{sum(each['false_alarms'] for each in found)} false alarms in {len(found)} runs"
)
