"""A world behind a socket keeps the contract, tells when it is lost, and stops its robot when its tree is gone."""

import socket
import threading

import numpy as np
import pytest
from caretree.sim.remote.messages import VERSION, Connection
from caretree.sim.remote.server import SILENCE, WorldServer
from caretree.sim.remote.world import RemoteWorld
from caretree.sim.scripted.clock import SteppedClock
from caretree.sim.scripted.world import ScriptedWorld
from caretree.sim.testing import check_world
from caretree.sim.world import EmergencyStop, HandTwist, SensorLost, WorldError
from caretree.trees.run.runner import Run
from caretree.trees.run.task import load_task

UP = 0.05 * np.eye(6)[2]


class Served(ScriptedWorld):
    """Notes when it was stopped."""

    def __init__(self, **options):
        super().__init__(**options)
        self.stopped = threading.Event()

    def stop(self):
        super().stop()
        self.stopped.set()


class OnItsOwn(Served):
    """Its clock is no stepped one."""

    def __init__(self):
        super().__init__()
        stepped = self.time

        class Clock:
            def now(self):
                return stepped.now()

            def wait_until(self, time):
                stepped.wait_until(time)

        self.clock = Clock()


@pytest.fixture
def serve():
    """Serves worlds, each to any number of trees in turn."""
    servers, threads, opened = [], [], []

    def start(world, **options):
        server = WorldServer(world, **options)
        servers.append(server)

        def serve_all():
            try:
                while True:
                    server.serve_one()
            except OSError:
                return

        threads.append(threading.Thread(target=serve_all, daemon=True))
        threads[-1].start()
        opened.append(RemoteWorld(server.address))
        return opened[-1], server

    yield start
    for world in opened:
        world.close()
    for server in servers:
        server.close()
    for thread in threads:
        thread.join(10.0)
        assert not thread.is_alive()


def test_it_keeps_the_contract(serve):
    remote, _ = serve(ScriptedWorld(seed=100))
    assert isinstance(remote.clock, SteppedClock)
    check_world(lambda: remote, wall=lambda: 0.0)


def test_a_task_does_the_same_on_it(serve):
    hashes = []
    for world in (ScriptedWorld(seed=100), serve(ScriptedWorld(seed=100))[0]):
        if isinstance(world, RemoteWorld):
            world.kinematics = ScriptedWorld().kinematics
        result = Run(load_task("wave"), world, seed=100).run()
        assert result.outcome == "success"
        hashes.append(result.trace_hash)
    assert hashes[0] == hashes[1]


def test_errors_of_the_world_come_through(serve):
    class Pressed(ScriptedWorld):
        def send(self, command):
            raise EmergencyStop("the red button")

        def observe(self):
            raise ZeroDivisionError("a defect")

    remote, _ = serve(Pressed())
    with pytest.raises(SensorLost, match="there is no camera 'tail'"):
        remote.look("tail")
    with pytest.raises(EmergencyStop, match="the red button"):
        remote.send(HandTwist(side="left", twist_in_map=UP))
    with pytest.raises(WorldError, match="ZeroDivisionError: a defect"):
        remote.observe()
    assert remote.look("head").camera == "head", "it goes on"


def test_a_world_that_is_gone_is_lost_at_once_for_every_sense(serve):
    remote, server = serve(Served())
    server.close()
    remote._connection._line.shutdown(socket.SHUT_RDWR)
    for use in (remote.observe, lambda: remote.look("head")):
        with pytest.raises(SensorLost, match=f"the world at {remote._address} is lost"):
            use()
    with pytest.raises(WorldError, match="is lost"):
        remote.stop()
    with pytest.raises(WorldError, match="is lost"):
        remote.clock.wait_until(1.0)
    assert remote.clock.now() == 0.0


def test_a_run_whose_world_is_lost_ends_in_the_safe_stop(serve):
    remote, _ = serve(ScriptedWorld(seed=100))
    run = Run(load_task("wave"), remote)
    run.context.observers.append(lambda *unused: remote._connection._line.shutdown(socket.SHUT_RDWR))
    result = run.run()
    assert result.outcome == "safe_stop"
    assert "did not come to rest" in result.reason


def test_a_world_that_does_not_answer_is_given_up():
    listener = socket.create_server(("127.0.0.1", 0))

    def answer_hello():
        line = Connection(listener.accept()[0])
        line.receive()
        line.send(("", {"name": "Silent", "stepped": False, "robot": "baxter", "room": None}, 0.0))
        lines.append(line)

    lines = []
    thread = threading.Thread(target=answer_hello)
    thread.start()
    remote = RemoteWorld("{}:{}".format(*listener.getsockname()), patience=0.01)
    thread.join()
    with pytest.raises(SensorLost, match=r"did not answer within 0\.01 s"):
        remote.observe()
    lines[0].close(), listener.close()


def test_a_tree_that_hangs_up_leaves_no_motion_behind(serve):
    world = Served()
    remote, _ = serve(world)
    remote.send(HandTwist(side="left", twist_in_map=UP, duration=20.0))
    assert not world.stopped.is_set()
    remote.close()
    assert world.stopped.wait(10.0)


def test_a_robot_whose_tree_falls_silent_is_stopped(serve):
    times = iter(np.arange(0.0, 1e4, SILENCE / 2.5))
    world = OnItsOwn()
    remote, _ = serve(world, now=lambda: next(times))
    remote.send(HandTwist(side="left", twist_in_map=UP, duration=20.0))
    assert world.stopped.wait(10.0)


def test_a_simulated_robot_waits_for_its_tree(serve):
    world, looks = Served(), threading.Semaphore(0)

    def now():
        looks.release()
        return 1e6 * looks._value

    remote, _ = serve(world, now=now)
    remote.send(HandTwist(side="left", twist_in_map=UP, duration=20.0))
    for _ in range(4):
        assert looks.acquire(timeout=10.0)
    assert not world.stopped.is_set()


def test_stopping_waits_for_nobody(serve):
    class Slow(Served):
        def observe(self):
            begun.set()
            assert go_on.wait(10.0)
            return super().observe()

    begun, go_on, seen = threading.Event(), threading.Event(), []
    world = Slow()
    remote, _ = serve(world)
    asking = threading.Thread(target=lambda: seen.append(remote.observe()))
    asking.start()
    assert begun.wait(10.0)
    remote.stop()
    assert asking.is_alive()
    go_on.set()
    asking.join(10.0)
    assert seen
    assert world.stopped.wait(10.0)


def test_another_version_is_refused_in_one_sentence(monkeypatch):
    server = WorldServer(ScriptedWorld())
    thread = threading.Thread(target=server.serve_one)
    thread.start()
    monkeypatch.setattr("caretree.sim.remote.world.VERSION", VERSION + 1)
    with pytest.raises(WorldError, match=f"speaks version {VERSION} of the messages, the tree {VERSION + 1}"):
        RemoteWorld(server.address)
    thread.join(10.0)
    server.close()


def test_a_robot_that_is_busy_when_its_tree_goes_is_stopped_again(serve, monkeypatch):
    class Busy(OnItsOwn):
        asked = 0

        def stop(self):
            self.asked += 1
            if self.asked < 4:
                raise RuntimeError("busy")
            super().stop()

    monkeypatch.setattr("caretree.sim.remote.server.AGAIN", 0.001)
    world = Busy()
    remote, _ = serve(world)
    remote.close()
    assert world.stopped.wait(10.0)


def test_a_robot_is_stopped_while_a_call_hangs(serve):
    class Hangs(OnItsOwn):
        def observe(self):
            begun.set()
            assert go_on.wait(10.0)
            return super().observe()

    begun, go_on = threading.Event(), threading.Event()
    world = Hangs()
    remote, _ = serve(world)
    asking = threading.Thread(target=remote.observe)
    asking.start()
    assert begun.wait(10.0)
    world.stopped.clear()
    assert world.stopped.wait(10.0), "nobody stopped it while observe() did not come back"
    go_on.set()
    asking.join(10.0)


@pytest.mark.parametrize(
    ("address", "said"), [("nowhere", "no world is served at nowhere"), ("127.0.0.1:x", "host:port is asked for")]
)
def test_an_address_where_nobody_is_is_one_sentence(address, said, monkeypatch):
    def nobody(*unused):
        raise ConnectionRefusedError(111, "Connection refused")

    monkeypatch.setattr(socket, "create_connection", nobody)
    with pytest.raises(WorldError, match=said):
        RemoteWorld(address)
