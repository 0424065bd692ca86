from dataclasses import replace

import numpy as np
from caretree.learning.physics.methods.gp_inversion import fit_gp_inversion
from caretree.learning.physics.methods.inversion import CAMERA_UNIT

from ..moving_blobs import blob_frames, blobs


def test_simulating_again_improves_and_intervals_hold():
    train, valid, test = blobs(60), blobs(40, seed=1), blobs(60, seed=2)
    method = fit_gp_inversion(train, valid, seed=0, shown=(0, 1))
    method.sort(False).set_widths("simulated", valid.unit, *method.raw(valid, lambda _: blob_frames))
    alone, again = method.infer(test), method.infer(test, lambda _: blob_frames)
    assert np.abs(again.unit - test.unit).mean() < 0.5 * np.abs(alone.unit - test.unit).mean()
    for found in (alone, again):
        inside = (test.unit >= found.lower) & (test.unit <= found.upper)
        assert inside.mean() > 0.8
        assert (found.lower <= found.unit).all()
        assert (found.unit <= found.upper).all()


def moved_blobs(unit, misplaced):
    """Blobs whose camera is misplaced along one axis: everything is shifted down."""
    frames = blob_frames(unit).astype(float)
    rows = np.arange(frames.shape[-2])[None, :] - 40.0 * np.asarray(misplaced)[:, 4:5]
    low = np.clip(np.floor(rows).astype(int), 0, frames.shape[-2] - 2)
    share = np.clip(rows - low, 0.0, 1.0)[:, None, None, :, None]
    index = low[:, None, None, :, None]

    def take(k):
        return np.take_along_axis(frames, np.broadcast_to(k, frames.shape), axis=3)

    return ((1 - share) * take(index) + share * take(index + 1)).astype(np.float16)


def both_sorts(count, seed):
    """Blobs, every second of them rough: seen by a misplaced camera."""
    clean = blobs(count, seed=seed)
    rough = np.arange(count) % 2 == 1
    misplaced = np.zeros((count, 6))
    misplaced[:, 4] = np.where(rough, np.random.default_rng(seed + 50).normal(0, CAMERA_UNIT[4] / 10, count), 0.0)
    frames = np.where(rough[:, None, None, None, None], moved_blobs(clean.unit, misplaced), clean.frames)
    return replace(clean, frames=frames, rough=rough, misplaced=misplaced)


def test_each_sort_of_clips_has_its_own_inversion_and_a_misplaced_camera_is_found():
    train, valid, test = both_sorts(160, 0), both_sorts(80, 1), both_sorts(60, 2)
    method = fit_gp_inversion(train, valid, seed=0, shown=(0, 1))
    assert set(method.inversions) == {"clean", "rough"}
    assert method.sort(True) is method.sort(True, other=True) is method.inversions["rough"]
    assert method.sort(False) is method.sort(False, other=True) is method.inversions["clean"]

    def simulators(index):
        return moved_blobs if test.gaps[index[0]] else blob_frames

    alone, (again, _) = method.infer(test), method.raw(test, simulators)
    rough = test.gaps
    fooled = method.sort(False).alone(test.frames)[0]
    errors = [np.abs(unit - test.unit)[rough].mean() for unit in (fooled, alone.unit, again)]
    assert errors[2] < errors[1] < 0.5 * errors[0]


def test_gowns_of_other_cuts_are_read_by_a_process_that_learned_from_many():
    def cut(count, seed):  # clips of other cuts: faster than those of the usual one
        some = blobs(count, seed=seed)
        return replace(some, frames=blob_frames(some.unit + [0.4, 0.0]))

    method = fit_gp_inversion(blobs(60), blobs(40, seed=1), (cut(60, 3), cut(40, 4)), seed=0, shown=(0, 1))
    assert set(method.inversions) == {"clean", "clean_other"}
    assert method.sort(True, other=True) is method.inversions["clean_other"]
    test = cut(40, 5)
    fooled, told = (np.abs(method.infer(test, other=other).unit - test.unit).mean() for other in (False, True))
    assert told < 0.1 * fooled

    def simulators(index):
        return lambda unit: blob_frames(unit + [0.4, 0.0])

    again, _ = method.raw(test, simulators, other=True)
    assert np.abs(again - test.unit).mean() < told
