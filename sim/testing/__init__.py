"""For tests of one's own world: `from caretree.sim.testing import check_world`."""

from .check_world import LAWS as LAWS
from .check_world import check_world as check_world
from .world_trial import Breaks as Breaks
from .world_trial import WorldLawBroken as WorldLawBroken
