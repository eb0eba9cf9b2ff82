"""A page as a reader meets it: opened in Chromium, wide and narrow, light and dark."""

import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import numpy as np

CHROMIUM = "/usr/bin/chromium"  # Debian's
OPTIONS = ("--no-sandbox", "--disable-gpu")
WIDTHS = (1400, 390)  # px: a desk and a telephone
SCHEMES = ("light", "dark")
PATIENCE = 200_000  # ms, on a machine that does much else; a page takes one second of an idle one
HEIGHT = 2400  # px of a page that a picture shows
LOOK = (Path(__file__).parent / "look.js").read_text(encoding="utf-8")


@contextmanager
def window() -> Iterator[Any]:
    """Yield a page of a browser that reaches nothing but files."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=list(OPTIONS))
        page = browser.new_context(offline=True).new_page()
        page.set_default_timeout(PATIENCE)
        yield page
        browser.close()


def amiss(file: Path, shown: Any) -> list[str]:
    """Return a sentence for all that is wrong with a page, whichever way it is looked at."""
    found = loaded(file, shown)
    asked("unfold", shown)
    found += asked("structure", shown)
    found += [f"'{link}' leads nowhere" for link in asked("links", shown) if not leads(file, link)]
    for width in WIDTHS:
        shown.set_viewport_size({"width": width, "height": HEIGHT})
        for what in ("wide", "broken"):
            found += [f"at {width} px: {says}" for says in asked(what, shown)]
        for scheme in SCHEMES:
            shown.emulate_media(color_scheme=scheme)
            found += [f"at {width} px, {scheme}: {says}" for says in asked("faint", shown)]
    return found


def loaded(file: Path, shown: Any) -> list[str]:
    """Open a page; return errors of scripts and failed requests."""
    found: list[str] = []
    listeners = {
        "console": lambda said: found.append(f"console: {said.text}"),
        "pageerror": lambda error: found.append(f"script: {error}"),
        "requestfailed": lambda asked: found.append(f"not loaded: {asked.url}"),
    }
    for event, listener in listeners.items():
        shown.on(event, listener)
    shown.goto(file.resolve().as_uri(), wait_until="load")
    for event, listener in listeners.items():
        shown.remove_listener(event, listener)
    return found


def asked(what: str, shown: Any) -> Sequence[str]:
    """Return what a function of ``look.js`` says of the page that is shown."""
    said: Sequence[str] = shown.evaluate(f"({LOOK}).{what}()")
    return said or ()


def leads(file: Path, link: str) -> bool:
    """Tell whether a link leads to a file beside the pages and, behind a "#", to a place in it."""
    path, _, place = unquote(link).partition("#")
    if re.match(r"[a-z]+:|/", path):
        return False
    target = file.parent / path if path else file
    return target.is_file() and place in {"", *places(target)}


@cache
def places(file: Path) -> frozenset[str]:
    """Return the names of all places on a page."""
    return frozenset(re.findall(r'\sid="([^"]+)"', file.read_text(encoding="utf-8")))


def pictured(file: Path, shown: Any, to: Path) -> list[Path]:
    """Keep a picture of a page for every width and scheme, and return where."""
    loaded(file, shown)
    found = []
    for width in WIDTHS:
        shown.set_viewport_size({"width": width, "height": HEIGHT})
        for scheme in SCHEMES:
            shown.emulate_media(color_scheme=scheme)
            found.append(to / f"{file.stem}_{width}_{scheme}.png")
            shown.screenshot(path=found[-1])
    return found


def greys(picture: Path) -> Any:
    """Return how bright each pixel of a picture is, of 255."""
    from PIL import Image

    return np.asarray(Image.open(picture).convert("L"))
