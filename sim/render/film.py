"""One picture of the video: the room, the hands from close by, what the head camera saw last, and a caption."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from .camera import intrinsics_of
from .raster import Light, Triangles, rasterise
from .shading import ShadowMap, shaded, shadow_map
from .view_choice import ViewChoice, Viewpoint

FILM_SIZE = (1280, 720)  # [px]
ROOM_SIZE, HANDS_SIZE, HEAD_SIZE = (832, 624), (448, 336), (384, 288)  # the three pictures in it [px]
ROOM_VIEW, HANDS_VIEW = np.deg2rad(52.0), np.deg2rad(46.0)
INK, SOFT, GROUND = (238, 240, 242), (158, 166, 174), (24, 27, 31)


@dataclass(frozen=True)
class Caption:
    """What is going on: the stage of the task and the skill at work."""

    stage: str = ""
    skill: str = ""


@dataclass(frozen=True, kw_only=True)
class Moment:
    """All that one picture shows.

    Attributes:
        time: world clock [s].
        triangles: the room.
        hands: (n, 3) points of the robot's hands [m].
        head: (H, W, 3) uint8 what the head camera saw last, and when [s]; None before it has looked.
        caption: what is going on.
    """

    time: float
    triangles: Triangles
    hands: np.ndarray
    head: tuple[np.ndarray, float] | None = None
    caption: Caption = Caption()


class Film:
    """Draws the pictures of one run, in order of time.

    Args:
        light: of the room.
        shell: ids of the bodies that throw no shadow.
    """

    def __init__(self, light: Light, shell: tuple[int, ...]) -> None:
        self._light, self._shell = light, shell
        self._room = ViewChoice(ROOM_VIEW, close=False)
        self._hands = ViewChoice(HANDS_VIEW, close=True)

    def draw(self, moment: Moment) -> np.ndarray:
        """The picture (720, 1280, 3) uint8."""
        triangles = moment.triangles
        shadows = shadow_map(triangles, self._light, ~np.isin(triangles.ids, self._shell))
        room = self._room.at(moment.time, triangles, self._light, moment.hands)
        hands = self._hands.at(moment.time, triangles, self._light, moment.hands, room)
        picture = np.empty((FILM_SIZE[1], FILM_SIZE[0], 3), np.uint8)
        picture[:] = GROUND
        width, height = ROOM_SIZE
        picture[:height, :width] = self._view(room, ROOM_VIEW, ROOM_SIZE, triangles, shadows)
        picture[: HANDS_SIZE[1], width:] = self._view(hands, HANDS_VIEW, HANDS_SIZE, triangles, shadows)
        left = width + (HANDS_SIZE[0] - HEAD_SIZE[0]) // 2
        if moment.head is not None:
            import cv2

            seen = cv2.resize(moment.head[0], HEAD_SIZE, interpolation=cv2.INTER_LINEAR)
            picture[HANDS_SIZE[1] : height, left : left + HEAD_SIZE[0]] = seen
        picture[height:] = _strip(moment.caption, round(moment.time, 1))
        _label(picture, "room", (12, 8))
        _label(picture, "hands", (width + 12, 8))
        seen_at = "" if moment.head is None else f", {moment.head[1]:.1f} s"
        _label(picture, f"head camera{seen_at}", (width + 12, HANDS_SIZE[1] + 8))
        return picture

    def _view(
        self, view: Viewpoint, field: float, size: tuple[int, int], triangles: Triangles, shadows: ShadowMap
    ) -> np.ndarray:
        intrinsics, pose = intrinsics_of(size, field), view.pose
        return shaded(rasterise(triangles, self._light, intrinsics, pose, size, closed=True), pose, intrinsics, shadows)


@lru_cache(maxsize=4)
def _font(size: int):
    """DejaVu Sans, which comes with matplotlib."""
    from matplotlib import get_data_path
    from PIL import ImageFont

    return ImageFont.truetype(f"{get_data_path()}/fonts/ttf/DejaVuSans.ttf", size)


def _strip(caption: Caption, time: float) -> np.ndarray:
    """Stage and skill on the left, time on the right (96, 1280, 3)."""
    from PIL import Image, ImageDraw

    image = Image.new("RGB", (FILM_SIZE[0], FILM_SIZE[1] - ROOM_SIZE[1]), GROUND)
    draw = ImageDraw.Draw(image)
    draw.text((20, 12), _cut(caption.stage, 60), font=_font(30), fill=INK)
    draw.text((20, 56), _cut(caption.skill, 90), font=_font(21), fill=SOFT)
    draw.text((FILM_SIZE[0] - 20, 12), f"{time:.1f} s", font=_font(30), fill=INK, anchor="ra")
    return np.asarray(image)


@lru_cache(maxsize=64)
def _word(text: str) -> np.ndarray:
    """A few words in white on black, (h, w) 0 to 1."""
    from PIL import Image, ImageDraw

    box = _font(15).getbbox(text)
    image = Image.new("L", (int(box[2]) + 12, 22))
    ImageDraw.Draw(image).text((6, 2), text, font=_font(15), fill=255)
    return np.asarray(image, dtype=np.float32) / 255


def _label(picture: np.ndarray, text: str, place: tuple[int, int]) -> None:
    """Write into a corner of a view, on a darkened ground."""
    word = _word(text)
    x, y = place
    ground = picture[y : y + word.shape[0], x : x + word.shape[1]]
    ground[:] = (0.45 * ground * (1 - word[..., None]) + 235 * word[..., None]).astype(np.uint8)


def _cut(text: str, letters: int) -> str:
    return text if len(text) <= letters else f"{text[: letters - 1]}…"
