"""Proves without running that every input has been written, with the right type, on every way to its reader."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from typing import Any

import py_trees
from py_trees.behaviour import Behaviour
from py_trees.common import ParallelPolicy

from ...skills.core.ports import Key, assignable, type_name
from ...skills.core.skill import Skill
from ..nodes.condition import Condition, inputs_of
from ..nodes.decorators import FailSafe, RecoverBy, Retry, Stage, Timeout

Have = dict[str, Any]  # key -> type of what is written there on every way


def written_below(node: Behaviour) -> set[str]:
    """Keys that any skill below `node` writes."""
    return {
        bound.name
        for leaf in node.iterate()
        if isinstance(leaf, Skill)
        for name, _ in leaf.outputs()
        if isinstance(bound := leaf.bindings[name], Key)
    }


def common(options: Iterable[Have]) -> Have:
    """What is there whichever way was taken; a key of different types is there as neither."""
    ways = list(options)
    if not ways:
        return {}
    return {key: kind for key, kind in ways[0].items() if all(key in way and way[key] == kind for way in ways[1:])}


def without(have: Have, keys: set[str]) -> Have:
    """`have` less `keys`."""
    return {key: kind for key, kind in have.items() if key not in keys}


class Wiring:
    """Follows the data through a tree.

    Args:
        paths: node -> how it is called in findings.

    Attributes:
        findings: one sentence for each fault.
    """

    def __init__(self, paths: dict[Behaviour, str]) -> None:
        self.findings: list[str] = []
        self._paths = paths
        self._writers: dict[str, list[str]] = {}
        self._words: dict[str, str] = {}  # of keys that are written, as their authors wrote them

    def check(self, root: Behaviour) -> None:
        """Follow the data from an empty board."""
        for leaf in root.iterate():
            if isinstance(leaf, Skill):
                for name, _ in leaf.outputs():
                    if isinstance(bound := leaf.bindings[name], Key):
                        self._writers.setdefault(bound.name, []).append(leaf.name)
                        self._words.setdefault(bound.name, bound.word)
        self._flow(root, {})

    def _flow(self, node: Behaviour, have: Have) -> tuple[Have, Have]:
        """What is written after `node` succeeded, and after it failed."""
        if isinstance(node, Skill):
            return self._skill(node, have)
        if isinstance(node, Condition):
            kinds = inputs_of(node.test)
            self._reads(node, {name: (key, kinds.get(name, Any)) for name, key in node.reads().items()}, have)
            return have, have
        if isinstance(node, (Retry, RecoverBy)):
            return self._repeated(node, have)
        if isinstance(node, FailSafe):
            done, _ = self._flow(node.body, have)
            _, after = self._flow(node.safe, without(have, written_below(node.body)))
            return done, after
        if isinstance(node, Timeout):
            done, failed = self._flow(node.body, have)
            return done, without(common((failed, have)), written_below(node.body))
        if isinstance(node, Stage):
            ready, refused = self._flow(node.precondition, have) if node.precondition else (have, have)
            done, failed = self._flow(node.body, ready)
            return done, common((failed, refused))
        if isinstance(node, py_trees.composites.Sequence):
            return self._sequence(node, have)
        if isinstance(node, py_trees.composites.Selector):
            return self._fallback(node, have)
        if isinstance(node, py_trees.composites.Parallel):
            return self._parallel(node, have)
        if node.children:  # some decorator of py_trees: its child may have ended either way
            ways = common(way for child in node.children for way in self._flow(child, have))
            return ways, ways
        return have, have

    def _skill(self, skill: Skill, have: Have) -> tuple[Have, Have]:
        inputs = {name: (bound, p.kind) for name, p in skill.inputs() if isinstance(bound := skill.bindings[name], Key)}
        self._reads(skill, inputs, have)
        mine = {
            bound.name: port.kind for name, port in skill.outputs() if isinstance(bound := skill.bindings[name], Key)
        }
        kept = without(have, set(mine))
        return {**kept, **mine}, kept

    def _reads(self, leaf: Behaviour, inputs: dict[str, tuple[Key, Any]], have: Have) -> None:
        for name, (key, kind) in inputs.items():
            if key.name not in have:
                writers = ", ".join(repr(each) for each in self._writers.get(key.name, [])) or self._nobody(key.name)
                self._say(
                    f"{self._paths[leaf]}: input {name} reads {key.told}, which is not written on every way "
                    f"to here (written by {writers})"
                )
            elif not assignable(have[key.name], kind):
                self._say(
                    f"{self._paths[leaf]}: input {name} takes {type_name(kind)}, but {key.told} "
                    f"holds {type_name(have[key.name])}"
                )

    def _nobody(self, key: str) -> str:
        near = difflib.get_close_matches(key, self._words, n=1)
        return f"nobody; did you mean {self._words[near[0]]}?" if near else "nobody"

    def _repeated(self, node: Retry | RecoverBy, have: Have) -> tuple[Have, Have]:
        """A later attempt begins with the body's own data unset, so the body may not count on it."""
        start = without(have, written_below(node.body)) if node.attempts > 1 else have
        done, failed = self._flow(node.body, start)
        ways = [failed]
        if isinstance(node, RecoverBy):
            lost: set[str] = set()
            for recovery in dict.fromkeys(node.recoveries.values()):
                recovered, broken = self._flow(recovery, failed)
                ways += [recovered, broken]
                lost |= {key for key in written_below(recovery) if recovered.get(key, done) != done.get(key)}
            done = without(done, lost)  # a recovery may have unset them, or written something else there
        return done, without(common(ways), written_below(node.body))

    def _sequence(self, node: Behaviour, have: Have) -> tuple[Have, Have]:
        failures = []
        for child in node.children:
            have, failed = self._flow(child, have)
            failures.append(failed)
        return have, common(failures)

    def _fallback(self, node: Behaviour, have: Have) -> tuple[Have, Have]:
        successes = []
        for child in node.children:
            done, have = self._flow(child, have)
            successes.append(done)
        return common(successes), have

    def _parallel(self, node: py_trees.composites.Parallel, have: Have) -> tuple[Have, Have]:
        ways = [self._flow(child, have) for child in node.children]
        failed = without(have, written_below(node))
        if isinstance(node.policy, ParallelPolicy.SuccessOnAll):
            return {key: kind for done, _ in ways for key, kind in done.items()}, failed
        return common(done for done, _ in ways), failed

    def _say(self, sentence: str) -> None:
        if sentence not in self.findings:
            self.findings.append(sentence)
