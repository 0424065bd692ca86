"""The cut of the gown: what its mesh must have for the rest to rely on."""

import dataclasses

import numpy as np
import pytest
from caretree.sim.errors import CaretreeError
from caretree.sim.scene.gown import GOWNS, GownSpec, build_gown, edge_counts

MESH = build_gown(GOWNS["medium"])


@pytest.mark.parametrize("side", ["left", "right"])
def test_sleeves_leave_the_outside_and_loops_turn_from_body_to_hand(side):
    armhole, cuff = (MESH.vertices[MESH.loops[f"{name}_{side}"]] for name in ("armhole", "cuff"))
    normal = np.cross(armhole - armhole.mean(axis=0), np.roll(armhole, -1, axis=0) - armhole.mean(axis=0)).sum(axis=0)
    out = cuff.mean(axis=0) - armhole.mean(axis=0)
    assert out[1] == pytest.approx(MESH.spec.sleeve * MESH.spec.spacing)
    assert normal @ out > 0.9 * np.linalg.norm(normal) * np.linalg.norm(out)


def test_stays_add_springs_at_the_sleeves_only_and_no_borders():
    cloth, sewn = set(edge_counts(MESH.faces)), set(edge_counts(MESH.sewn))
    rings = len(MESH.loops["armhole_left"])
    assert cloth < sewn
    # from each vertex around a hole, ring by ring; and along the binding, but where a face spans the corner already
    assert 2 * rings * MESH.spec.sleeve < len(sewn - cloth) <= 2 * rings * (MESH.spec.sleeve + 1)
    middle = np.abs(MESH.vertices[:, 0]) < 0.3
    assert not any(middle[a] and middle[b] for a, b in sewn - cloth)


@pytest.mark.parametrize("wrong", [{"spacing": 0.0}, {"sleeve": 0}, {"strap": 0}, {"length": 5}])
def test_what_cannot_be_sewn_is_refused(wrong):
    with pytest.raises(CaretreeError, match="gown 'medium'"):
        dataclasses.replace(GOWNS["medium"], **wrong)


def test_a_gown_in_grams_is_told():
    with pytest.raises(CaretreeError, match="weighs 430 kg, but at most 5 kg"):
        GownSpec(name="mine", mass=430.0)
