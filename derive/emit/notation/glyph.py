"""What a name such as omega_dot_x says: a letter, its dots, its indices, and whose rate it is."""

from dataclasses import dataclass
from itertools import pairwise

# fmt: off
GREEK = {
    "alpha": "α", "beta": "β", "gamma": "γ", "delta": "δ", "epsilon": "ε", "zeta": "ζ",
    "eta": "η", "theta": "θ", "iota": "ι", "kappa": "κ", "lambda": "λ", "mu": "μ",
    "nu": "ν", "xi": "ξ", "omicron": "ο", "pi": "π", "rho": "ρ", "sigma": "σ",
    "tau": "τ", "upsilon": "υ", "phi": "φ", "chi": "χ", "psi": "ψ", "omega": "ω",
}
# fmt: on
GREEK |= {name.capitalize(): letter.upper() for name, letter in GREEK.items()}
_DOTS = {"dot": 1, "ddot": 2}
_SHORT = 2  # an index has at most two letters; a longer part belongs to a word


@dataclass(frozen=True)
class Glyph:
    """A name taken apart: ``base`` with dots or a prime, its indices, and "N" if seen from N.

    by : for a coefficient, the name of the quantity by which it is multiplied
    """

    base: str
    dots: int = 0
    prime: bool = False
    indices: tuple[str, ...] = ()
    seen_from: str = ""
    by: str = ""


def glyph(name: str) -> Glyph:
    """Return a name taken apart.

    >>> glyph("omega_dot_x")
    Glyph(base='omega', dots=1, prime=False, indices=('x',), seen_from='', by='')
    >>> glyph("l_N_dot").seen_from, glyph("mass_1").indices, glyph("top_speed_x").base
    ('N', ('1',), 'top_speed')
    >>> glyph("F_x_by_alpha_ddot").dots, glyph("F_x_by_alpha_ddot").by
    (0, 'alpha_ddot')
    """
    own, _, by = name.partition("_by_")
    base, parts = _base(own.split("_"))
    seen_from = "N" if any(a == "N" and b in _DOTS for a, b in pairwise(parts)) else ""
    not_indices = (*_DOTS, "prime", "any", seen_from)
    return Glyph(
        base,
        sum(_DOTS.get(part, 0) for part in parts),
        "prime" in parts,
        tuple(part for part in parts if part not in not_indices),
        seen_from,
        by,
    )


def _base(parts: list[str]) -> tuple[str, list[str]]:
    """Split off the base: one letter, one Greek letter, or words up to the first short part."""
    end = 1
    if len(parts[0]) > 1 and parts[0] not in GREEK:
        long = [i for i, part in enumerate(parts) if len(part) > _SHORT and part not in _DOTS]
        end = max([1, *(i + 1 for i in long)])
    return "_".join(parts[:end]), parts[end:]
