"""A small z-buffer rasteriser: triangles in, colour, depth and ids out.

The simulated cameras draw their own frames because neither of PyBullet's renderers will do: TinyRenderer
costs 35-135 ms a frame and EGL draws soft bodies black.  This one needs a few milliseconds for 15,000
triangles at 320x240 on one core, tells the two sides of cloth apart and needs no graphics driver.

Shading is Lambert plus ambient light, smooth over shared vertices, the same on both sides of a face.
Depth is interpolated as 1/z, which is exact for planes under perspective.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..compiled import njit

EXPOSURE = 0.82  # white under full light; the brightest ward (intensity 1.2) just does not burn out
WIDE = 8  # triangles wider than this are drawn by what each row has of them [px]
NEAR = 0.03  # clipping distance [m]: closer than any cloth a hand camera can focus on


@dataclass(frozen=True, kw_only=True)
class Triangles:
    """What is drawn, in the map frame.

    Attributes:
        vertices: (n, 3) [m].
        faces: (m, 3) int.
        front: (m, 3) colour seen from the side the winding faces, 0-255.
        back: (m, 3) colour seen from the other side.
        ids: (m,) int32, which body a face belongs to; never leaves `sim`.
        uv: (n, 2) coordinates of the print on the cloth [m].
        printed: (m,) bool, faces whose front carries the print.
    """

    vertices: np.ndarray
    faces: np.ndarray
    front: np.ndarray
    back: np.ndarray
    ids: np.ndarray
    uv: np.ndarray
    printed: np.ndarray


PATTERNS = ("dots", "stripes", "checks", "diamonds")


@dataclass(frozen=True, kw_only=True)
class Print:
    """What is printed on the cloth.

    Attributes:
        pattern: one of `PATTERNS`.
        pitch: distance between two of its marks [m].
        ink: what a mark leaves of the cloth's red, green and blue.
    """

    pattern: str = "dots"
    pitch: float = 0.035
    ink: tuple[float, float, float] = (0.62, 0.62, 0.62)


DOTS = Print()


@dataclass(frozen=True, kw_only=True)
class Light:
    """One distant lamp and the room's ambient light.

    Attributes:
        direction_in_map: (3,) unit vector towards the lamp.
        intensity: overall factor, 1 is a well-lit ward.
        ambient: share of the light that comes from everywhere.
    """

    direction_in_map: np.ndarray
    intensity: float = 1.0
    ambient: float = 0.58


@dataclass(frozen=True, kw_only=True)
class Picture:
    """A noiseless picture.

    Attributes:
        rgb: (H, W, 3) uint8.
        depth: (H, W) float32 along the optical axis [m], 0 where nothing was drawn.
        ids: (H, W) int32, -1 where nothing was drawn.
        cosine: (H, W) float32, between surface normal and ray; small values are grazing.
    """

    rgb: np.ndarray
    depth: np.ndarray
    ids: np.ndarray
    cosine: np.ndarray


@njit(nogil=True)
def _vertex_light(vertices, faces, lamp, ambient, intensity):
    """Light on the front and the back of every vertex, (n, 2)."""
    n = vertices.shape[0]
    normals = np.zeros((n, 3))
    for f in range(faces.shape[0]):
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        ux = vertices[b, 0] - vertices[a, 0]
        uy = vertices[b, 1] - vertices[a, 1]
        uz = vertices[b, 2] - vertices[a, 2]
        vx = vertices[c, 0] - vertices[a, 0]
        vy = vertices[c, 1] - vertices[a, 1]
        vz = vertices[c, 2] - vertices[a, 2]
        nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        for k in (a, b, c):
            normals[k, 0] += nx
            normals[k, 1] += ny
            normals[k, 2] += nz
    light = np.zeros((n, 2))
    for k in range(n):
        length = np.sqrt(normals[k, 0] ** 2 + normals[k, 1] ** 2 + normals[k, 2] ** 2) + 1e-12
        lambert = (normals[k, 0] * lamp[0] + normals[k, 1] * lamp[1] + normals[k, 2] * lamp[2]) / length
        light[k, 0] = intensity * (ambient + (1 - ambient) * max(0.0, lambert))
        light[k, 1] = intensity * (ambient + (1 - ambient) * max(0.0, -lambert))
    return light


@njit(inline="always", nogil=True)  # a call for every face would cost
def _clip_near(points, uv, light, faces, f, shade, near, closed, corner):
    """Clip face `f` against the near plane into `corner`; returns how many corners it has then: 0, 3 or 4."""
    count = 0
    if closed and shade == 1:  # the far side of a closed body: what is in front of it hides it
        return count
    for k in range(3):
        i, j = faces[f, k], faces[f, (k + 1) % 3]
        zi, zj = points[i, 2], points[j, 2]
        if zi > near:
            corner[count, 0], corner[count, 1], corner[count, 2] = points[i, 0], points[i, 1], zi
            corner[count, 3], corner[count, 4], corner[count, 5] = uv[i, 0], uv[i, 1], light[i, shade]
            count += 1
        if (zi > near) != (zj > near):
            s = (near - zi) / (zj - zi)
            for d in range(3):
                corner[count, d] = points[i, d] + s * (points[j, d] - points[i, d])
            corner[count, 3] = uv[i, 0] + s * (uv[j, 0] - uv[i, 0])
            corner[count, 4] = uv[i, 1] + s * (uv[j, 1] - uv[i, 1])
            corner[count, 5] = light[i, shade] + s * (light[j, shade] - light[i, shade])
            count += 1
    return count


@njit(inline="always", nogil=True)
def _marked(u, v, pattern, pitch):
    """Whether a place (u, v) [m] of the cloth carries ink."""
    row = np.floor(v / pitch)
    dv = v / pitch - row - 0.5
    if pattern == 0:  # dots of every other row are shifted
        du = (u / pitch + 0.5 * (row % 2)) % 1 - 0.5
        return du * du + dv * dv < 0.07
    du = (u / pitch) % 1 - 0.5
    if pattern == 1:
        return abs(du) < 0.2
    if pattern == 2:
        return (abs(du) < 0.25) != (abs(dv) < 0.25)
    return abs(du) + abs(dv) < 0.3


@njit(inline="always", nogil=True)
def _span(x0, y0, x1, y1, x2, y2, scale, y, left, right):
    """First and last pixel of row `y` that can be in a triangle, with one to spare: most of a large one's box is not.

    Nothing is cut off where rounding could put an edge a pixel aside.
    """
    first, last = float(left), float(right)
    size = max(max(x0, x1, x2) - min(x0, x1, x2), max(y0, y1, y2) - min(y0, y1, y2)) + right - left
    doubt = 1e-14 * size * size * abs(scale)
    w0 = ((x1 - left) * (y2 - y) - (y1 - y) * (x2 - left)) * scale
    w1 = ((x2 - left) * (y0 - y) - (y2 - y) * (x0 - left)) * scale
    for w, slope in ((w0, (y1 - y2) * scale), (w1, (y2 - y0) * scale), (1 - w0 - w1, (y0 - y1) * scale)):
        if slope > doubt:
            first = max(first, np.floor(left - w / slope) - 1)
        elif slope < -doubt:
            last = min(last, np.ceil(left - w / slope) + 1)
    return int(min(first, right + 1.0)), int(max(last, left - 1.0))


@njit(nogil=True)
def _draw(
    points, faces, front, back, ids, uv, printed, light, fx, fy, cx, cy, near, pattern, pitch, ink, closed, rgb, depth,
    owner, cosine,
):  # fmt: skip
    """Fill the buffers; `points` are in the optical frame."""
    height, width = depth.shape
    corner = np.empty((4, 6))  # x, y, z, u, v, light of the clipped polygon
    pixel = np.empty((4, 2))
    for f in range(faces.shape[0] - 1, -1, -1):  # rooms are added first: what stands in them hides them undrawn
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        ux, uy, uz = points[b, 0] - points[a, 0], points[b, 1] - points[a, 1], points[b, 2] - points[a, 2]
        vx, vy, vz = points[c, 0] - points[a, 0], points[c, 1] - points[a, 1], points[c, 2] - points[a, 2]
        nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        towards = -(nx * points[a, 0] + ny * points[a, 1] + nz * points[a, 2])
        outside = towards > 0
        shade = 0 if outside else 1
        norm = np.sqrt(nx * nx + ny * ny + nz * nz)
        distance = abs(towards) / (norm + 1e-15)  # from the camera to the plane of the face
        count = _clip_near(points, uv, light, faces, f, shade, near, closed[ids[f]], corner)
        for k in range(count):
            pixel[k, 0] = fx * corner[k, 0] / corner[k, 2] + cx
            pixel[k, 1] = fy * corner[k, 1] / corner[k, 2] + cy
        for t in range(count - 2):
            p, q, r = 0, t + 1, t + 2
            x0, y0, x1, y1 = pixel[p, 0], pixel[p, 1], pixel[q, 0], pixel[q, 1]
            x2, y2 = pixel[r, 0], pixel[r, 1]
            area = (x1 - x0) * (y2 - y0) - (y1 - y0) * (x2 - x0)
            if abs(area) < 1e-9:
                continue
            left = max(0, int(np.ceil(min(x0, x1, x2))))
            right = min(width - 1, int(np.floor(max(x0, x1, x2))))
            top = max(0, int(np.ceil(min(y0, y1, y2))))
            bottom = min(height - 1, int(np.floor(max(y0, y1, y2))))
            i0, i1, i2 = 1 / corner[p, 2], 1 / corner[q, 2], 1 / corner[r, 2]
            scale = 1 / area
            wide = right - left > WIDE
            first, last = left, right
            for y in range(top, bottom + 1):
                if wide:
                    first, last = _span(x0, y0, x1, y1, x2, y2, scale, y, left, right)
                for x in range(first, last + 1):
                    w0 = ((x1 - x) * (y2 - y) - (y1 - y) * (x2 - x)) * scale
                    w1 = ((x2 - x) * (y0 - y) - (y2 - y) * (x0 - x)) * scale
                    w2 = 1 - w0 - w1
                    if w0 < 0 or w1 < 0 or w2 < 0:
                        continue
                    inverse = w0 * i0 + w1 * i1 + w2 * i2
                    z = 1 / inverse
                    if depth[y, x] > 0 and z >= depth[y, x]:
                        continue
                    depth[y, x] = z
                    owner[y, x] = ids[f]
                    rx, ry = (x - cx) / fx, (y - cy) / fy
                    cosine[y, x] = distance / (z * np.sqrt(rx * rx + ry * ry + 1))
                    b0, b1, b2 = w0 * i0 * z, w1 * i1 * z, w2 * i2 * z
                    lit = b0 * corner[p, 5] + b1 * corner[q, 5] + b2 * corner[r, 5]
                    marked = False
                    if outside and printed[f]:
                        u = b0 * corner[p, 3] + b1 * corner[q, 3] + b2 * corner[r, 3]
                        v = b0 * corner[p, 4] + b1 * corner[q, 4] + b2 * corner[r, 4]
                        marked = _marked(u, v, pattern, pitch)
                    for d in range(3):
                        value = lit * (ink[d] if marked else 1.0) * (front[f, d] if outside else back[f, d])
                        rgb[y, x, d] = 255 if value > 255 else int(value)


def rasterise(
    triangles: Triangles,
    light: Light,
    intrinsics: tuple[float, float, float, float],
    pose_camera_in_map: np.ndarray,
    size: tuple[int, int],
    on_cloth: Print = DOTS,
    closed: bool | np.ndarray = False,
) -> Picture:
    """Draw `triangles` as a pinhole camera sees them.

    Args:
        triangles: the scene.
        light: lamp and ambient light.
        intrinsics: (fx, fy, cx, cy) [px].
        pose_camera_in_map: (4, 4), optical frame: x right, y down, z forward.
        size: (width, height) [px].
        on_cloth: the print.
        closed: (bodies,) bool by id, those whose far sides nobody can see: they need not be drawn.  True for all but
            body 0, the cloth.
    """
    width, height = size
    fx, fy, cx, cy = intrinsics
    if isinstance(closed, bool):
        closed = closed & (np.arange(triangles.ids.max(initial=0) + 1) > 0)
    vertices = np.ascontiguousarray(triangles.vertices, dtype=np.float64)
    faces = np.ascontiguousarray(triangles.faces, dtype=np.int64)
    rotation, origin = pose_camera_in_map[:3, :3], pose_camera_in_map[:3, 3]
    points = np.ascontiguousarray((vertices - origin) @ rotation)
    lit = _vertex_light(
        vertices,
        faces,
        np.asarray(light.direction_in_map, dtype=np.float64),
        float(light.ambient),
        EXPOSURE * float(light.intensity),
    )
    rgb = np.zeros((height, width, 3), dtype=np.uint8)
    depth = np.zeros((height, width), dtype=np.float32)
    ids = np.full((height, width), -1, dtype=np.int32)
    cosine = np.ones((height, width), dtype=np.float32)
    _draw(
        points,
        faces,
        np.ascontiguousarray(triangles.front, dtype=np.float64),
        np.ascontiguousarray(triangles.back, dtype=np.float64),
        np.ascontiguousarray(triangles.ids, dtype=np.int32),
        np.ascontiguousarray(triangles.uv, dtype=np.float64),
        np.ascontiguousarray(triangles.printed, dtype=np.bool_),
        lit,
        float(fx),
        float(fy),
        float(cx),
        float(cy),
        NEAR,
        PATTERNS.index(on_cloth.pattern),
        on_cloth.pitch,
        np.array(on_cloth.ink),
        closed,
        rgb,
        depth,
        ids,
        cosine,
    )
    return Picture(rgb=rgb, depth=depth, ids=ids, cosine=cosine)
