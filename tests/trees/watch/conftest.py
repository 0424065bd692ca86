"""A page needs viser, and a browser to look at it."""

from __future__ import annotations

import pytest

from .browser import PROGRAM, Browser

pytest.importorskip("viser", reason="viser is not installed: pip install 'viser==1.1.1'")


@pytest.fixture
def browse(tmp_path):
    """Open a page in headless Chromium: `browse(url)`."""
    if PROGRAM is None:
        pytest.skip("there is no Chromium on this machine: apt-get install chromium")
    opened = []

    def open_page(url):
        opened.append(Browser(url, tmp_path / "chromium"))
        return opened[-1]

    yield open_page
    for browser in opened:
        browser.close()
