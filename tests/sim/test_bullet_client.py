"""PyBullet starts without a word."""

import os

from caretree.sim.bullet_client import direct_client, silence


def test_a_server_starts_silently_and_output_comes_back(capfd):
    client = direct_client()
    client.disconnect()
    with silence():
        os.write(1, b"dropped")
        os.write(2, b"dropped")
    os.write(1, b"kept")
    captured = capfd.readouterr()
    assert (captured.out, captured.err) == ("kept", "")
