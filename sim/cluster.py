"""Calls on a Ray cluster: as many in flight as it has cores; a killed worker loses its own call only."""

from __future__ import annotations

import importlib
import itertools
from collections.abc import Callable, Iterable, Iterator
from typing import Any

from .errors import CaretreeError


class LostCallError(Exception):
    """The worker of a call was killed, or its machine has gone."""


class Cluster:
    """A Ray cluster while it is entered.

    Args:
        address: of it, `ray://HOST:10001`; None stands for this machine alone.
        jobs: calls in flight; None for as many as there are cores.
        what_for: named in the sentence that says that Ray is missing.

    Raises:
        CaretreeError: Ray is not installed, does not start, or no cluster answers.
    """

    def __init__(self, address: str | None, jobs: int | None, what_for: str) -> None:
        try:
            self._ray: Any = importlib.import_module("ray")
        except ImportError as error:
            raise CaretreeError(f"{what_for} needs Ray: pip install 'caretree[ray]'") from error
        try:
            if address is None:  # this machine alone: its loopback, whatever its network looks like
                self._ray.init(
                    num_cpus=jobs, include_dashboard=False, log_to_driver=False, _node_ip_address="127.0.0.1"
                )
            else:
                self._ray.init(address=address, log_to_driver=False)
        except Exception as error:  # Ray raises bare ones
            why = (str(error).splitlines() or [type(error).__name__])[0]
            raise CaretreeError(
                f"Ray does not start here: {why}" if address is None else f"no Ray cluster answers at {address}: {why}"
            ) from error
        self.jobs = jobs or max(1, int(self._ray.cluster_resources().get("CPU", 1)))

    def __enter__(self) -> Cluster:
        """Nothing more to do."""
        return self

    def __exit__(self, *unused: object) -> None:
        """Leave it; calls in flight are interrupted."""
        self._ray.shutdown()

    def share(self, value: Any) -> Any:
        """Send a value there once; what comes back stands for it among the arguments of calls."""
        return self._ray.put(value)

    def each(
        self, function: Callable[..., Any], calls: Iterable[tuple[Any, ...]], *, retries: int = 0
    ) -> Iterator[tuple[tuple[Any, ...], Any]]:
        """Each call's arguments with its result as it ends, or with a `LostCallError`; errors of the call are raised.

        Args:
            function: to be called.
            calls: its arguments; asked for one as soon as there is room for it.
            retries: further attempts for a call whose worker was lost.
        """
        remote = self._ray.remote(num_cpus=1, max_retries=retries)(function)
        waiting = iter(calls)
        flying: dict[Any, tuple[Any, ...]] = {}
        try:
            while True:
                for call in itertools.islice(waiting, self.jobs - len(flying)):
                    flying[remote.remote(*call)] = call
                if not flying:
                    return
                ready, _ = self._ray.wait(list(flying), num_returns=1)
                call = flying.pop(ready[0])
                try:
                    yield call, self._ray.get(ready[0])
                except self._ray.exceptions.RayTaskError as error:
                    raise error.as_instanceof_cause() from None
                except self._ray.exceptions.RayError as error:
                    yield call, LostCallError((str(error).strip().splitlines() or [type(error).__name__])[0])
        finally:
            for reference in flying:
                self._ray.cancel(reference)  # raises KeyboardInterrupt there: a run ends in the safe stop
