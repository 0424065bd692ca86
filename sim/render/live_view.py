"""A live 3D view of the room in the browser: drag to turn, wheel to zoom; needs no display and no extra package."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from urllib.parse import parse_qs, urlparse

import numpy as np

from ..errors import DisplayError
from ..fence import said
from .camera import looking_at

SIZE = (640, 480)
TARGET = np.array((0.6, 0.5, 0.75))  # what the camera turns about [m]
_PAGE = b"""<!doctype html><meta charset=utf-8><title>caretree, live</title>
<style>body{margin:0;background:#222;color:#ddd;font:14px sans-serif;text-align:center}
img{width:min(100vw,133vh);cursor:grab}</style>
<img id=v draggable=false><div>drag: turn, wheel: zoom</div><script>
let a=-100,e=35,d=3.9,v=document.getElementById('v'),b=false;
function next(){v.src=`/frame?a=${a}&e=${e}&d=${d}&n=${Date.now()}`}
v.onload=()=>setTimeout(next,60);v.onerror=()=>setTimeout(next,1000);
v.onmousedown=()=>b=true;window.onmouseup=()=>b=false;
window.onmousemove=m=>{if(b){a-=m.movementX*.4;e=Math.max(3,Math.min(88,e+m.movementY*.3))}};
window.onwheel=w=>{d=Math.max(1,Math.min(8,d*(1+w.deltaY*.001)))};next()</script>"""


def orbit(azimuth: float, elevation: float, distance: float) -> np.ndarray:
    """Camera pose (4, 4) that looks at `TARGET` from a direction [degrees] and a distance [m]."""
    a, e = np.deg2rad(azimuth), np.deg2rad(np.clip(elevation, 1.0, 89.0))
    return looking_at(TARGET + distance * np.array((np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e))), TARGET)


class LiveView:
    """Serves frames on this machine only (127.0.0.1).

    The simulation's thread draws, when `serve` is called, for whoever asked since the last call: the page never
    touches the world.

    Args:
        port: 0 for any free one.
    """

    def __init__(self, port: int = 0) -> None:
        self._asked: tuple[float, float, float] | None = None
        self._frame: bytes | None = None
        self._ready = threading.Condition()
        view = self

        class Handler(BaseHTTPRequestHandler):
            def do_GET(self) -> None:
                url = urlparse(self.path)
                if url.path == "/":
                    self._answer("text/html", _PAGE)
                elif url.path == "/frame":
                    self._answer("image/jpeg", view._wait_for(parse_qs(url.query)))
                else:
                    self.send_error(404)

            def _answer(self, kind: str, body: bytes | None) -> None:
                if body is None:
                    self.send_error(503)
                    return
                with contextlib.suppress(BrokenPipeError, ConnectionResetError):  # the reader has left
                    self.send_response(200)
                    self.send_header("Content-Type", kind)
                    self.send_header("Content-Length", str(len(body)))
                    self.end_headers()
                    self.wfile.write(body)

            def log_message(self, format: str, *args: object) -> None:
                """Keep the terminal for the run's progress."""

        self._server = ThreadingHTTPServer(("127.0.0.1", port), Handler)
        self._server.daemon_threads = True
        self.url = f"http://127.0.0.1:{self._server.server_address[1]}/"
        threading.Thread(target=self._server.serve_forever, daemon=True).start()

    def serve(self, draw: Callable[[np.ndarray], np.ndarray]) -> None:
        """Draw once if somebody waits: `draw` takes a camera pose (4, 4) and returns rgb (H, W, 3) uint8.

        Raises:
            DisplayError: nothing can be drawn.
        """
        with self._ready:
            asked, self._asked = self._asked, None
        if asked is None:
            return
        try:
            import cv2

            _, jpeg = cv2.imencode(".jpg", draw(orbit(*asked))[:, :, ::-1])
        except Exception as error:  # of renderer or encoder
            raise DisplayError(f"the live view cannot be drawn: {said(error)}") from error
        with self._ready:
            self._frame = jpeg.tobytes()
            self._ready.notify_all()

    def close(self) -> None:
        """End the server."""
        self._server.shutdown()
        self._server.server_close()

    def _wait_for(self, query: dict[str, list[str]]) -> bytes | None:
        try:
            a, e, d = (float(query[key][0]) for key in "aed")
        except (KeyError, ValueError):
            return None
        with self._ready:
            self._asked, self._frame = (a, e, min(max(d, 0.5), 10.0)), None
            self._ready.wait_for(lambda: self._frame is not None, timeout=5.0)
            return self._frame
