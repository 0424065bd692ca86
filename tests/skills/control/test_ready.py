"""What happens where no way to the ready posture is found."""

import pytest
from caretree.skills import Reason, Skill, SkillFailure
from caretree.skills.control.ready import ready_or_not
from caretree.skills.core.ports import Input
from caretree.skills.motion.errors import MotionBlocked
from caretree.skills.testing import Bench
from py_trees.common import Status


class LetGo(Skill):
    """Lets go; the ready posture cannot be reached, or a command is lost as often as it is told."""

    ready = Input(str, doc="as of ready_or_not")
    problems = Input(list, doc="raised one after the other")
    reasons = (Reason.COMMAND_LOST, Reason.MOTION_BLOCKED)

    def steps(self):
        self.done = []
        yield from ready_or_not(self, self.ready, self._let_go)

    def _let_go(self, ready):
        self.done.append(ready)
        yield
        if self.problems:
            raise self.problems.pop(0)


def run(ready, *problems):
    bench = Bench(lambda context: LetGo("let go", context, ready=ready, problems=list(problems)))
    return bench.run(100), bench.skill


@pytest.mark.parametrize(("ready", "asked"), [("always", [True]), ("if possible", [True]), ("never", [False])])
def test_where_nothing_goes_wrong_it_is_done_once(ready, asked):
    status, skill = run(ready)
    assert (status, skill.done) == (Status.SUCCESS, asked)


@pytest.mark.parametrize("problem", [MotionBlocked("no way"), SkillFailure(Reason.COMMAND_LOST)])
def test_if_possible_does_all_once_more_without_the_posture(problem):
    status, skill = run("if possible", problem)
    assert (status, skill.done) == (Status.SUCCESS, [True, False])


def test_a_second_problem_ends_it_with_its_own_reason():
    status, skill = run("if possible", MotionBlocked("no way"), SkillFailure(Reason.COMMAND_LOST))
    assert (status, skill.failure.reason) == (Status.FAILURE, Reason.COMMAND_LOST)


@pytest.mark.parametrize("ready", ["always", "never"])
def test_otherwise_the_first_problem_ends_it(ready):
    status, skill = run(ready, MotionBlocked("no way"))
    assert (status, len(skill.done)) == (Status.FAILURE, 1)
