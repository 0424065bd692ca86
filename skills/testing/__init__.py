"""For tests of one's own skills: `from caretree.skills.testing import check_skill`."""

from .bench import Bench as Bench
from .bench import OpenGuard as OpenGuard
from .laws import LAWS as LAWS
from .laws import LawBroken as LawBroken
from .laws import check_skill as check_skill
from .no_truth import find_leaks as find_leaks
from .piped_world import PipedWorld as PipedWorld
