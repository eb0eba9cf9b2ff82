"""The letters of a scene as a paper has them: constants keep theirs, and words get one.

A parameter with a value is a number in code; here it keeps its letter, and its value stands in the
list of symbols. A coordinate called by a word is q with that word as index, so that dots stand over
a letter; the usual angles of ships and aircraft have their usual letters.
"""

from collections.abc import Collection, Iterator, Mapping
from dataclasses import replace
from decimal import Decimal
from fractions import Fraction

from derive.emit.equations.called import letters_used
from derive.emit.notation.glyph import GREEK, glyph, slanted
from derive.library.library import Library, posed_again
from derive.scene import Scene
from derive.scene.declaration import Parameter

USUAL: Mapping[str, str] = {
    "yaw": "psi", "heading": "psi", "pitch": "theta", "roll": "phi", "heel": "phi",
    "lam": "lambda", "lamda": "lambda", "lmbda": "lambda",
}  # fmt: skip
ENDINGS = ("", "_dot", "_ddot", "_rate", "_dot_rate", "_dot_dot")


def lettered(known: Library) -> Library:
    """Return a scene in which parameters with values are letters; one that is zero stays so."""
    scene = known.scene
    if not any(p.value for p in scene.parameters):
        return known
    inverse = scene.inverse and _free(scene.inverse)
    return posed_again(known, replace(_free(scene), inverse=inverse))


def _free(scene: Scene) -> Scene:
    return replace(scene, parameters=tuple(map(_ranged, scene.parameters)))


def _ranged(p: Parameter) -> Parameter:
    """Return a parameter that ranges about its value, on the same side of zero."""
    if not p.value:
        return p
    low, high = sorted((p.value / 2, p.value * 2))
    return replace(p, value=None, low=low, high=high)


def decimal_value(value: Fraction) -> str:
    """Return a value as the scene states it.

    >>> decimal_value(Fraction(981, 100)), decimal_value(Fraction(1, 8000000000))
    ('9.81', '1.25E-10')
    """
    return str(Decimal(value.numerator) / Decimal(value.denominator))


def names_shown(scene: Scene, names: Collection[str]) -> dict[str, str]:
    """Return how names are written that are words, or spell a letter.

    names : all that are written in the scene's equations
    """
    used = set(letters_used(names))
    found: dict[str, str] = {}
    for name, new in _lettered_words(scene, used):
        for ending in ENDINGS:
            old, one = name + ending, new + ending
            if old in names and one not in names:
                found[old] = one
    return found


def _lettered_words(scene: Scene, used: set[str]) -> Iterator[tuple[str, str]]:
    speeds = {m.name for m in scene.speeds}
    moving = [m.name for m in (*scene.coordinates, *scene.speeds)]
    for name in (*moving, *(p.name for p in scene.parameters)):
        letter = USUAL.get(name, "")
        if letter and letter not in used:
            used.add(letter)
            yield name, letter
        elif name in moving and _is_word(name):
            yield name, f"{'u' if name in speeds else 'q'}_{name}"


def _is_word(name: str) -> bool:
    base = glyph(name).base
    return not slanted(base) and base not in GREEK
