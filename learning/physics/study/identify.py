"""Six parameters with intervals from one clip, for a person and as a gown file."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ....sim.errors import CaretreeError
from ....sim.scene.gown import GOWNS, GownSpec
from ....sim.scene.gown_file import GownFile, write_gown
from ..clips.camera import ClipCamera
from ..clips.clip import Clip
from ..clips.frames import look_at
from ..clips.gown_cuts import same_cut
from ..clips.parameters import NAMES, PARAMETERS, to_values
from ..methods.gp_inversion import GPInversion
from ..methods.simulator import Simulator

# Distance, in scores, to the nearest clip learned from.  Of 240 clips of gowns of three cuts, at the corners of the
# range too, it was at most 1.14, of 15 by PyBullet 1.21; of a person, a wall, noise and a gown upside down 1.5 to 13.
# A small box, 2.1 from gowns of the usual cut, is 1.1 from those of other cuts: only simulating tells it from one.
UNLIKE_ANY = 1.4
HOPELESS = 1.0  # misfit, in scores, of clips of two gowns that have nothing in common; good ones stay below 0.3


@dataclass(frozen=True, kw_only=True)
class Identified:
    """Parameters of one gown in their own units.

    Attributes:
        cut: name of the cut that was simulated.
        values: (6,) estimates.
        lower: (6,) lower ends of the 90 % intervals.
        upper: (6,) upper ends.
        misfit: of the simulated clip, over the usual misfit; far above one says that the clip is not explained.
        rough: whether the clip has the gaps of a real camera.
    """

    cut: str
    values: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    misfit: float
    rough: bool

    def table(self) -> str:
        """What the command prints."""
        lines = [f"{'parameter':<10} {'value':>10}   {'90 % interval':^23}  unit"]
        for k, p in enumerate(PARAMETERS):
            note = "" if p.shown else "   not shown by a fall: the middle of the range"
            lines.append(
                f"{p.name:<10} {self.values[k]:>10.4g}   {self.lower[k]:>10.4g} to {self.upper[k]:<10.4g}{p.unit}{note}"
            )
        return "\n".join(lines)

    def gown(self) -> GownFile:
        """The gown file's content."""
        numbers = zip(NAMES, self.values, self.lower, self.upper, strict=True)
        values, intervals = {}, {}
        for name, value, low, high in numbers:
            values[name], intervals[name] = float(value), (float(low), float(high))
        return GownFile(base=self.cut, values=values, intervals=intervals)


def identify(
    clip: Clip, method: GPInversion, cut: str = "medium", *, simulate: bool = True, trained: GownSpec = GOWNS["medium"]
) -> Identified:
    """Parameters of the gown in a clip.

    Args:
        clip: what was seen.
        method: fitted, see weights.py.
        cut: the gown's cut, a name in `GOWNS`: its size is seen before it is hung up, its cloth is not.
        simulate: whether to correct the answer by simulating it (unless the intervals are not calibrated).
        trained: a gown of the usual cut, that most clips trained on show.

    Raises:
        CaretreeError: unknown cut, or a clip that no gown of this cut explains.
    """
    if cut not in GOWNS:
        raise CaretreeError(f"unknown gown '{cut}'; there are {', '.join(GOWNS)}")
    camera = ClipCamera(pose_camera_in_map=clip.pose_camera_in_map, intrinsics=clip.intrinsics)
    seen = look_at(clip.depth[None])
    other = not same_cut(GOWNS[cut], trained)
    inversion = method.sort(bool(seen.rough[0]), other)
    way = "simulated" if simulate and "simulated" in inversion.widths else "alone"  # intervals must be calibrated
    if way == "simulated":
        raw = inversion.simulated(seen.frames, Simulator(GOWNS[cut], camera), blunt=other)
    else:
        raw = inversion.alone(seen.frames)
    found = inversion.judged(way, *raw)
    if way == "simulated" and found.misfit[0] > HOPELESS:
        raise CaretreeError(
            f"no falling gown of the cut '{cut}' looks like this clip: even the nearest one is as far "
            "off as any gown is"
        )
    if way == "alone" and found.misfit[0] > UNLIKE_ANY:
        raise CaretreeError(
            f"no falling gown of the cut '{cut}' looks like this clip: it is {found.misfit[0]:.1f} from the nearest "
            f"one learned from, and gowns are at most {UNLIKE_ANY:g} from it"
        )
    usual = inversion.widths[way].after.usual_misfit
    values = to_values(found.unit[0])
    lower, upper = (np.where(end == found.unit[0], values, to_values(end)) for end in (found.lower[0], found.upper[0]))
    return Identified(
        cut=cut,
        values=values,
        lower=np.minimum(lower, values),
        upper=np.maximum(upper, values),
        misfit=float(found.misfit[0] / usual),
        rough=bool(seen.rough[0]),
    )


def write(identified: Identified, path: str | Path) -> Path:
    """Write the gown file that `caretree run dressing --gown FILE` loads."""
    return write_gown(path, identified.gown())
