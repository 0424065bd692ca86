import numpy as np
from caretree.sim.scripted.world import scripted_room
from caretree.sim.world import GripperOpening
from caretree.skills.geometry.person_zone import PersonZone
from caretree.trees.guard.declared_grips import DeclaredGrips

from .guarded import make


def test_opening_the_fingers_lets_go():
    world, guard = make(near=False)
    guard.send(GripperOpening(side="left", opening=0.02))
    world.clock.wait_until(2.0)
    guard.declare_grip("left", "arm")
    guard.send(GripperOpening(side="left", opening=0.0))
    assert guard.grip("left") == "arm"
    guard.send(GripperOpening(side="left", opening=0.08))
    assert guard.grip("left") == "nothing"


def test_the_arm_nearest_to_the_hand_goes_with_it_until_it_is_let_go_of():
    zone = PersonZone(scripted_room().bed, 0.3)
    for side, y in (("left", 0.3), ("right", -0.3)):
        zone.update(np.array(((0.0, y, 0.8), (0.3, y, 0.8))), part=f"{side} arm", radius=0.05)
    grips = DeclaredGrips(zone)
    grips.declare("left", "arm")
    grips.find_arm("left", np.array((0.3, -0.25, 0.8)))
    assert dict(grips.arms) == {"left": "right arm"}
    grips.declare("left", "cloth")
    grips.find_arm("left", np.array((0.3, -0.25, 0.8)))
    assert not grips.arms
