"""Colours of the pages: whatever is written can be read, by day and by night."""

import re
from itertools import product
from pathlib import Path

import pytest

TEMPLATES = Path(__file__).parents[2] / "templates"
LEAST = 4.5  # Web Content Accessibility Guidelines 2.1, 1.4.3: ratio of text to what is behind it
STYLE = "".join((TEMPLATES / f"{name}.css.jinja").read_text() for name in ("style", "drawing"))
ROOT = re.compile(r"(@media \(prefers-color-scheme: dark\) \{\s*)?:root \{([^}]*)\}")
WRITTEN = ("ink", "soft", "link", "mark", "defined", "checked")
IN_DRAWINGS = ("ink", "axis", "force", "moment", "weight", "spring")


def colours(scheme: str) -> dict[str, str]:
    """Return the colours of a scheme by name; by night those of the day hold on unless set."""
    found: dict[str, str] = {}
    for dark, body in ROOT.findall(STYLE):
        if not dark or scheme == "dark":
            found |= dict(re.findall(r"--(\w+): #(\w+)", body))
    return found


def light(colour: str) -> float:
    """Return the relative luminance of a colour, as the guidelines define it."""
    full = colour if len(colour) == 6 else "".join(c * 2 for c in colour)
    parts = [int(full[k : k + 2], 16) / 255 for k in (0, 2, 4)]
    r, g, b = (x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055) ** 2.4 for x in parts)
    return 0.2126 * r + 0.7152 * g + 0.0722 * b


def contrast(one: str, other: str) -> float:
    low, high = sorted((light(one), light(other)))
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_all_that_is_written_stands_out_from_what_is_behind_it(scheme: str) -> None:
    known = colours(scheme)
    pairs = {*product(WRITTEN, ("paper", "tint", "found"))}
    pairs |= {*product(IN_DRAWINGS, ("tint", "solid", "face", "shade"))}
    assert [(a, b) for a, b in pairs if contrast(known[a], known[b]) < LEAST] == []


def test_the_two_schemes_differ_and_faint_colours_are_seen() -> None:
    assert contrast("000", "ffffff") == pytest.approx(21)
    assert contrast("a3a9b3", "fff") < LEAST
    day, night = colours("light"), colours("dark")
    assert {name for name in day if day[name] == night[name]} == set()


def test_no_colour_of_text_stands_beside_the_schemes() -> None:
    rules = ROOT.sub("", STYLE)
    assert re.findall(r"(?:color|fill): #\w+", rules) == []
