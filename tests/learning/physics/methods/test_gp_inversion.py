from dataclasses import replace

import numpy as np
import pytest
from caretree.learning.physics.methods.conformal import calibrate
from caretree.learning.physics.methods.gaussian_process import fit_gaussian_process
from caretree.learning.physics.methods.gp_inversion import fit_gp_inversion
from caretree.learning.physics.methods.indirect_inference import match
from caretree.learning.physics.methods.inversion import CAMERA_UNIT
from caretree.learning.physics.methods.pca import fit_compression
from caretree.learning.physics.methods.prior import Prior, fit_prior

from ..moving_blobs import blob_classes, blob_frames, blobs


def test_compression_keeps_what_differs():
    frames = blobs(60).frames
    compression = fit_compression(frames, 10)
    scores = compression(frames)
    assert 2 <= scores.shape[1] <= 10
    np.testing.assert_array_equal(compression.components, compression.components.astype(np.int8))
    length = np.linalg.norm(compression.components, axis=0)
    directions = compression.components / length
    np.testing.assert_allclose(directions.T @ directions, np.eye(scores.shape[1]), atol=2e-2)
    assert (scores**2).sum(axis=1).mean() == pytest.approx(1.0, rel=0.02)
    back = (scores / compression.scale / length) @ directions.T + compression.mean
    flat = frames.reshape(60, -1).astype(float)
    assert ((back - flat) ** 2).sum() < 0.01 * ((flat - flat.mean(axis=0)) ** 2).sum()


def test_gaussian_process_follows_what_shows_and_averages_what_does_not():
    rng = np.random.default_rng(0)
    inputs = rng.normal(size=(150, 2))
    shown, hidden = np.sin(inputs[:, 0]) + 0.3 * inputs[:, 1], rng.normal(size=150)
    process = fit_gaussian_process(inputs[:120], np.column_stack([shown, hidden])[:120], seed=0)
    answers = process(inputs[120:])
    assert np.median(np.abs(answers[:, 0] - shown[120:])) < 0.02
    assert answers[:, 1].std() < 0.4 * hidden.std()
    np.testing.assert_allclose(process.distance(inputs[:5]), 0.0, atol=1e-6)


@pytest.mark.parametrize("measure", [(), (0, 1, 2)])
def test_matching_undoes_the_bias_of_an_estimator(measure):
    true = np.random.default_rng(0).uniform(0.2, 0.8, (20, 3))

    def answer(unit):  # shrinks towards the middle, bends, and mixes the parameters
        bent = 0.6 * unit + 0.2 + 0.05 * np.sin(4 * unit)
        return bent + 0.1 * bent[:, [1, 2, 0]] - 0.05

    def answers(unit):
        return answer(unit), np.linalg.norm(unit - true, axis=1)

    wanted = answer(true)
    found, misfit = match(answers, wanted, np.full_like(true, 0.05), 8, measure=measure)
    assert np.abs(wanted - true).max() > 0.05
    assert np.median(np.abs(found - true)) < 1e-3
    np.testing.assert_allclose(misfit, np.linalg.norm(found - true, axis=1))


def test_matching_never_returns_worse_than_the_best_it_saw():
    seen = []

    def answers(unit):
        seen.append(np.abs(unit[:, 0] - 0.5))
        return np.random.default_rng(len(seen)).random(unit.shape), seen[-1]

    _, misfit = match(answers, np.full((3, 2), 0.9), np.full((3, 2), 0.1), 5)
    np.testing.assert_allclose(misfit, np.min(seen, axis=0))


def test_intervals_cover_nine_of_ten_where_errors_depend_on_the_place():
    rng = np.random.default_rng(0)

    def draw(n):
        true = rng.random((n, 2))
        return true, true + rng.normal(size=(n, 2)) * (0.01 + 0.1 * true[:, :1])

    calibration = calibrate(*draw(400), np.ones(400))
    true, estimated = draw(2000)
    lower, upper = calibration.intervals(estimated, np.ones(2000))
    inside = (true >= lower) & (true <= upper)
    assert 0.86 < inside.mean() < 0.94
    for part in (true[:, 0] < 0.3, true[:, 0] > 0.7):  # not too wide here and too narrow there
        assert 0.8 < inside[part].mean() < 0.98


def test_badly_explained_clips_get_wider_intervals():
    rng = np.random.default_rng(0)
    true = rng.uniform(0.4, 0.6, (100, 1))
    calibration = calibrate(true, true + rng.normal(0, 0.01, true.shape), np.ones(100))
    estimated = np.array([[0.5], [0.5]])
    lower, upper = calibration.intervals(estimated, np.array([1.0, 3.0]))
    width = (upper - lower)[:, 0]
    assert width[1] == pytest.approx(3 * width[0])


def test_prior_pulls_towards_the_class_and_weighs_the_evidence():
    prior = Prior(np.array([[0.2, 0.2], [0.8, 0.8]]), np.full(2, 0.01**2))
    mean, deviation = prior.combine(np.array([[0.22, 0.2]]), np.array([[0.01, 0.5]]))
    np.testing.assert_allclose(mean, [[0.21, 0.2]], atol=1e-4)
    np.testing.assert_allclose(deviation, [[0.01 / np.sqrt(2), 0.01]], rtol=1e-2)
    undecided, wide = prior.combine(np.array([[0.5, 0.5]]), np.array([[0.5, 0.5]]))
    np.testing.assert_allclose(undecided, 0.5, atol=1e-6)
    assert (wide > 0.29).all()


def test_without_classes_the_prior_says_nothing():
    examples = blobs(10)
    prior = fit_prior(examples.unit, examples.class_id)
    unit, deviation = np.full((1, 2), 0.3), np.full((1, 2), 0.2)
    mean, same = prior.combine(unit, deviation)
    assert mean is unit
    assert same is deviation


def test_prior_of_classes_knows_their_spread():
    examples = blob_classes(10, 30)
    prior = fit_prior(examples.unit, examples.class_id)
    assert prior.means.shape == (10, 2)
    np.testing.assert_allclose(np.sqrt(prior.variance), 0.005, rtol=0.2)


def test_matching_ends_when_nothing_is_left_to_do():
    calls = []

    def answers(unit):
        calls.append(unit)
        return unit, np.zeros(len(unit))

    found, _ = match(answers, np.full((2, 3), 0.4), np.full((2, 3), 0.1), 9)
    assert len(calls) == 1
    np.testing.assert_allclose(found, 0.4)


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


def test_parameters_that_do_not_show_are_left_alone():
    train, valid = blobs(60, parameters=3), blobs(40, parameters=3, seed=1)
    method = fit_gp_inversion(train, valid, seed=0, shown=(0, 1)).sort(False)
    some = valid.frames[:3]
    np.testing.assert_array_equal(method.simulated(some, blob_frames)[0][:, 2], method.alone(some)[0][:, 2])


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
