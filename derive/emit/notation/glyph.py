"""What a name such as roller_omega_x says: a letter, its dots, its indices, and whose rate it is.

Pages, labels of drawings and LaTeX draw what is decided here, so that one name looks the same in
all: a letter alone is slanted, several are a word and upright, and words stand apart.
"""

import re
from dataclasses import dataclass
from itertools import pairwise

from derive.scene.functions import FUNCTIONS

# fmt: off
GREEK = {
    "alpha": "α", "beta": "β", "gamma": "γ", "delta": "δ", "epsilon": "ε", "zeta": "ζ",
    "eta": "η", "theta": "θ", "iota": "ι", "kappa": "κ", "lambda": "λ", "mu": "μ",
    "nu": "ν", "xi": "ξ", "omicron": "ο", "pi": "π", "rho": "ρ", "sigma": "σ",
    "tau": "τ", "upsilon": "υ", "phi": "φ", "chi": "χ", "psi": "ψ", "omega": "ω",
}
# fmt: on
GREEK |= {name.capitalize(): letter.upper() for name, letter in GREEK.items()}
DIFFERENTIAL = "dm"  # of two letters, but one symbol
_DOTS = {"dot": 1, "ddot": 2}
_SHORT = 2  # an index has at most two letters; a longer part belongs to a word
_COUNTED = re.compile(r"([A-Za-z]+)(\d+)")
_ALONG = re.compile("[xyz]{2}")


@dataclass(frozen=True)
class Glyph:
    """A name taken apart: ``base`` with dots or a prime, its indices, and "N" if seen from N.

    base : "omega", "m", "blade mass"; ``spelt`` says how it and the indices are spelt
    by : for a coefficient, the name of the quantity by which it is multiplied
    """

    base: str
    dots: int = 0
    prime: bool = False
    indices: tuple[str, ...] = ()
    seen_from: str = ""
    by: str = ""


def spelt(part: str) -> str:
    """Return how a base or an index is spelt: a Greek letter by itself, all else as it is.

    >>> spelt("omega"), spelt("blade mass")
    ('ω', 'blade mass')
    """
    return GREEK.get(part, part)


def slanted(part: str) -> bool:
    """Return whether a base or an index is a symbol, drawn slanted, and neither word nor number.

    >>> slanted("omega"), slanted("x"), slanted("xy"), slanted("roller"), slanted("2")
    (True, True, True, False, False)
    """
    alone = len(spelt(part)) == 1 and not part.isdigit()
    return alone or part == DIFFERENTIAL or _ALONG.fullmatch(part) is not None


def glyph(name: str) -> Glyph:
    """Return a name taken apart.

    >>> glyph("omega_dot_x")
    Glyph(base='omega', dots=1, prime=False, indices=('x',), seen_from='', by='')
    >>> glyph("roller_omega_x").base, glyph("roller_omega_x").indices, glyph("w3").indices
    ('omega', ('roller', 'x'), ('3',))
    >>> glyph("l_N_dot").seen_from, glyph("mass_1").indices, glyph("top_speed_x").base
    ('N', ('1',), 'top speed')
    >>> glyph("F_x_by_alpha_ddot").dots, glyph("F_x_by_alpha_ddot").by
    (0, 'alpha_ddot')
    """
    own, _, by = name.partition("_by_")
    parts = own.split("_")
    seen_from = "N" if any(a == "N" and b in _DOTS for a, b in pairwise(parts[1:])) else ""
    marks = (*_DOTS, "prime", "any", seen_from)
    base, indices = _base([parts[0], *(part for part in parts[1:] if part not in marks)])
    return Glyph(
        base,
        sum(_DOTS.get(part, 0) for part in parts[1:]),
        "prime" in parts[1:],
        tuple(part for part in indices if part),
        seen_from,
        by,
    )


def _base(parts: list[str]) -> tuple[str, list[str]]:
    """Split off the base: one letter, the first Greek letter, or words up to a short part."""
    first, *rest = parts
    if len(first) > 1 and first not in FUNCTIONS:
        greek = next((i for i, part in enumerate(parts) if part in GREEK), None)
        if greek is not None:
            return parts[greek], [*parts[:greek], *parts[greek + 1 :]]
        end = 1 + max((i for i, part in enumerate(parts) if len(part) > _SHORT), default=0)
        first, rest = " ".join(parts[:end]), parts[end:]
    counted = _COUNTED.fullmatch(first)
    return (counted[1], [counted[2], *rest]) if counted else (first, rest)
