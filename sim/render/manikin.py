"""What the person looks like to those who watch: a body with a face, hands and feet, inside the shape that counts.

The robot's cameras see the plain capsules of the physics (`bullet/backdrop.py`), which perception was tried on; this
body is for people's eyes alone.  It never reaches outside those capsules, so cloth that lies on them covers it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from .solids import Mesh, capsule_mesh, ellipsoid_mesh, join_meshes, loft_mesh

Part = tuple[str, Mesh, str]  # name, mesh, name of its colour
Capsule = tuple[np.ndarray, np.ndarray, float]
FINGERS = (-0.75, -0.25, 0.25, 0.75)  # places across the hand, in half widths of it
SNUG = 0.97  # of the capsules' size: cloth does not cut into what it lies on


def lying_parts(trunk: Mapping[str, Capsule]) -> list[Part]:
    """What of the person does not move, in the map frame.

    Args:
        trunk: name -> end, end and radius [m]; legs have `leg` in their name, the head has `head`.
    """
    parts: list[Part] = []
    chest = [capsule for name, capsule in trunk.items() if "leg" not in name and "head" not in name]
    if chest:
        parts.append(("torso", _torso(chest), "skin"))
    for name, capsule in trunk.items():
        if "leg" in name:
            parts += _leg(name, *capsule)
        elif "head" in name:
            parts += _head(*capsule)
    return parts


def arm_parts(radii: Sequence[float], lengths: Sequence[float], side: int) -> list[Mesh]:
    """Upper arm, forearm and hand, each along +z of its own frame.

    Args:
        radii: (3,) of the capsules [m].
        lengths: (3,) [m].
        side: 0 the left arm, 1 the right one: where the thumb is.
    """
    upper, forearm = (_limb(np.zeros(3), np.array((0.0, 0.0, lengths[k])), radii[k], _ARM[k]) for k in range(2))
    return [upper, forearm, _hand(radii[2], lengths[2], 1.0 if side else -1.0)]


# share of the length -> share of the radius
_ARM = (((0.0, 1.0), (0.3, 0.98), (0.7, 0.9), (1.0, 0.86)), ((0.0, 0.9), (0.25, 0.97), (0.7, 0.78), (1.0, 0.66)))
_LEG = ((0.0, 0.99), (0.2, 0.97), (0.42, 0.78), (0.5, 0.74), (0.62, 0.80), (0.8, 0.62), (0.95, 0.48), (1.0, 0.5))


def _limb(start: np.ndarray, end: np.ndarray, radius: float, shape: Sequence[tuple[float, float]]) -> Mesh:
    """A limb with rounded ends that swells and narrows."""
    shares, widths = np.array(shape).T
    along = np.linspace(0.0, 1.0, 12)
    body = loft_mesh(start, end, along, radius * SNUG * np.interp(along, shares, widths))
    caps = [
        capsule_mesh(point, point, radius * SNUG * width) for point, width in ((start, widths[0]), (end, widths[-1]))
    ]
    return join_meshes([body, *caps])


def _hand(radius: float, length: float, inward: float) -> Mesh:
    """Palm, four fingers and a thumb, flat across x."""
    palm = 0.5 * length
    half = 1.25 * radius  # of the palm's width, along y
    meshes = [ellipsoid_mesh(np.array((0.0, 0.0, 0.5 * palm)), np.array((0.62 * radius, half, 0.62 * palm)))]
    for k, place in enumerate(FINGERS):
        start = np.array((0.0, 0.8 * place * half, 0.8 * palm))
        reach = length * (0.93, 1.0, 0.98, 0.86)[k if inward > 0 else 3 - k]
        meshes.append(capsule_mesh(start, np.array((0.0, place * half, reach - 0.3 * radius)), 0.27 * radius, 8))
    root = np.array((0.0, -inward * 0.6 * half, 0.25 * palm))
    meshes.append(capsule_mesh(root, root + (0.0, -inward * 0.75 * half, 0.5 * palm), 0.32 * radius, 8))
    return join_meshes(meshes)


def _torso(chest: Sequence[Capsule]) -> Mesh:
    """One trunk around capsules that lie side by side: wide shoulders, a waist, hips."""
    ends = np.array([(a, b) for a, b, _ in chest])  # (n, 2, 3)
    radius = SNUG * float(np.mean([r for _, _, r in chest]))
    reach = float(np.ptp(ends[:, 0, 0])) / 2  # from the midline to a capsule's axis
    start, end = ends[:, 0].mean(axis=0), ends[:, 1].mean(axis=0)
    axis = (end - start) / np.linalg.norm(end - start)
    start, end = start - 0.9 * radius * axis, end + 0.9 * radius * axis
    angles = np.linspace(0, 2 * np.pi, 28, endpoint=False)
    rings = []
    for share in np.linspace(0.0, 1.0, 18):
        cap = np.sqrt(max(0.0, 1.0 - (max(0.0, 1.0 - share / 0.11, (share - 0.9) / 0.1)) ** 2)) or 0.02
        waist = 1.0 - 0.07 * np.exp(-(((share - 0.68) / 0.14) ** 2))
        flat = np.abs(np.cos(angles)) ** 0.7 * np.sign(np.cos(angles))
        x = flat * (reach + radius) * waist * (0.55 + 0.45 * cap)
        z = np.sin(angles) * radius * cap * (1.0 - 0.06 * np.exp(-((2.0 * x / (reach + radius)) ** 2)))
        rings.append(start + share * (end - start) + np.column_stack([x, np.zeros_like(x), z]))
    return _rings_mesh(np.array(rings))


def _rings_mesh(rings: np.ndarray) -> Mesh:
    """A closed skin through rings (n, m, 3) that turn the same way, ends shut."""
    n, m, _ = rings.shape
    vertices = np.vstack([rings.reshape(-1, 3), rings[0].mean(axis=0), rings[-1].mean(axis=0)])
    faces = []
    for i in range(n - 1):
        for j in range(m):
            a, b = i * m + j, i * m + (j + 1) % m
            faces += [(a, a + m, b), (b, a + m, b + m)]
    for j in range(m):
        faces += [(n * m, j, (j + 1) % m), (n * m + 1, (n - 1) * m + (j + 1) % m, (n - 1) * m + j)]
    faces = np.array(faces)
    middle = vertices.mean(axis=0)
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    if np.einsum("ij,ij->i", np.cross(b - a, c - a), (a + b + c) / 3 - middle).sum() < 0:
        faces = faces[:, ::-1]
    return vertices, faces


def _leg(name: str, hip: np.ndarray, foot: np.ndarray, radius: float) -> list[Part]:
    shin = _limb(hip, foot, radius, _LEG)
    shorts = loft_mesh(hip, foot, np.linspace(-0.09, 0.33, 6), np.full(6, radius))
    axis = (foot - hip) / np.linalg.norm(foot - hip)
    size = radius * SNUG
    sole = ellipsoid_mesh(foot + 0.30 * size * axis, np.array((0.42, 0.45, 0.84)) * size)
    return [(name, join_meshes([shin, sole]), "skin"), (f"{name}_shorts", shorts, "shorts")]


def _head(neck: np.ndarray, crown: np.ndarray, radius: float) -> list[Part]:
    """A head that looks up; crown: centre of the capsule's upper end."""
    size = radius * SNUG
    centre = crown + 0.12 * size * _unit(neck - crown)
    half = np.array((0.80, 1.12, 0.98)) * size
    head = ellipsoid_mesh(centre, half, 24)
    vertices, faces = ellipsoid_mesh(centre, half * np.array((1.045, 1.03, 1.02)), 24)
    middle = (vertices[faces].mean(axis=1) - centre) / half  # of each face of a skull-cap, in half axes
    hair = faces[(middle[:, 1] < -0.62) | ((middle[:, 2] < 0.05) & (middle[:, 1] < 0.35))]
    throat = loft_mesh(neck + (0, 0.5 * size, 0), centre, np.linspace(0, 1, 4), np.array((0.72, 0.6, 0.56, 0.6)) * size)
    skin, eyes = [head, throat], []

    def on_face(x: float, y: float, lift: float = 0.0) -> np.ndarray:
        """A place on the face, in half axes of the head from its middle."""
        z = np.sqrt(max(0.0, 1.0 - x * x - y * y))
        return centre + half * np.array((x, y, z)) + (0.0, 0.0, lift)

    for sign in (-1.0, 1.0):
        skin.append(
            ellipsoid_mesh(centre + half * np.array((sign * 1.0, -0.02, 0.0)), size * np.array((0.1, 0.2, 0.28)))
        )
        eyes.append(ellipsoid_mesh(on_face(sign * 0.40, -0.08, -0.04 * size), size * np.array((0.15, 0.07, 0.08)), 10))
        eyes.append(ellipsoid_mesh(on_face(sign * 0.42, -0.26, -0.02 * size), size * np.array((0.2, 0.035, 0.05)), 8))
    nose = on_face(0.0, 0.12)
    skin.append(ellipsoid_mesh(nose, size * np.array((0.11, 0.22, 0.13)), 10))
    mouth = ellipsoid_mesh(on_face(0.0, 0.5, -0.02 * size), size * np.array((0.26, 0.07, 0.06)), 10)
    return [
        ("head", join_meshes(skin), "skin"),
        ("hair", (vertices, hair), "hair"),
        ("eyes", join_meshes(eyes), "eyes"),
        ("mouth", mouth, "lips"),
    ]


def _unit(vector: np.ndarray) -> np.ndarray:
    return vector / max(float(np.linalg.norm(vector)), 1e-9)
