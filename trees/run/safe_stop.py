"""Makes the person and the robot safe, whatever the tree has left behind.

| step | what |
|---|---|
| halt | every node ends, leaves first, so that motions are cancelled |
| safe branches | of every fail-safe that was entered, innermost first |
| last resort | `world.stop()` until nothing moves, and the fingers opened where no safe branch did |

Errors are kept: nothing may keep the rest from happening.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from ...sim.blame import told
from ...sim.world import SIDES, GripperOpening, World
from ...skills.core.context import Context
from ...skills.core.skill import Skill
from ..guard.guard import GuardedWorld
from ..guard.limits import Limits
from ..nodes.decorators import FailSafe
from .ticker import Ticker

OPEN = 0.83  # of the stroke: fingers seen further apart than this hold nothing
OPENING_NOISE = 0.001  # [m] fingers that come closer by more than this are closing
CALM_TICKS = 5


class SafeStop:
    """The end of one run.

    Args:
        root: the tree.
        world: without the guard, for fingers that have to open whatever it says.
        guard: around it.
        context: shared by the skills.
        limits: those of safe branches and of stopping count.
        ticker: ticks the safe branches.
        before_tick: called before each tick.

    Attributes:
        interrupted: somebody pressed Ctrl-C meanwhile.
        refused: why the robot did not take the last stop, one clause; empty where it did.
    """

    def __init__(
        self,
        root: Behaviour,
        world: World,
        guard: GuardedWorld,
        context: Context,
        limits: Limits,
        *,
        ticker: Ticker,
        before_tick: Callable[[], None],
    ) -> None:
        self.interrupted = False
        self.refused = self._last_error = ""
        self._root, self._world, self._guard, self._context = root, world, guard, context
        self._limits, self._ticker, self._before_tick = limits, ticker, before_tick

    def halt(self, node: Behaviour) -> None:
        """End every node below `node`, leaves first, even where an exception left the statuses inconsistent."""
        for each in node.iterate():
            self._ticker.limit.start()
            try:
                if isinstance(each, Skill):
                    each.terminate(Status.INVALID)
                    each.status = Status.INVALID
                elif each.status != Status.INVALID:
                    each.stop(Status.INVALID)
            except KeyboardInterrupt:
                raise
            except BaseException as error:  # drivers raise even what is no Exception
                self._context.report(error)
                each.status = Status.INVALID
                self._context.lease.release(each)
        self._ticker.limit.pause()
        self._ticker.sweep()

    def run_branches(self) -> None:
        """Tick the safe branch of every fail-safe that was entered, innermost first."""
        for node in [each for each in self._root.iterate() if isinstance(each, FailSafe) and each.entered]:
            try:
                node.made_safe = self._tick_safe(node.safe)
                node.entered = not node.made_safe
            except KeyboardInterrupt:  # the operator insists: leave the rest to the last resort
                self.interrupted = True
                return
            except BaseException as error:
                self._context.report(error)
                node.made_safe = False
            finally:
                self.halt(node.safe)

    def last_resort(self, release: bool = True) -> bool:
        """Stop until nothing moves, open the fingers if asked to; True when the robot stands still.

        A command may be lost on its way, so stop and open are sent until they are seen to have worked for some
        ticks on end.  Whatever of the robot is asked here may raise: nothing of it keeps the rest from being sent.
        """
        ends = self._try(self._context.now, default=-np.inf) + self._limits.stop_patience
        calm, wanted = 0, CALM_TICKS if release else 2  # one look may be older than the motion
        before = np.zeros(2)
        for _ in range(10_000):  # a dead clock must not keep us here
            self._try(self._ticker.begin)
            self._try(self._ticker.advance_lease)
            self._stop_and_open(release)
            rests = not self.refused and self._try(self._guard.still, default=False)
            opened, before = self._try(partial(self._fingers, before), default=(False, np.zeros(2)))
            done = rests and (opened or not release) and not self._context.lease.releasing()
            calm = calm + 1 if done else 0
            if calm >= wanted or self._try(self._context.now, default=np.inf) >= ends:
                break
            if self._try(lambda: self._ticker.pass_time() or True, default=False) is False:
                break
        self._context.lease.clear()
        self._stop_and_open(release and calm == 0)  # the first ones may have been lost where no time could pass
        return calm > 0

    def _stop_and_open(self, release: bool) -> None:
        """Send both, whatever comes of it; the fingers after the stop, which leaves them where they are."""
        stopped = self._try(lambda: self._guard.stop() or True, default=False)
        self.refused = "" if stopped else f"stop() failed: {self._last_error}"
        widest = self._world.robot.gripper.stroke
        for side in SIDES if release else ():
            self._try(lambda side=side: self._world.send(GripperOpening(side=side, opening=widest)))

    def _fingers(self, before: np.ndarray) -> tuple[bool, np.ndarray]:
        """Whether they are seen open and not closing, or cannot move; and how far apart they stand (2,) [m]."""
        seen = self._guard.observe()
        opening = seen.gripper_opening
        released = OPEN * self._world.robot.gripper.stroke
        opened = (opening >= released).all() and (opening >= before - OPENING_NOISE).all()
        return bool(opened or seen.emergency_stop), opening

    def _tick_safe(self, safe: Behaviour) -> bool:
        """Tick a safe branch to its end; False when it fails or takes too long."""
        ends = self._context.now() + self._limits.safe_branch
        while self._context.now() < ends:
            self._guard.check()  # stops on excess load; dead senses no longer change what has to be done
            if self._context.lease.stuck() is not None:
                self._guard.stop()  # releasing the person matters more than whose turn it is
                self._context.lease.clear()
            self._before_tick()
            self._ticker.tick(safe)
            if safe.status != Status.RUNNING:
                return safe.status == Status.SUCCESS
            self._ticker.pass_time()
        return False

    def _try(self, action: Callable[[], Any], default: Any = None) -> Any:
        self._ticker.limit.start()
        try:
            return action()
        except BaseException as error:
            self.interrupted |= isinstance(error, KeyboardInterrupt)
            self._context.report(error)
            self._last_error = told(error)
            return default
        finally:
            self._ticker.limit.pause()
