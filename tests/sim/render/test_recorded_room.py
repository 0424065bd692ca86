"""Any frame of a record can be shown again."""

from __future__ import annotations

import numpy as np
from caretree.sim.record.record import read_run
from caretree.sim.render.recorded_room import RecordedRoom


def arrays_of(directory):
    with np.load(directory / "truth.npz") as stored:
        return {name: stored[name] for name in stored.files}


def test_cloth_arms_and_robot_are_where_they_were(make_record, tmp_path):
    directory = make_record(tmp_path / "run")
    arrays = arrays_of(directory)
    room = RecordedRoom(read_run(directory), arrays)
    for index in (0, len(room.t) - 1):
        shown = room.at(index)
        np.testing.assert_allclose(shown.cloth[0], arrays["vertices"][index])
        poses = {body.name: body.pose_in_map for body in shown.bodies()}
        np.testing.assert_allclose(poses["arm10"][:3, 3], arrays["arms"][index, 1, 0], atol=1e-6)
        np.testing.assert_allclose(poses["link_left_palm"][:3, 3], arrays["robot_capsules"][index, 0, :3], atol=1e-6)


def test_a_record_without_robot_or_scene_is_shown_all_the_same(make_record, tmp_path):
    arrays = arrays_of(make_record(tmp_path / "run"))
    bare = {name: arrays[name] for name in ("t", "vertices", "arms", "faces", "arm_radii")}
    assert RecordedRoom({"seed": -1}, bare).at(0).cloth is not None
