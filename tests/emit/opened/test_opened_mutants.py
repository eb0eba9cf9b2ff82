"""What is wrong with a page is seen: each mutant of a good page is found for what it is."""

from pathlib import Path
from typing import Any

import pytest

from tests.emit.opened.opened import amiss

pytestmark = pytest.mark.browser
OTHER = '<!DOCTYPE html><html lang="en"><body><h1 id="here">Other</h1></body></html>'
PAGE = """<!DOCTYPE html><html lang="en"><head><meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1"><title>A page</title><style>
:root { color-scheme: light dark; --ink: #222; --paper: #fff; --soft: #666 }
@media (prefers-color-scheme: dark) { :root { --ink: #ddd; --paper: #111; --soft: #999 } }
html { background: var(--paper); color: var(--ink) }
p { color: var(--soft) } svg { width: 100% } text { fill: var(--ink) }
</style></head><body>
<h1>A page</h1><p id="place">Words, and <a href="#place">a link</a>, and
<a href="other.html#here">another</a>.</p>
<h2>Part</h2><p><b>Bold</b></p><details><summary>More</summary><p>Folded</p></details>
<svg viewBox="0 0 300 40" role="img" aria-label="a word on a tinted ground, in a drawing">
<rect width="90" height="40" fill="var(--paper)"/><text x="9" y="20">word</text></svg>
</body></html>
"""
MUTANTS = (
    ("</body>", "<script>throw Error('lost')</script></body>", "script: lost"),
    ("</body>", "<script>console.error('odd')</script></body>", "console: odd"),
    ("</body>", '<img src="gone.png" alt="a picture of it"></body>', "not loaded: "),
    ("</style>", "</style><link rel='stylesheet' href='https://a.example/b.css'>", "not loaded: "),
    ("Words,", "<span style='display:block;width:600px'>Words</span>", "at 390 px: "),
    ("Folded", "<span style='display:block;width:600px'>Words</span>", "at 390 px: "),
    ("Words,", "<span style='display:block;width:1500px'>Words</span>", "at 1400 px: "),
    ("Words,", "<span style='position:relative;left:-30px'>Words</span>", "from -"),
    ("Words,", "<span style='display:block;overflow-x:auto'><i style='white-space:pre'>"
     + "Words " * 99 + "</i></span>", "at 390 px: span holds "),
    ("Words,", "<i style='display:block;width:2em;overflow-wrap:anywhere'>Wording</i>",
     "at 390 px: i cuts 'Wording'"),
    ('y="20"', 'y="60"', "is cut by the edge of its drawing"),
    ("#place", "#gone", "'#gone' leads nowhere"),
    ("other.html#here", "other.html#gone", "'other.html#gone' leads nowhere"),
    ("other.html#here", "gone.html", "'gone.html' leads nowhere"),
    ("other.html#here", "https://a.example/", "'https://a.example/' leads nowhere"),
    ("<h2>Part</h2>", "<h3>Part</h3>", "h3 follows a heading of level 1"),
    ("<h2>Part</h2>", "<h1>Part</h1>", "h1 follows a heading of level 1"),
    ("<h2>Part</h2>", "<h2> </h2>", "h2 is an empty heading"),
    ("h1>", "p>", "follows a heading of level 0"),
    (' aria-label="a word on a tinted ground, in a drawing"', "", "svg has no alternative text"),
    ("a word on a tinted ground, in a drawing", "a drawing",
     "'a drawing' does not say what is seen"),
    ("</svg>", '</svg><svg role="img" aria-label="a word on a tinted ground, in a drawing"></svg>',
     "two pictures are called 'a word on a tinted ground, in a drawing'"),
    (' role="img"', "", "svg is no image to who cannot see it"),
    ("</body>", '<img src="data:image/gif;base64,R0lGODlhAQABAAAAACw="></body>',
     "img has no alternative text"),
    (' lang="en"', "", "the page does not say its language"),
    ("<title>A page</title>", "", "the page has no title"),
    ("<h2>", '<h2 id="place">', "two elements are called 'place'"),
    ("--soft: #666", "--soft: #888", "light: p#place rgb(136, 136, 136) has a contrast of 3.54"),
    ("--soft: #999", "--soft: #444", "dark: p#place rgb(68, 68, 68) has a contrast of 1.9"),
    ("--soft: #999", "--soft: #444", "at 390 px, dark: p#place "),
    ("--paper: #111", "--paper: #eee", "dark: the page is bright by night"),
    ("--paper: #fff", "--paper: #000", "light: the page is dark by day"),
    ("<b>", "<b style='color:#000c'>", "dark: b rgba(0, 0, 0, 0.8) has a contrast of 1.0"),
    ("<b>", "<b style='opacity:0.5'>", "light: b rgb(102, 102, 102) has a contrast of 2."),
    ("<b>", "<b style='background:#666'>", "light: b rgb(102, 102, 102) has a contrast of 1.00"),
    ("Folded", "<b style='color:#fff'>Bold</b>", "b rgb(255, 255, 255) has a contrast of 1.00"),
    ("fill: var(--ink)", "fill: #222", "dark: text rgb(34, 34, 34) has a contrast of 1."),
    ('fill="var(--paper)"', 'fill="#777"', "text rgb(221, 221, 221) has a contrast of 3."),
)  # fmt: skip


def opened(page: str, shown: Any, folder: Path) -> list[str]:
    """Return what is amiss with a page that stands beside another."""
    (folder / "other.html").write_text(OTHER, encoding="utf-8")
    (folder / "page.html").write_text(page, encoding="utf-8")
    return amiss(folder / "page.html", shown)


def test_nothing_is_amiss_with_a_good_page(shown: Any, tmp_path: Path) -> None:
    assert opened(PAGE, shown, tmp_path) == []


@pytest.mark.parametrize(("old", "new", "says"), MUTANTS, ids=lambda text: text[:40])
def test_what_is_wrong_with_a_page_is_seen(
    old: str, new: str, says: str, shown: Any, tmp_path: Path
) -> None:
    assert PAGE.count(old) >= 1
    found = opened(PAGE.replace(old, new), shown, tmp_path)
    assert [one for one in found if says in one], found
