"""How chains of rods grow dearer, rod by rod: operations, errors and seconds, drawn as SVG.

``python -m bench.growth`` writes ``docs/pictures/links.svg``; few samples tell the errors.
"""

import argparse
import io
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from time import process_time
from typing import Any

from bench.chains import chain
from bench.links import MOST_OF_SYMPY, by_kane
from bench.report.plots import STYLE
from derive.command.terminal import console
from derive.emit.files import write
from derive.library.library import library
from derive.scene import parse_scene
from derive.verify.prove import prove
from derive.verify.search import SAMPLING
from derive.verify.stated import figures

PLACE = Path("docs/pictures")
RODS = (1, 2, 3, 4, 5, 6, 8, 10, 14, 20)
FEW = replace(SAMPLING, samples=2000, rounds=4, batch=256, kept=4, balls=16, corners=2)
"""How widely errors are looked for; a scene's own page looks a hundred times as widely."""
KINDS = {"parallel axes": "y", "axes in turn": "yx"}
COLOURS = {"parallel axes": "#1f6f8b", "axes in turn": "#b5542b"}
WIDTH, HEIGHT = 8.4, 2.8  # inch


@dataclass(frozen=True)
class Grown:
    """A chain: operations of its accelerations, ours and by SymPy, largest error, CPU seconds."""

    rods: int
    flops: int
    theirs: int | None
    error: float
    seconds: float


def grown(axes: str) -> Grown:
    """Return what a chain takes; seconds are those to derive, to prove and to measure it."""
    start = process_time()
    made = library(parse_scene(chain(axes), "chain"))
    prove(made)
    error = max(m.worst for m in figures(made, FEW))
    seconds = process_time() - start
    rods = len(axes)
    theirs = by_kane(made.scene).flops if rods <= MOST_OF_SYMPY else None
    return Grown(rods, made["accelerations"].flops(), theirs, error, seconds)


def picture(kinds: Mapping[str, Sequence[Grown]]) -> str:
    """Return three plots side by side: operations, the largest error, seconds; over rods."""
    import matplotlib as mpl
    from matplotlib.figure import Figure

    with mpl.rc_context(STYLE):
        drawn = Figure(figsize=(WIDTH, HEIGHT), layout="constrained")
        flops, errors, seconds = drawn.subplots(1, 3)
        for name, each in kinds.items():
            own: dict[str, Any] = {"color": COLOURS[name], "marker": "o", "markersize": 3}
            rods = [g.rods for g in each]
            flops.plot(rods, [g.flops for g in each], label=name, **own)
            told = [g for g in each if g.theirs is not None]
            kane = {**own, "linestyle": ":", "label": f"{name}, SymPy"}
            flops.plot([g.rods for g in told], [g.theirs for g in told], **kane)
            errors.plot(rods, [g.error for g in each], **own)
            seconds.plot(rods, [g.seconds for g in each], **own)
        for axes, says in ((flops, "operations"), (errors, "largest error, u"),
                           (seconds, "seconds of CPU")):  # fmt: skip
            axes.set(xlabel="rods", ylabel=says, ylim=(0, None))
            axes.xaxis.get_major_locator().set_params(integer=True)
            axes.spines[["top", "right"]].set_visible(False)
        handles = flops.get_legend_handles_labels()
        drawn.legend(*handles, loc="outside upper center", ncols=4, frameon=False, fontsize=7)
        out = io.StringIO()
        drawn.savefig(out, format="svg", metadata={"Date": None, "Creator": None})
    return "\n".join(line.rstrip() for line in out.getvalue().splitlines()) + "\n"


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the figures, draw them; return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m bench.growth", description=__doc__)
    parser.add_argument("--most", type=int, default=RODS[-1], metavar="RODS", help="of a chain")
    most = parser.parse_args(arguments).most
    found: dict[str, list[Grown]] = {name: [] for name in KINDS}
    for n in (n for n in RODS if n <= most):
        for name, axes in KINDS.items():
            own = grown((axes * n)[:n])
            found[name].append(own)
            beside = own.theirs or "-"
            says = f"{own.flops} operations, SymPy {beside}, {own.error:.2g} u, {own.seconds:.1f} s"
            console.print(f"{name}, {n}: {says}")
            write(PLACE, {"links.svg": picture(found)})
    return 0


if __name__ == "__main__":
    sys.exit(main())
