import numpy as np
import pytest
from caretree.sim.mechanics.far_apart import FarApart, Solid
from caretree.sim.mechanics.shape import Shape
from caretree.sim.segments import segment_distances

RODS = tuple(Shape(kind="capsule", size=(radius, length)) for radius, length in ((0.1, 0.5), (0.2, 1.0)))
BOX = Shape(kind="box", size=(0.4, 0.6, 1.0))
AT_ORIGIN = np.append(np.eye(3).ravel(), np.zeros(3))[None]  # one joint


def solid(shape, centre=(0.0, 0.0, 0.0), turn=None):
    return Solid(joint=0, shape=shape, turn=np.eye(3) if turn is None else turn, centre=np.asarray(centre, float))


def turned(generator):
    turn, _ = np.linalg.qr(generator.normal(size=(3, 3)))
    return turn * np.linalg.det(turn)


def test_a_capsule_beside_a_box_is_as_far_as_its_surface():
    pair = FarApart([solid(RODS[0], (0.5, 0.0, 0.0)), solid(BOX)], [(0, 1)])
    assert pair.all(AT_ORIGIN, 0.19)
    assert not pair.all(AT_ORIGIN, 0.21)


def test_capsules_are_never_said_to_be_further_apart_than_they_are():
    generator = np.random.default_rng(0)
    said = 0
    for _ in range(300):
        solids = [solid(rod, generator.uniform(-1.0, 1.0, 3), turned(generator)) for rod in RODS]
        axes = [
            each.centre + np.outer((-0.5, 0.5), each.shape.size[1] * each.turn[:, 2]) for each in solids
        ]  # the segments
        gap = float(segment_distances(axes[0][None], axes[1][None])[0][0, 0]) - 0.3
        pair = FarApart(solids, [(0, 1)])
        assert not pair.all(AT_ORIGIN, gap + 1e-9)
        said += pair.all(AT_ORIGIN, 0.7 * gap - 1e-3)
    assert said > 150


def test_joints_carry_what_is_fixed_to_them():
    away = np.append(np.eye(3).ravel(), (0.0, 2.0, 0.0))[None]
    here, there = solid(BOX), Solid(joint=1, shape=BOX, turn=np.eye(3), centre=np.zeros(3))
    places = np.concatenate((AT_ORIGIN, away))
    assert FarApart([here, there], [(0, 1)]).all(places, 1.0)
    assert not FarApart([here, here], [(0, 1)]).all(places, 0.0)


@pytest.mark.parametrize("pairs", [[], np.zeros((0, 2))])
def test_no_pairs_are_far_apart(pairs):
    assert FarApart([solid(BOX)], pairs).all(AT_ORIGIN, 1.0)
