"""Coefficients of splittings: by which part of the step each flow moves, in which order.

A scheme of stages alternates a flow A and a flow B, A first and last, and reads the same from both
ends. Blanes and Moan, J. Comput. Appl. Math. 142 (2002) 313, tables 2 and 3: S6 of order four,
S10 of order six, SRKN6b of order four. They print fifteen digits; here as many coefficients as
there are order conditions are solved for, to 45 digits, and the others are taken as printed.
"""

from dataclasses import dataclass
from fractions import Fraction


@dataclass(frozen=True)
class Scheme:
    """Parts of the step: ``outer`` has one more than ``inner``, and each sums to one."""

    outer: tuple[Fraction, ...]
    inner: tuple[Fraction, ...]

    def halves(self) -> list[tuple[Fraction, Fraction]]:
        """Return how each inner part is cut in two so that more than two flows keep the order.

        The parts between the cuts are those of a composition of a first-order step with its
        adjoint, and that has the order of the scheme: McLachlan, SIAM J. Sci. Comput. 16 (1995).
        """
        cut = []
        first = self.outer[0]
        for part, after in zip(self.inner, self.outer[1:], strict=True):
            cut.append((first, part - first))
            first = after - (part - first)
        return cut


def _even(outer: tuple[str, ...], inner: tuple[str, ...]) -> Scheme:
    """Return the scheme of an even number of stages from the coefficients before the middle."""
    a, b = [Fraction(x) for x in outer], [Fraction(x) for x in inner]
    zero = Fraction(0)
    middle, last = 1 - 2 * sum(a, zero), Fraction(1, 2) - sum(b, zero)
    return Scheme((*a, middle, *a[::-1]), (*b, last, last, *b[::-1]))


STRANG = Scheme((Fraction(1, 2), Fraction(1, 2)), (Fraction(1),))
S6 = _even(
    (
        "0.0792036964311957",
        "0.353172906049774",
        "-0.0420650803577197044759166922696745685688995161",
    ),
    ("0.209515106613362", "-0.143851773179817469134513970208481911492218292"),
)
S10 = _even(
    (
        "0.0502627644003922",
        "0.413514300428348280764209253255138114149686465",
        "0.0450798897943974211608542852757026623955981398",
        "-0.188054853819572834204124900735074375035274206",
        "0.541960678450781754723292263234705650176816914",
    ),
    (
        "0.148816447901042589908187280537323712859617259",
        "-0.13238586576778220961970225158894497276003202",
        "0.067307604692185237371836190579050618905113405",
        "0.432666402578172088198748915901779274874621282",
    ),
)
NYSTROEM6 = _even(
    (
        "0.0829844064174052",
        "0.396309801498368",
        "-0.0390563049223458447796196772700123156216524934",
    ),
    ("0.245298957184271", "0.604872665711094423109328512782106074714952793"),
)
