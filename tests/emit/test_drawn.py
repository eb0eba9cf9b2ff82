"""What a reader sees of equations: dots that are no accents, words apart, pieces read whole."""

import re
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from functools import cache
from itertools import pairwise
from pathlib import Path

import pytest
from sympy import symbols

from derive.emit.notation import _claims, name_mathml, sympy_equation_mathml
from derive.emit.notation.lines import WIDEST, pieces, width
from derive.emit.notation.mathml import row
from derive.lecture.chapters import LECTURE

GENERATED = Path(__file__).parents[2] / "generated"
PAGES = sorted(GENERATED.rglob("*.html"))
MATH = "{http://www.w3.org/1998/Math/MathML}"
INVISIBLE = "\u2062"
FUNCTIONS = ("sin", "cos", "tan")


@cache
def equations(page: Path) -> list[ET.Element]:
    """Return the MathML of a page."""
    found = re.findall(r"<math .*?</math>", page.read_text(encoding="utf-8"), re.DOTALL)
    return [ET.fromstring(text) for text in dict.fromkeys(found)]  # noqa: S314 (made here)


def touching(math: ET.Element) -> Iterator[str]:
    """Yield the words, names of several letters, that a factor stands next to without a sign."""
    for element in math.iter():
        children = list(element) if element.tag in (f"{MATH}mrow", f"{MATH}math") else []
        for before, sign, after in zip(children, children[1:], children[2:], strict=False):
            if sign.text == INVISIBLE and after.tag != f"{MATH}mspace":
                yield from (w for w in (_end(before, -1), _end(after, 0)) if _is_word(w))
        for before, after in pairwise(children):
            if before.tag == after.tag == f"{MATH}mi":
                yield f"{before.text} {after.text}"


def _end(element: ET.Element, place: int) -> str:
    """Return the first or last sign of a factor, without its indices and powers."""
    if element.tag in (f"{MATH}{kind}" for kind in ("msub", "msup", "mover", "mmultiscripts")):
        return _end(element[0], place)
    if element.tag == f"{MATH}mrow" and len(element):
        return _end(element[place], place)
    return (element.text or "") if element.tag == f"{MATH}mi" else ""


def _is_word(text: str) -> bool:
    return len(text) > 1 and text.isascii()


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.stem)
def test_no_name_of_several_letters_touches_a_factor(page: Path) -> None:
    assert [word for math in equations(page) for word in touching(math)] == []


def test_names_that_touch_are_seen() -> None:
    xml = 'xmlns="http://www.w3.org/1998/Math/MathML"'
    squared = "<msup><mi>r</mi><mn>2</mn></msup>"
    together = f"<math {xml}><mi>mass</mi><mo>{INVISIBLE}</mo>{squared}</math>"
    apart = together.replace(INVISIBLE, "·")
    assert list(touching(ET.fromstring(together))) == ["mass"]  # noqa: S314
    assert list(touching(ET.fromstring(apart))) == []  # noqa: S314
    after = together.replace("mass", "m").replace("<mi>r</mi>", "<mi>rate</mi>")
    assert list(touching(ET.fromstring(after))) == ["rate"]  # noqa: S314
    assert list(touching(ET.fromstring(f"<math {xml}><mi>m</mi><mi>r</mi></math>")))  # noqa: S314


def test_no_dot_is_an_accent_which_browsers_draw_into_the_letter() -> None:
    dotted = [e for page in PAGES for math in equations(page) for e in math.iter(f"{MATH}mover")]
    assert dotted
    assert {(e.attrib["accent"], e[1].attrib["accent"]) for e in dotted} == {("false", "false")}


def test_a_coefficient_carries_its_own_dots_and_not_those_of_what_it_multiplies() -> None:
    shown = name_mathml("Omega_dot_stem_z_by_alpha_ddot", "scalar")
    assert re.findall("[˙¨]", shown) == ["˙", "¨"]
    assert "<mo>∕</mo>" in shown


def signs(text: str) -> list[str]:
    """Return what is read of MathML, in order."""
    read = re.findall(r">([^<>]+)<", f">{text}<")
    return [sign for sign in read if sign not in ("&#8290;", "&#8203;")]


def test_an_equation_in_pieces_reads_as_the_whole() -> None:
    claims = [claim for step in LECTURE.steps for claim in _claims(step)]
    cut = [claim for claim in claims if len(pieces(claim)) > 1]
    assert len(cut) > 20
    assert all(width(claim) > WIDEST for claim in cut)
    for claim in cut:
        whole, told = signs(row(claim)), [s for piece in pieces(claim) for s in signs(piece)]
        assert [s for s in told if s != "·"] == [s for s in whole if s != "·"]
        assert 0 <= told.count("·") - whole.count("·") < len(pieces(claim))  # where lines end


def test_a_fraction_that_is_too_wide_is_written_on_one_line() -> None:
    each = symbols("mass_of_body length_of_arm rate_of_turn spring_of_door")
    shown = sympy_equation_mathml(each[0], (each[0] + each[1]) / (each[2] * each[3]), {})
    assert "mfrac" not in shown
    assert "".join(signs(shown)) == (
        "mass of body=(length of arm+mass of body)/(rate of turn·spring of door)"
    )
