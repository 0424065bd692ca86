"""Headless Chromium, spoken to through its DevTools: enough to read a page, press its buttons and photograph it."""

from __future__ import annotations

import base64
import json
import os
import re
import shutil
import subprocess
import time
import urllib.request

PROGRAM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
PATIENCE = 60.0  # [s] of the wall clock, for a page that software draws on a busy machine


class Browser:
    """One page."""

    def __init__(self, url, folder):
        from websockets.sync.client import connect

        command = [PROGRAM, "--headless=new", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
        command += ["--remote-debugging-port=0", f"--user-data-dir={folder}", "--window-size=1400,900", url]
        clean = {name: value for name, value in os.environ.items() if not name.startswith("DBUS")}
        self._process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, env=clean)
        for line in self._process.stderr:
            if found := re.search(r"ws://127\.0\.0\.1:(\d+)/", line):
                break
        else:
            raise AssertionError("Chromium did not start")
        with urllib.request.urlopen(f"http://127.0.0.1:{found[1]}/json") as answer:
            page = next(each for each in json.loads(answer.read()) if each["type"] == "page")
        self._socket = connect(page["webSocketDebuggerUrl"], max_size=2**26)
        self._count = 0

    def call(self, method, **parameters):
        """One command of the DevTools protocol."""
        self._count += 1
        self._socket.send(json.dumps({"id": self._count, "method": method, "params": parameters}))
        while (answer := json.loads(self._socket.recv(timeout=PATIENCE))).get("id") != self._count:
            pass
        return answer["result"]

    def ask(self, script):
        """Value of an expression on the page."""
        return self.call("Runtime.evaluate", expression=script, returnByValue=True)["result"].get("value")

    def text(self):
        """All that can be read."""
        return self.ask("document.body ? document.body.innerText : ''") or ""

    def until(self, seen):
        """Wait until `seen(text)` of the page holds; returns the text."""
        ends = time.monotonic() + PATIENCE
        while not seen(text := self.text()):
            assert time.monotonic() < ends, text
            time.sleep(0.1)
        return text

    def press(self, label):
        """Press a button."""
        script = f"[...document.querySelectorAll('button')].find(b => b.innerText.trim() === {json.dumps(label)})"
        self.until(lambda _: self.ask(f"!!({script})"))
        self.ask(f"{script}.click()")

    def photograph(self):
        """The page as PNG."""
        return base64.b64decode(self.call("Page.captureScreenshot")["data"])

    def close(self):
        """End it."""
        self._socket.close()
        self._process.terminate()
        self._process.wait()
        self._process.stderr.close()
