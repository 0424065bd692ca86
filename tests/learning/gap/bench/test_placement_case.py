import numpy as np
from caretree.learning.gap.bench.joint_case import LEAST
from caretree.learning.gap.bench.placement_case import ANGLES, write_placement_case
from caretree.learning.gap.measurement import load_set
from caretree.sim.effects.joint.arm_geometry import GEOMETRY


def test_what_is_hidden_shows_and_only_where_the_kind_says_so(tmp_path):
    kinds, names = set(), set()
    for seed in (2000, 2002, 2008, 2012):
        truth = write_placement_case(seed, tmp_path)
        kinds.add(truth.kind)
        assert len(truth.effects) == {"none": 0, "single": 1, "two": 2}[truth.kind]
        assert all(e["size"] >= LEAST for e in truth.effects)
        if truth.effects:
            names.add(truth.effects[0]["name"])
            assert ANGLES[0] <= np.linalg.norm(list(truth.effects[0]["values"].values())) <= ANGLES[1]
        assert {e.role for e in load_set(tmp_path).episodes} == {"fit", "heldout"}
    assert kinds == {"none", "single", "two"}
    assert names == set(GEOMETRY)
