"""PyBullet starts without a word."""

import os
import subprocess
import sys

from caretree.sim.bullet_client import silence


def test_a_server_starts_silently():
    code = "from caretree.sim.bullet_client import direct_client; direct_client(); print('started')"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, check=True)
    assert (done.stdout, done.stderr) == (b"started\n", b"")


def test_output_comes_back(capfd):
    with silence():
        os.write(1, b"dropped")
        os.write(2, b"dropped")
    os.write(1, b"kept")
    captured = capfd.readouterr()
    assert (captured.out, captured.err) == ("kept", "")
