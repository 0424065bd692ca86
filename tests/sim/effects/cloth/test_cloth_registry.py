import numpy as np
import pytest
from caretree.sim.effects.cloth.cloth_effect import ClothSettings, ProxyState
from caretree.sim.effects.cloth.cloth_registry import CLOTH_EFFECTS
from caretree.sim.effects.cloth.proxy_bodies import ClothPatch, spread_vertices
from caretree.sim.effects.effect import EffectError
from caretree.sim.effects.model_file import EffectEntry

GIVEN = ClothSettings(friction=0.4, gravity=(0.0, 0.0, -9.81))


def sheet(n=8, h=0.05):
    v = np.array([(i * h, 0.0, 1.0 - j * h) for j in range(n) for i in range(n)])
    f = np.array(
        [
            t
            for j in range(n - 1)
            for i in range(n - 1)
            for a in [j * n + i]
            for t in ((a, a + n, a + 1), (a + 1, a + n, a + n + 1))
        ]
    )
    return v, f


def state(seed=0, capsules=()):
    rng = np.random.default_rng(seed)
    x = rng.normal(size=(6, 3))
    return ProxyState(
        t=1.0,
        x=x,
        v=rng.normal(size=(6, 3)),
        start=x - 0.1,
        mass=np.full(6, 0.01),
        area=np.full(6, 0.02),
        pairs=np.array([(0, 1), (1, 2), (4, 5)]),
        lengths=np.full(3, 0.1),
        capsules=np.array(capsules).reshape(-1, 7),
        gravity=np.array(GIVEN.gravity),
    )


def test_drag_takes_power_from_every_proxy_body():
    s = state()
    force = CLOTH_EFFECTS["air_drag"].forces(s, {"coefficient": 1.0})
    assert np.all(np.sum(force * s.v, axis=1) < 0)


def test_stiffening_pulls_neighbours_together_and_sums_to_zero():
    force = CLOTH_EFFECTS["strain_stiffening"].forces(state(), {"stiffness": 10.0, "onset": 0.1})
    assert np.allclose(force.sum(axis=0), 0.0)
    assert np.allclose(force[3], 0.0)


def test_adhesion_pulls_towards_the_body_and_only_near_it():
    s = state(capsules=np.array([[-1.0, 0, 0, 1.0, 0, 0, 0.05]]))
    x = s.x.copy()
    x[0], x[1] = (0.0, 0.0, 0.06), (0.0, 0.0, 0.5)
    near = ProxyState(**{**s.__dict__, "x": x})
    force = CLOTH_EFFECTS["adhesion"].forces(near, {"pressure": 10.0})
    assert force[0, 2] < 0
    assert np.allclose(force[1], 0.0)


def test_tilt_keeps_the_size_of_gravity():
    tilted = CLOTH_EFFECTS["tilted_gravity"].settings(GIVEN, {"towards_x": 0.2, "towards_y": 0.0})
    assert np.linalg.norm(tilted.gravity) == pytest.approx(9.81)
    assert tilted.gravity[0] > 0


def test_delay_reads_the_past():
    t = np.linspace(0, 1, 101)
    markers = np.repeat(t[:, None, None], 3, axis=2)
    late = CLOTH_EFFECTS["delay"].read(t, markers, {"time": 0.1})
    assert late[50, 0, 0] == pytest.approx(0.4)


def test_proxy_bodies_are_spread_and_avoid_pins():
    v, _ = sheet()
    chosen = spread_vertices(v, 9, {0, 7})
    assert len(set(chosen)) == 9
    assert not {0, 7} & set(chosen)
    away = np.linalg.norm(v[chosen][:, None] - v[chosen][None], axis=2)
    assert away[~np.eye(9, dtype=bool)].min() > 0.09


def test_added_mass_is_shared_by_the_proxy_bodies_in_its_region():
    share = CLOTH_EFFECTS["added_mass"].share(state().start, {"mass": 0.3, "x": 0.0, "y": 0.0, "z": 0.0, "radius": 1.0})
    assert share.sum() == pytest.approx(0.3)
    assert np.all(share >= 0)


def test_mass_of_the_proxy_bodies_is_taken_off_the_cloth():
    v, f = sheet()
    entry = EffectEntry(name="air_drag", target="cloth", parameters={"coefficient": 1.0})
    patch = ClothPatch((entry,), v, f, 0.2, GIVEN)
    assert patch.cloth_mass == pytest.approx(0.2 - 5e-4 * len(patch.vertices))
    assert ClothPatch((), v, f, 0.2, GIVEN).cloth_mass == 0.2


def test_every_effect_refuses_parameters_it_does_not_have():
    for effect in CLOTH_EFFECTS.values():
        with pytest.raises(EffectError, match="it takes"):
            effect.check({"nonsense": 1.0})
