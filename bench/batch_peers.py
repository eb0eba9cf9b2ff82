"""``python -m bench.batch_peers``: a thousand satellites tumble, ours beside others, in one run.

Every tool has the coarsest setting that keeps members within an error of the motion that SciPy
follows with the tightest tolerance. Times are of one core, without compiling.
"""

import ctypes
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from bench.batch import alone
from derive.check.compiler import callable_library, find_compiler
from derive.emit.c.members_file import VECTOR_OPTIONS, members_files
from derive.emit.c.source import c_files
from derive.library.library import library
from derive.scene import load
from derive.solve.members import shared_members

INERTIA = np.array([10.0, 12.0, 14.0])  # kg m^2
MEMBERS, UNTIL = 1000, 10.0  # -, s
ERRORS = (1e-6, 1e-11)
"""Of the largest component at the end."""
TRUE = 24
"""Members that are followed by the tightest tolerance."""
SCENE = "tumbling_body"
WAYS = ("flow_exact", "step_split6", "step_rk4")
MARCH = """
#include "tumbling_body_batch_f64.h"
void march(ptrdiff_t n, long steps, const double *inertia, double *q, double *omega, {kind} h);
void march(ptrdiff_t n, long steps, const double *inertia, double *q, double *omega, {kind} h)
{{
    tumbling_body_constants_f64 constants;
    long s;
    if (tumbling_body_setup_f64(inertia[0], inertia[1], inertia[2], &constants) != 0) {{ return; }}
    for (s = 0; s < steps; ++s) {{
        tumbling_body_{function}_batch_f64(n, n, &constants, q, omega, h, q, omega);
    }}
}}
"""
Way = Callable[[float], tuple[Any, float]]
"""Move all members by a setting: their states at the end, (7, members), and the seconds it took."""


def start() -> Any:
    """Return attitudes and angular velocities, (7, members)."""
    dice = np.random.Generator(np.random.Philox(7))
    q = dice.normal(size=(4, MEMBERS))
    return np.concatenate([q / np.linalg.norm(q, axis=0), dice.uniform(-1, 1, (3, MEMBERS))])


def rate(x: Any, array: Any = np) -> Any:
    """Return the rate of states, (7, members) or (7,)."""
    w, i, j, k, p, q, r = x
    a, b, c = INERTIA
    return array.stack([
        (-i * p - j * q - k * r) / 2, (w * p + j * r - k * q) / 2,
        (w * q + k * p - i * r) / 2, (w * r + i * q - j * p) / 2,
        (b - c) / a * q * r, (c - a) / b * r * p, (a - b) / c * p * q,
    ])  # fmt: skip


def classic(x: Any, h: float, array: Any = np) -> Any:
    """Return states after a step of the classic Runge-Kutta method."""
    a = rate(x, array)
    b = rate(x + h / 2 * a, array)
    c = rate(x + h / 2 * b, array)
    x = x + h / 6 * (a + 2 * b + 2 * c + rate(x + h * c, array))
    return array.concatenate([x[:4] / array.sqrt((x[:4] ** 2).sum(axis=0)), x[4:]])


def ours(function: str, folder: Path) -> Way:
    """Return how the C over members moves them, by one of WAYS."""
    made = library(load(SCENE))
    made = alone(made, made[function])
    texts = {n: t for n, t in (c_files(made, ()) | members_files(made, ())).items() if "_f64" in n}
    exact = function == "flow_exact"
    march = MARCH.format(function=function, kind="const double *" if exact else "double")
    file = shared_members({**texts, "march.c": march}, folder, find_compiler(), VECTOR_OPTIONS)
    shared = callable_library(file)

    def way(h: float) -> tuple[Any, float]:
        x, steps = start(), round(UNTIL / h)
        at = [ctypes.c_void_p(a.ctypes.data) for a in (INERTIA, x, x[4:])]
        times = np.full(MEMBERS, h)
        last = ctypes.c_void_p(times.ctypes.data) if exact else ctypes.c_double(h)
        begin = time.perf_counter()
        shared.march(ctypes.c_ssize_t(MEMBERS), ctypes.c_long(steps), *at, last)
        return x, time.perf_counter() - begin

    return way


def by_numpy(h: float) -> tuple[Any, float]:
    """Move all members by NumPy, a step of all at a time."""
    x, begin = start(), time.perf_counter()
    for _ in range(round(UNTIL / h)):
        x = classic(x, h)
    return x, time.perf_counter() - begin


def followed(x: Any, tolerance: float) -> Any:
    """Return the state that SciPy moves one member to."""
    from scipy.integrate import solve_ivp

    found = solve_ivp(lambda _, y: rate(y), (0, UNTIL), x, "DOP853", rtol=tolerance, atol=tolerance)
    return found.y[:, -1]


def by_scipy(tolerance: float) -> tuple[Any, float]:
    """Move members one by one by SciPy; the time of all is that of some of them."""
    x, begin = start(), time.perf_counter()
    for n in range(TRUE):
        x[:, n] = followed(x[:, n], tolerance)
    return x, (time.perf_counter() - begin) * MEMBERS / TRUE


def by_jax() -> Way:
    """Return how JAX moves them, compiled by XLA before."""
    import jax

    jax.config.update("jax_enable_x64", val=True)
    array = jax.numpy

    def way(h: float) -> tuple[Any, float]:
        x = array.asarray(start())
        steps = round(UNTIL / h)
        moved = jax.jit(lambda y: jax.lax.fori_loop(0, steps, lambda _, z: classic(z, h, array), y))
        moved(x).block_until_ready()
        begin = time.perf_counter()
        found = moved(x).block_until_ready()
        return np.asarray(found), time.perf_counter() - begin

    return way


def by_heyoka() -> Way:
    """Return how heyoka's batch mode moves them, compiled by LLVM before."""
    import heyoka

    names = heyoka.make_vars("w", "i", "j", "k", "p", "q", "r")
    w, i, j, k, p, q, r = names
    a, b, c = INERTIA
    system = [
        (w, (-i * p - j * q - k * r) / 2),
        (i, (w * p + j * r - k * q) / 2),
        (j, (w * q + k * p - i * r) / 2),
        (k, (w * r + i * q - j * p) / 2),
        (p, (b - c) / a * q * r),
        (q, (c - a) / b * r * p),
        (r, (a - b) / c * p * q),
    ]
    width = heyoka.recommended_simd_size()

    def way(tolerance: float) -> tuple[Any, float]:
        x = start()
        whole = heyoka.taylor_adaptive_batch(system, x[:, :width].copy(), tol=tolerance)
        begin = time.perf_counter()
        for n in range(0, MEMBERS, width):
            own = x[:, n : n + width]
            whole.set_time(0.0)
            whole.state[:, : own.shape[1]] = own
            whole.propagate_until(UNTIL)
            own[...] = whole.state[:, : own.shape[1]]
        return x, time.perf_counter() - begin

    return way


def tools(folder: Path) -> Iterator[tuple[str, Way, Sequence[float]]]:
    """Yield each tool that is here, with its settings, coarse ones first."""
    steps = [UNTIL / n for n in (25, 50, 100, 200, 400, 800, 1600, 3200, 6400)]
    tolerances = [10.0**-n for n in range(3, 15)]
    for function in WAYS:
        (folder / function).mkdir()
        lengths = [UNTIL] if function == "flow_exact" else steps
        yield f"ours, `{function}_batch`", ours(function, folder / function), lengths
    yield "NumPy, the same RK4", by_numpy, steps
    yield "SciPy, DOP853 in a loop", by_scipy, tolerances
    for name, made, settings in (("JAX, the same RK4", by_jax, steps),
                                 ("heyoka, batch mode", by_heyoka, tolerances)):  # fmt: skip
        try:
            yield name, made(), settings
        except ImportError as error:
            print(f"{name}: not here ({error})\n")


def main() -> int:
    """Print what each tool takes."""
    x = start()
    true = np.array([followed(x[:, n], 3e-14) for n in range(TRUE)]).T
    print("| error at most | tool | setting | error | µs a member | of the quickest of ours |")
    print("|---|---|---|---|---|---|")
    rows: dict[float, list[tuple[str, float, float, float]]] = {most: [] for most in ERRORS}
    with TemporaryDirectory() as folder:
        for name, move, settings in tools(Path(folder)):
            tried = ((s, float(np.abs(move(s)[0][:, :TRUE] - true).max())) for s in settings)
            every = list(tried)
            for most in ERRORS:
                good = next(((s, e) for s, e in every if e <= most), None)
                if good is not None:
                    seconds = min(move(good[0])[1] for _ in range(5))
                    rows[most].append((name, *good, seconds))
    for most, found in rows.items():
        first = min(seconds for name, *_, seconds in found if name.startswith("ours"))
        for name, setting, error, seconds in found:
            print(f"| {most:g} | {name} | {setting:.2g} | {error:.1g} |"
                  f" {1e6 * seconds / MEMBERS:.3g} | {seconds / first:.2g} |")  # fmt: skip
    return 0


if __name__ == "__main__":
    sys.exit(main())
