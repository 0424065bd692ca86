"""The server that a browser talks to: viser, which is asked for only when somebody wants to watch."""

from __future__ import annotations

import contextlib
import io
import logging
import socket
from typing import Any

from ...sim.errors import CaretreeError
from ...sim.extras import need

HOST = "127.0.0.1"  # whoever can reach it can stop the robot
PORT = 8080


def open_server(title: str, port: int | None) -> Any:
    """A viser server on this machine.

    Args:
        title: of the page.
        port: to listen on; None for the first free one from `PORT` on.

    Raises:
        CaretreeError: viser is not installed, or the port is taken.
    """
    need("viser", "the view")
    import viser

    if port is not None:
        with socket.socket() as probe:
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            try:
                probe.bind((HOST, port))
            except (OSError, OverflowError) as error:
                raise CaretreeError(f"port {port} cannot be listened on: it is taken, or not for users") from error
    logging.getLogger("websockets").setLevel(logging.CRITICAL)  # browsers open connections that they do not use
    with contextlib.redirect_stdout(io.StringIO()):  # it prints a banner
        server = viser.ViserServer(host=HOST, port=PORT if port is None else port, label=title, verbose=False)
    server.gui.configure_theme(show_logo=False, show_share_button=False)
    server.gui.main_panel.dock_right()
    server.gui.main_panel.set_width(460)
    server.initial_camera.position = (2.9, -2.2, 2.1)
    server.initial_camera.look_at = (0.5, 0.1, 0.7)
    return server


def address(server: Any) -> str:
    """Where the page is."""
    return f"http://{HOST}:{server.get_port()}/"


def close_server(server: Any) -> None:
    """End it, without the line that it prints."""
    with contextlib.redirect_stdout(io.StringIO()):
        server.stop()
