"""What Chromium draws: measures of pages by a script beside them, and pictures as arrays.

A browser breaks lines, chooses fonts and places accents, so what a reader sees is measured there.
"""

import json
import re
import shutil
import struct
import subprocess
import zlib
from collections.abc import Sequence
from html import unescape
from pathlib import Path
from typing import Any

import numpy as np
import pytest

NAMES = ("chromium", "chromium-browser", "google-chrome")
QUIET = ("--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
         "--disable-background-networking", "--disable-component-update", "--disable-sync",
         "--hide-scrollbars", "--allow-file-access-from-files")  # fmt: skip
PATIENCE = 300  # s; all pages take 15 on an idle machine
MEASURED = """<!DOCTYPE html><html><body><script>
const pages = %s, widths = %s, found = [];
const one = (page, width) => new Promise(done => {
  const frame = document.createElement('iframe');
  frame.style.cssText = `width:${width}px;height:900px;border:0`;
  frame.src = page;
  frame.onload = () => {
    const d = frame.contentDocument, root = d.documentElement, wide = [];
    d.querySelectorAll('details').forEach(e => { e.open = true; });
    if (root.scrollWidth > root.clientWidth) wide.push('the page');
    for (const e of d.body.querySelectorAll('*')) {
      const style = frame.contentWindow.getComputedStyle(e);
      if (style.overflowX !== 'visible' && style.display !== 'inline'
          && e.scrollWidth > e.clientWidth)
        wide.push(`${e.tagName}.${e.className} ${e.scrollWidth} > ${e.clientWidth}: `
          + e.textContent.trim().slice(0, 60));
    }
    found.push([page, width, wide]);
    frame.remove();
    done();
  };
  document.body.appendChild(frame);
});
(async () => {
  for (const page of pages) for (const width of widths) await one(page, width);
  document.body.innerHTML = '<pre id="found"></pre>';
  document.getElementById('found').textContent = JSON.stringify(found);
})();
</script></body></html>
"""


def browser() -> str:
    """Return the path of Chromium; skip the test where there is none."""
    found = next((path for name in NAMES if (path := shutil.which(name))), None)
    if found is None:
        pytest.skip("no Chromium: what pages look like was not measured")
    return found


def _run(folder: Path, *options: str) -> str:
    command = [browser(), *QUIET, f"--user-data-dir={folder / 'profile'}", *options]
    done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=PATIENCE)
    return done.stdout


def too_wide(
    pages: Sequence[Path], widths: Sequence[int], folder: Path
) -> dict[tuple[str, int], list[str]]:
    """Return, by page and width of the window, what is wider than the box that holds it."""
    harness = folder / "measure.html"
    addresses = json.dumps([page.resolve().as_uri() for page in pages])
    harness.write_text(MEASURED % (addresses, json.dumps(list(widths))), encoding="utf-8")
    text = _run(folder, "--virtual-time-budget=250000", "--dump-dom", harness.as_uri())
    shown = re.search(r'<pre id="found">(.*?)</pre>', text, re.DOTALL)
    assert shown, "the script did not come to its end"
    found: list[Any] = json.loads(unescape(shown[1]))
    assert len(found) == len(pages) * len(widths)
    return {(page, width): wide for page, width, wide in found}


def picture(page: str, size: tuple[int, int], folder: Path) -> Any:
    """Return a page as an array of darkness, 0 where it is white and 255 where it is black."""
    (folder / "page.html").write_text(page, encoding="utf-8")
    _run(folder, f"--window-size={size[0]},{size[1]}", f"--screenshot={folder / 'page.png'}",
         (folder / "page.html").as_uri())  # fmt: skip
    return 255 - _gray((folder / "page.png").read_bytes())


def _gray(png: bytes) -> Any:
    """Return the least of red, green and blue of every pixel of a PNG of 8 bits a channel."""
    width, height, depth, kind = struct.unpack(">IIBB", png[16:26])
    assert (depth, kind) in ((8, 2), (8, 6))
    place, data, each = 8, b"", {2: 3, 6: 4}[kind]
    while place < len(png):
        (length,) = struct.unpack(">I", png[place : place + 4])
        if png[place + 4 : place + 8] == b"IDAT":
            data += png[place + 8 : place + 8 + length]
        place += length + 12
    lines = np.frombuffer(zlib.decompress(data), np.uint8).reshape(height, 1 + width * each)
    rows = [np.zeros(width * each, np.int64)]
    for line in lines:
        rows.append(_unfiltered(int(line[0]), line[1:].astype(np.int64), rows[-1], each))
    return np.array(rows[1:]).reshape(height, width, each)[:, :, :3].min(axis=2)


def _unfiltered(kind: int, line: Any, above: Any, each: int) -> Any:
    """Undo the filter of a line of a PNG (PNG specification, section 9)."""
    if kind == 0:
        return line
    if kind == 2:
        return (line + above) % 256
    found = line.tolist()
    up = above.tolist()
    for i, x in enumerate(found):
        left, corner = (found[i - each], up[i - each]) if i >= each else (0, 0)
        found[i] = (x + _predicted(kind, left, up[i], corner)) % 256
    return np.array(found)


def _predicted(kind: int, left: int, up: int, corner: int) -> int:
    if kind == 1:
        return left
    if kind == 3:
        return (left + up) // 2
    guess = left + up - corner
    return min((left, up, corner), key=lambda x: abs(guess - x))
