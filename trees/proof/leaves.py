"""What is wrong with single leaves, as far as it shows before a run."""

from __future__ import annotations

from py_trees.behaviour import Behaviour

from ...sim.errors import CaretreeError
from ...skills.core.context import Context
from ...skills.core.reasons import SkillFailure
from ...skills.core.skill import Skill
from ..nodes.condition import Condition
from ..run.time_limit import LOADING, TimeLimit, TookTooLongError


def leaf_findings(root: Behaviour, context: Context, paths: dict[Behaviour, str]) -> list[str]:
    """One sentence for each fault of a leaf of a tree that was built with `context` on its scripted world."""
    found = []
    for node in root.iterate():
        wrong = ""
        if isinstance(node, Skill):
            wrong = _of_skill(node, context)
        elif isinstance(node, Condition) and not node.reads():
            wrong = _asked(node, context)
        found += [f"{paths[node]}: {wrong}"] if wrong else []
    return found


def _of_skill(skill: Skill, context: Context) -> str:
    kind = type(skill)
    if skill.context is not context:
        return "it was built with another context than build() was given, so that neither guard nor faults reach it"
    if kind.start is not Skill.start and kind.step is Skill.step:
        return f"{kind.__name__} has start(), but no step()"
    if kind.start is Skill.start and kind.steps is Skill.steps:
        return f"{kind.__name__} has no steps(), nor start() and step()"
    return ""


def _asked(condition: Condition, context: Context) -> str:
    """A condition moves nothing: it can be asked.  What it answers is not the question, but whether it does."""
    try:
        with TimeLimit(LOADING):
            bool(condition.test(context, **condition.bindings))
    except (SkillFailure, CaretreeError):  # it may need what an earlier skill has seen or written
        return ""
    except TookTooLongError as error:
        return f"asked on the scripted world, {error}"
    except SystemExit as error:
        return f"asked on the scripted world, it calls sys.exit({error.code!r})"
    except Exception as error:
        return f"asked on the scripted world, it makes an error: {type(error).__name__}: {error}"
    return ""
