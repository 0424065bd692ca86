"""A stand-in for Ray that calls in this process, one call after the other."""

from types import SimpleNamespace


class RayError(Exception):
    """The base of Ray's errors."""


class RayTaskError(RayError):
    """An error of the call itself."""

    def as_instanceof_cause(self):
        return self.__cause__


class FakeRay:
    """Has what `caretree.sim.cluster` uses of Ray.

    Attributes:
        killed: first arguments of the calls whose worker is lost.
        cancelled: first arguments of the calls that were cancelled.
    """

    exceptions = SimpleNamespace(RayError=RayError, RayTaskError=RayTaskError)

    def __init__(self, cores):
        self.cores, self.killed, self.cancelled = cores, set(), []
        self.flying, self.most_in_flight, self.left = {}, 0, False

    def init(self, **asked):
        if asked.get("address") == "ray://nobody":
            raise ConnectionError("timeout\nand more")

    def cluster_resources(self):
        return {"CPU": float(self.cores)}

    def put(self, value):
        return value

    def remote(self, **options):
        def bind(function):
            def start(*call):
                reference = object()
                self.flying[reference] = (function, call)
                self.most_in_flight = max(self.most_in_flight, len(self.flying))
                return reference

            return SimpleNamespace(remote=start)

        return bind

    def wait(self, references, num_returns):
        return references[:num_returns], references[num_returns:]

    def get(self, reference):
        function, call = self.flying.pop(reference)
        if call[0] in self.killed:
            raise RayError("The worker died unexpectedly.\nand more")
        try:
            return function(*call)
        except Exception as error:
            raise RayTaskError from error

    def cancel(self, reference):
        self.cancelled.append(self.flying[reference][1][0])

    def shutdown(self):
        self.left = True
