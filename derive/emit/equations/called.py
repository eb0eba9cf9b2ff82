"""What is said of symbols that no scene declares: their letters, and what they mean.

Some are named quantities of the working sheet, as the velocity of an axis system's origin; others
stand between balances and their solution. A letter that the scene uses itself gives way.
"""

import re
from collections.abc import Collection, Mapping

from derive.emit.notation.glyph import glyph

SPELT: Mapping[str, tuple[str, str]] = {
    "Omega": ("Omega", "angular velocity of {}"),
    "Omega_dot": ("Omega_dot", "rate of the angular velocity of {}, seen from there"),
    "v": ("v", "velocity of the origin of {}"),
    "a": ("a", "acceleration of the origin of {}"),
    "a_seen": ("a_rel", "acceleration of a point placed in {}, less that of its origin"),
    "a_G": ("a_G", "acceleration of the mass centre of {}"),
    "a_A": ("a_A", "acceleration of the point of {} about which moments are taken"),
    "v_G": ("v_G", "velocity of the mass centre of {}"),
    "F": ("F", "force that the motion of {} needs"),
    "M": ("M", "moment that the motion of {} needs"),
    "omega": ("omega", "angular velocity of {}"),
    "omega_dot": ("omega_dot", "rate of the angular velocity of {}"),
    "towards": ("n", "direction from {} to what attracts it"),
    "d": ("d", "from one end of {} to the other"),
    "length": ("L", "length of {}"),
    "force": ("F", "force of {}"),
    "along": ("w", "components of a vector along {}"),
    "arm": ("r", "arm of a force about the point of a balance"),
    "l": ("l", "angular momentum"),
}
"""By the last word of a label: a letter, and a meaning with a place for whose it is."""
SHORT: Mapping[str, tuple[tuple[str, ...], str]] = {
    "balance": (("h", "eta"), "what a balance holds without the unknowns"),
    "by": (("mu", "nu", "chi"), "factor of an unknown, for short"),
    "b": (("b", "beta"), "what a balance leaves without the unknowns"),
    "det": (("Delta", "D"), "determinant of the balances that are solved together"),
    "a": (("a", "alpha"), "factor of an unknown after elimination"),
    "factor": (("k", "kappa"), "by which one balance is taken from another"),
    "pivot": (("p", "rho"), "one over the factor by which an unknown is eliminated"),
    "part": (("c", "sigma"), "part of what follows, for short"),
}
"""What stands for a longer expression: letters to choose from, and what it is."""
AXES = ("x", "y", "z")
_COUNT = re.compile("#[0-9]+")


def letter_called(label: str, marks: Mapping[str, str], bases: Collection[str]) -> str:
    """Return the name of a symbol by its label on the sheet or among what is solved.

    marks : of owners that the scene gave no names      bases : letters that the scene uses

    >>> letter_called("stem.v.x.dot", {}, ()), letter_called("balance#2", {}, ("h",))
    ('v_dot_stem_x', 'eta')
    """
    kind, owner, axis, dots = _parts(label)
    if kind in SHORT:
        letters, _ = SHORT[kind]
        return next((each for each in letters if each not in bases), letters[-1])
    first, *rest = (SPELT[kind][0] if kind in SPELT else kind).split("_")
    mark = marks.get(owner, owner.removesuffix(".axes").replace(".", "_"))
    return "_".join(filter(None, [first, *rest, *["dot"] * dots, mark, axis]))


def meaning_called(label: str, spoken: Mapping[str, str]) -> str:
    """Return what a symbol means by its label.

    >>> meaning_called("stem.v.x.dot", {})
    'rate of: velocity of the origin of stem, along x'
    """
    kind, owner, axis, dots = _parts(label)
    if kind in SHORT:
        return SHORT[kind][1]
    _, says = SPELT.get(kind, ("", f"{kind} of {{}}"))
    body = owner.removesuffix(".axes")
    whose = spoken.get(owner, owner if body == owner else f"the axes of {body}")
    whose = whose.removeprefix("of ").removeprefix("along ")
    whole = says.format(whose) + (f", along {axis}" if axis else "")
    return "rate of: " * dots + whole


def letters_used(names: Collection[str]) -> frozenset[str]:
    """Return the letters by which names are written, without dots and indices."""
    return frozenset(glyph(name).base for name in names)


def _parts(label: str) -> tuple[str, str, str, int]:
    """Return the kind of a label, its owner, its axis, and how many rates were taken."""
    whole, by, _ = _COUNT.sub("", label).partition(".by.")
    parts = whole.split(".")
    dots = parts.count("dot")
    parts = [part for part in parts if part not in ("dot", "about")]
    axis = parts.pop() if len(parts) > 1 and parts[-1] in AXES else ""
    if by:
        return "by", "", "", 0
    if parts[0] in ("along", "arm", "l", "balance") or len(parts) == 1:
        return parts[0], ".".join(parts[1:]), axis, dots
    return parts[-1], ".".join(parts[:-1]), axis, dots
