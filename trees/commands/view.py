"""`caretree view`: a record in the browser, with a time slider."""

from __future__ import annotations

import argparse
from pathlib import Path

from ...sim.extras import need


def main(options: argparse.Namespace) -> int:
    """Serve the page until Ctrl-C.

    Raises:
        CaretreeError: the record cannot be read, or the page cannot be served.
    """
    need("viser", "the view")
    from ..watch.playback import Playback  # viser is needed only here

    playback = Playback(Path(options.directory), options.port)
    print(f"{playback.url} (Ctrl-C ends it)", flush=True)
    try:
        playback.play()
    except KeyboardInterrupt:
        return 0
    finally:
        playback.close()
