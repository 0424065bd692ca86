"""`caretree run` as the child of a campaign: it ends in the safe stop when its campaign is gone."""

from __future__ import annotations

import os
import signal
import sys
import threading
import time

from ..cli import main

PARENT = "CARETREE_CAMPAIGN"  # environment variable: process id of the campaign
LOOKS = 0.5  # [s] between two looks whether it is still there
ENDING = 60.0  # [s] for the safe stop and the record, after which the process is ended


def watch(parent: int) -> None:
    """Wait until the parent is gone, then end this process, gently first."""
    while os.getppid() == parent:
        time.sleep(LOOKS)
    os.kill(os.getpid(), signal.SIGTERM)
    time.sleep(ENDING)
    os.kill(os.getpid(), signal.SIGKILL)


def run_watched(parent: int) -> int:
    """Run the command line as long as the process `parent` is this one's; its exit status."""
    threading.Thread(target=watch, args=(parent,), daemon=True).start()
    return main()


if __name__ == "__main__":
    given = os.environ.get(PARENT, "")
    sys.exit(run_watched(int(given)) if given.isdigit() else main())
