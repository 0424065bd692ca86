import numpy as np
import pytest

from ..moving_blobs import BlobSimulator, blobs


@pytest.fixture(params=["scores", "small"])
def study(tmp_path, small_gown, monkeypatch, request):
    """A small study of blobs; it needs torch."""
    from caretree.learning.physics.methods.examples import Loaded
    from caretree.learning.physics.study import study as study_module
    from caretree.learning.physics.study.registry import Plan
    from caretree.learning.physics.study.study import Study

    monkeypatch.setattr(study_module, "Simulator", BlobSimulator)
    split = np.array(["train", "train", "train", "val", "test"])
    data = Loaded(kind="uniform", gowns=[small_gown] * 60, examples=blobs(60, parameters=6), split=np.resize(split, 60))
    other = Loaded(kind="heldout_gown", gowns=[small_gown] * 8, examples=blobs(8, 6, seed=5), split=np.full(8, "test"))
    plan = Plan(steps=3, backbone=request.param, folder=tmp_path, say=lambda _: None)
    return Study(data=data, tests={other.kind: other}, plan=plan, seeds=(0, 1), simulate=11, calibrate=10)
