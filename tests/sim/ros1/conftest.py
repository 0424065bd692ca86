"""A master and a simulated robot behind it, in processes of their own: a node cannot change its master."""

import os
import shutil
import socket
import subprocess
import sys

import pytest

PATIENCE = 300.0  # [s]
CARETREE = "import sys; from caretree.trees.cli import main; sys.exit(main(sys.argv[1:]))"


def why_not():
    if shutil.which("rosmaster") is None:
        return "there is no rosmaster: make ros"
    code = "from caretree.sim.ros1.ros import ros; ros()"
    tried = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=PATIENCE)
    return "" if tried.returncode == 0 else tried.stderr.strip().splitlines()[-1]


class Robot:
    """What is behind a master of its own."""

    def __init__(self, folder, *options):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        self.uri = f"http://127.0.0.1:{port}"
        self.env = os.environ | {"ROS_MASTER_URI": self.uri, "ROS_IP": "127.0.0.1", "ROS_HOME": str(folder)}
        self.master = self._begin("rosmaster", "--core", "-p", str(port))
        waits = "import time\nfrom caretree.sim.ros1.ros import ask_master\nfrom caretree.sim.world import WorldError\n"
        waits += "for _ in range(300):\n  try: sys.exit(ask_master('getPid') * 0)\n"
        waits += "  except WorldError: time.sleep(0.1)\n"
        assert self.python("import sys\n" + waits).returncode == 0
        self.serve(*options)

    def serve(self, *options):
        self.robot = self._begin(sys.executable, "-u", "-c", CARETREE, "serve-robot", *options)
        assert self.robot.stdout is not None
        said = [self.robot.stdout.readline()]
        while said[-1] and not said[-1].startswith("serving"):  # on a busy machine the master may be late before
            said.append(self.robot.stdout.readline())
        assert said[-1], said

    def _begin(self, *command):
        return subprocess.Popen(command, env=self.env, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def python(self, code, *arguments):
        return self._done("-c", code, *arguments)

    def caretree(self, *command):
        return self._done("-c", CARETREE, *command)

    def _done(self, *arguments):
        return subprocess.run(
            [sys.executable, *arguments], env=self.env, capture_output=True, text=True, timeout=PATIENCE
        )

    def end(self):
        for process in (getattr(self, "robot", None), self.master):
            if process is not None:
                process.kill()
                process.communicate()


@pytest.fixture(scope="session")
def ros_here():
    if why := why_not():
        pytest.skip(why)


@pytest.fixture(scope="session")
def waving_robot(ros_here, tmp_path_factory):
    robot = Robot(tmp_path_factory.mktemp("ros"), "--task", "wave", "--pace", "tree", "--seed", "100")
    yield robot
    robot.end()


@pytest.fixture(scope="session")
def living_robot(ros_here, tmp_path_factory):
    """Its time passes by itself."""
    robot = Robot(tmp_path_factory.mktemp("ros"), "--task", "wave", "--rate", "20", "--camera-rate", "2")
    yield robot
    robot.end()


@pytest.fixture(scope="session")
def baxter(ros_here, tmp_path_factory):
    robot = Robot(tmp_path_factory.mktemp("ros"), "--task", "dressing", "--pace", "tree", "--seed", "100")
    yield robot
    robot.end()


@pytest.fixture
def robot_of_its_own(ros_here, tmp_path):
    """One that a test may break."""
    robot = Robot(tmp_path, "--task", "wave", "--pace", "tree")
    yield robot
    robot.end()
