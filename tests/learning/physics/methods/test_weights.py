import numpy as np
from caretree.learning.physics.methods.weights import load_weights, save_weights


def test_weights_come_back_as_they_were_saved(fitted, new_clips, tmp_path):
    path = save_weights(fitted, tmp_path / "w.safetensors", {"data": "abc"})
    again, record = load_weights(path)
    assert record == {"data": "abc"}
    before, after = fitted.infer(new_clips), again.infer(new_clips)
    np.testing.assert_allclose(after.unit, before.unit, atol=1e-6)
    np.testing.assert_allclose(after.lower, before.lower, atol=1e-6)
    assert set(again.sort(False).widths) == {"alone", "simulated"}
