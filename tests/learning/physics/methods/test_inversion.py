import numpy as np
from caretree.learning.physics.methods.gp_inversion import fit_gp_inversion

from ..moving_blobs import blob_frames, blobs


def test_parameters_that_do_not_show_are_left_alone():
    train, valid = blobs(60, parameters=3), blobs(40, parameters=3, seed=1)
    method = fit_gp_inversion(train, valid, seed=0, shown=(0, 1)).sort(False)
    some = valid.frames[:3]
    np.testing.assert_array_equal(method.simulated(some, blob_frames)[0][:, 2], method.alone(some)[0][:, 2])
