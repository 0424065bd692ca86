"""What was seen before a failure is kept, with what perception made of it."""

from __future__ import annotations

import numpy as np
import pytest
from caretree.perception.estimates import GraspPoint
from caretree.perception.senses import Senses
from caretree.sim.errors import RecordError
from caretree.sim.world import Frame
from caretree.trees.report.looks import LookLog, Witness, drawn, finding_of, pixels_of, read_looks


def frame(t=1.0, camera="head"):
    return Frame(
        camera=camera,
        stamp=t,
        rgb=np.full((30, 40, 3), 90, np.uint8),
        depth=np.ones((30, 40), np.float32),
        intrinsics=(40.0, 40.0, 20.0, 15.0),
        pose_camera_in_map=np.eye(4),
    )


GRASP = GraspPoint(
    stamp=1.0,
    confidence=0.5,
    target="near_hang",
    position_in_map=np.array((0.1, 0.05, 1.0)),
    approach_in_map=np.zeros(3),
    closing_in_map=np.zeros(3),
)


class Eyes(Senses):
    """Sees a grasp, and nothing else."""

    extra = "kept"


def _answer(self, frame, *args, **options):
    raise LookupError("not there")


for _name in Senses.__abstractmethods__:
    setattr(Eyes, _name, _answer)
Eyes.hang_point = lambda self, frame: GRASP
Eyes.__abstractmethods__ = frozenset()


def test_points_are_found_in_the_picture():
    np.testing.assert_allclose(pixels_of(frame(), np.array([(0.1, 0.05, 1.0), (0, 0, -1.0)])), [(24.0, 17.0)])
    finding = finding_of("hang_point", frame(), GRASP)
    assert finding.found
    assert "confidence 0.50" in finding.words
    np.testing.assert_allclose(finding.marks["position"], [(24.0, 17.0)])


def test_senses_answer_the_same_in_front_of_a_witness():
    witness = Witness()
    senses = witness.watch(Eyes())
    picture = frame()
    assert senses.hang_point(picture) is GRASP
    with pytest.raises(LookupError):
        senses.arm(picture, side="left")
    with pytest.raises(LookupError):
        senses.layers([], side="left")
    assert senses.extra == "kept"
    assert isinstance(senses, Senses)
    look = witness.looks["head"]
    assert [(each.asked, each.found) for each in look.findings] == [("hang_point", True), ("arm", False)]
    senses.hang_point(frame(2.0))
    assert len(witness.looks["head"].findings) == 1
    assert witness.since(2.0) is witness.looks["head"]
    assert witness.since(2.1) is None


def test_the_look_before_a_failure_is_written_and_read(tmp_path):
    witness = Witness()
    log = LookLog(tmp_path, witness)
    log.event({"t": 0.5, "kind": "node", "node": "a/look", "status": "RUNNING"})
    witness.note("hang_point", frame(), GRASP)
    witness.note("arm", frame(), LookupError("no arm"))
    log.event({"t": 1.5, "kind": "node", "node": "a/look", "status": "FAILURE", "reason": "NOTHING_SEEN"})
    log.event({"t": 1.5, "kind": "node", "node": "a", "status": "FAILURE"})
    log.event({"t": 2.5, "kind": "node", "node": "a/other", "status": "FAILURE", "reason": "TIMEOUT"})  # saw nothing
    (look,) = read_looks(tmp_path)
    assert (look.node, look.camera, look.t) == ("a/look", "head", 1.5)
    assert look.rgb.shape == (30, 40, 3)
    assert [each.words for each in look.findings][-1] == "no arm"
    marked = drawn(look)
    assert marked.shape == (60, 80, 3)
    assert marked.std() > 0
    with (tmp_path / "looks" / "looks.jsonl").open("a") as index:
        index.write('{"file": "looks/../../secret"}\nnonsense\n')
    assert len(read_looks(tmp_path)) == 1
    assert read_looks(tmp_path / "nowhere") == []


def test_a_full_disk_is_one_sentence(tmp_path):
    (tmp_path / "looks").write_text("in the way")
    witness = Witness()
    log = LookLog(tmp_path, witness)
    witness.note("hang_point", frame(), GRASP)
    with pytest.raises(RecordError, match="writing"):
        log.event({"t": 1.0, "kind": "node", "node": "a", "status": "FAILURE", "reason": "TIMEOUT"})
