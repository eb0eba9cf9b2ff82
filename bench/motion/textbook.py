"""Peers written as textbooks do, in C: RK4 with normalisation, and DOP853 with SciPy's numbers."""

from collections.abc import Sequence
from importlib.resources import files
from pathlib import Path

from bench.motion.case import Case
from bench.motion.runner import Mover, built, methods_header

RK4, DOP853 = "RK4 + normalise, C", "DOP853, C"
PUBLISHED = "DMV order 10 as published, C"
PARAMETERS = 15


def textbook(case: Case, precision: str, folder: Path) -> Mover:
    """Return RK4 and DOP853 built for the kind of a case. Raises ImportError without SciPy."""
    source = (files("bench.motion") / "textbook.c").read_text(encoding="utf-8")
    texts = {
        "methods.h": methods_header(precision, PARAMETERS),
        "textbook.c": source,
        "dop853.h": stages(),
    }
    return built(texts, (RK4, DOP853), PARAMETERS, folder, [f"-D{kind}" for kind in kinds(case)])


def published(precision: str, folder: Path) -> Mover:
    """Return the Moser-Veselov step as it was published, for free bodies along principal axes."""
    source = (files("bench.motion") / "published.c").read_text(encoding="utf-8")
    texts = {"methods.h": methods_header(precision, PARAMETERS), "published.c": source}
    return built(texts, (PUBLISHED,), PARAMETERS, folder)


def kinds(case: Case) -> list[str]:
    """Return the macros for what a case has beyond a free principal body."""
    has = {
        "PRODUCTS": not case.principal,
        "MOMENT": any(case.moment),
        "WHEEL": any(case.wheel),
        "WEIGHT": any(case.weight),
    }
    return [name for name, there in has.items() if there]


def parameters(case: Case) -> list[float]:
    """Return the numbers of a case that the textbook's methods take."""
    return [float(x) for x in (*case.inertia, *case.moment, *case.wheel, *case.weight)]


def stages() -> str:
    """Return the stages of DOP853 as C: zeros left out, the rate at the end kept for the next."""
    from scipy.integrate._ivp import dop853_coefficients as given

    count = given.N_STAGES
    lines = []
    for stage in range(1, count):
        lines += [*_sum("s", "y[i] + h", given.A[stage, :stage]), f"    rate(s, k[{stage}]);"]
    lines += [*_sum("next", "y[i] + h", given.B), f"    rate(next, k[{count}]);"]
    lines += [*_sum("err5", "1", given.E5), *_sum("err3", "1", given.E3)]
    body = "\n".join(lines)
    return f"""\
static inline void dop853_stages(real h, const real *y, real (*k)[N], real *next, real *err5,
                                 real *err3)
{{
    real s[N];
{body}
}}
"""


def _sum(to: str, before: str, row: Sequence[float]) -> list[str]:
    terms = [f"(real){float(x)!r} * k[{n}][i]" for n, x in enumerate(row) if x]
    total = " + ".join(terms)
    return [
        "    for (int i = 0; i < N; i++) {",
        f"        {to}[i] = {before} * ({total});",
        "    }",
    ]
