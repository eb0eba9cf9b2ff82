"""Hard cases in which nothing but the attitude moves: pure spins about each axis, and rest."""

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from functools import partial

from bench.motion.case import Case
from bench.motion.wrong import ROUNDOFF
from bench.report.case_run import PRECISIONS, Workshop
from bench.report.elliptic import elliptic
from bench.report.hard import ELLIPTIC, Hard, best, by_precision

NAMES = (*(f"pure spin about {axis}" for axis in "xyz"), "zero rate")
RATE = 2
KAPPA = 40.0  # rad turned, twice: the rate and the time may each be rounded


def spins(given: Case, shop: Workshop) -> Iterator[Hard]:
    """Yield a row for a spin about each principal axis, and one for a body at rest.

    given : gives the inertia and the time. Raises ImportError without mpmath
    """
    for n, name in enumerate(NAMES):
        case = spinning(given, n)
        naive = {p: (elliptic(case, p),) for p in PRECISIONS}
        ours = by_precision(partial(best, case, "flow_exact", shop))
        yield Hard(name, "omega / attitude", ELLIPTIC, naive, "flow_exact", ours,
                   {p: KAPPA * ROUNDOFF[p] for p in PRECISIONS},
                   "kappa u: rate and time may each be rounded")  # fmt: skip


def spinning(given: Case, n: int) -> Case:
    """Return a body that spins about axis ``n`` for 10 s, or rests if there is no such axis."""
    import mpmath

    omega = tuple(Fraction(RATE * (k == n)) for k in range(3))
    with mpmath.workdps(50):
        half = mpmath.mpf(10) * RATE / 2
        size = [mpmath.cos(half), *(mpmath.sin(half) * (k == n) for k in range(3))]
        q = tuple(Fraction(mpmath.nstr(x, 45)) for x in size)
    rest = (Fraction(1), *omega)
    start = (Fraction(1), Fraction(0), Fraction(0), Fraction(0))
    q_T = q if any(omega) else rest
    return replace(given, name=f"spin_{n}", omega0=omega, omega_T=omega, q0=start, q_T=q_T,
                   time=Fraction(10), kappa_omega=1.0, kappa_attitude=KAPPA)  # fmt: skip
