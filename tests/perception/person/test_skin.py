"""Skin of the person on the bed, and of nobody else."""

import numpy as np
from caretree.perception.image.surfaces import Surface, surfaces
from caretree.perception.person.skin import skin_on_bed


def test_skin_lies_on_and_above_the_bed(scenes, bed):
    points, mask = skin_on_bed(scenes.person(0).frame(0), bed)
    assert len(points) > 300
    assert mask.sum() >= len(points)
    assert (points[:, 2] > bed[1, 2] - 0.16).all()
    assert (points[:, 0] > bed[0, 0] - 0.46).all()
    assert (points[:, 0] < bed[1, 0] + 0.46).all()


def test_a_person_in_another_bed_is_left_out(scenes, bed):
    points, mask = skin_on_bed(scenes.person(0).frame(0), bed + (3.0, 0.0, 0.0))
    assert len(points) == 0
    assert mask.any()


def test_pixels_at_the_edge_may_be_left_out(scenes, bed):
    frame = scenes.person(0).frame(0)
    everything, inner = skin_on_bed(frame, bed)[0], skin_on_bed(frame, bed, inner=True)[0]
    assert len(inner) < len(everything)
    assert {tuple(point) for point in inner} <= {tuple(point) for point in everything}


def test_no_skin(bed, black):
    points, mask = skin_on_bed(black, bed)
    assert points.shape == (0, 3)
    assert not np.any(mask)


def test_the_mask_of_skin_is_not_beside_it(scenes, bed):
    frame = scenes.person(0).frame(0)
    mask = skin_on_bed(frame, bed)[1]
    skin = surfaces(frame.rgb) == Surface.SKIN
    assert not (mask & ~skin).any()
    assert mask.sum() > 0.95 * skin.sum()
