"""``derive solve``: the answers of a machine as numbers with units, from the command line."""

import argparse
import os
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from math import isfinite, nan, pi
from pathlib import Path

from numpy.linalg import LinAlgError

from derive.emit.files import require_writable, write
from derive.scene import CATALOGUE, SceneError
from derive.scene.machine import LEFT_OVER
from derive.scene.table import MANY, nearest, shown
from derive.scene.unit import ANGULAR_VELOCITY, NONE, dimension
from derive.solve.instrument import Instrument, opened
from derive.solve.motions import frequencies, growth, limits, roots
from derive.solve.simulation import plot, simulated

PrintedRow = tuple[str, str, str, str]
FACTORS = {"": 1.0, "deg": pi / 180, "rpm": 2 * pi / 60}
"""Units that a value may be set in beside SI: ``skew=3deg``."""
OF = {"deg": NONE, "rpm": ANGULAR_VELOCITY}
STEP = 1e-3  # s
NUMBER = re.compile(r"([+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]{1,6})?) ?(|deg|rpm)")


@dataclass(frozen=True)
class Printout:
    """Rows of what, where from, value and unit; what stays unanswered, a clause a function; doubts.

    doubts : warnings about the values that were set
    """

    rows: list[PrintedRow]
    unanswered: list[str]
    doubts: tuple[str, ...] = ()


def options(command: argparse.ArgumentParser) -> None:
    """Declare the options of ``derive solve``."""
    command.add_argument("scene", metavar="SCENE", help="catalogue name or path to a TOML file")
    command.add_argument(
        "--set",
        action="append",
        nargs="+",
        default=[],
        metavar="NAME=VALUE",
        help="a parameter or input, in SI units, or as 3deg or 5000rpm",
    )
    command.add_argument(
        "--limit",
        action="append",
        default=[],
        metavar="NAME",
        help="find the values of NAME, in its range, at which stability changes",
    )
    command.add_argument(
        "--until", type=float, metavar="SECONDS", help="move in time by the scene's step_rk4"
    )
    command.add_argument(
        "--step",
        type=float,
        metavar="SECONDS",
        help=f"longest step, of which --until is a multiple ({STEP:g})",
    )
    command.add_argument(
        "--plot", type=Path, metavar="FILE", help="write the motion as SVG (with --until)"
    )


def _simulated(
    given: argparse.Namespace, found: Instrument, values: dict[str, float]
) -> list[PrintedRow]:
    """Return the state at the end of a motion, its plot written if a file is named."""
    if given.plot is not None:
        _require_another_file(given.plot, given.scene)
        require_writable(given.plot)
    step = STEP if given.step is None else given.step
    motion = simulated(found, values, given.until, step)
    if given.plot is not None:
        write(given.plot.parent, {given.plot.name: plot(motion)})
    at = f"at {motion.times[-1]:.6g} s"
    return [(at, n, f"{v[-1]:.12g}", motion.units[n]) for n, v in motion.states.items()]


def _require_another_file(file: Path, scene: str) -> None:
    """Refuse to write over the scene itself."""
    for own in (Path(scene), CATALOGUE / f"{scene}.toml"):
        if os.path.exists(file) and os.path.isfile(own) and file.samefile(own):
            raise SceneError(f"--plot {file}: the scene itself lies there; name another file")


def printout(given: argparse.Namespace) -> Printout:
    """Return what was asked for, and what stays unanswered because a value is not set.

    Raises SceneError for options that do not go together, and for values without an answer.
    """
    _require_one_question(given)
    found = opened(given.scene)
    values = settings(found, [text for group in given.set for text in group])
    return replace(_solved(given, found, values), doubts=found.doubts(values))


def _solved(given: argparse.Namespace, found: Instrument, values: dict[str, float]) -> Printout:
    if given.until is not None:
        return Printout(_simulated(given, found, values), [])
    try:
        if given.limit:
            return _limits(given, found, values)
        return _every_answer(found, values)
    except LinAlgError as error:
        raise SceneError(
            f"scene '{found.name}': small motion needs a mass matrix that can be inverted, "
            f"but with these values: {error}"
        ) from None


def _require_one_question(given: argparse.Namespace) -> None:
    if given.plot is not None and given.until is None:
        raise SceneError(f"--plot {given.plot}: a plot shows a motion and needs --until SECONDS")
    if given.step is not None and given.until is None:
        raise SceneError(f"--step {given.step:g}: a step is of a motion and needs --until SECONDS")
    if given.limit and given.until is not None:
        raise SceneError(
            f"--limit {given.limit[0]}: limits of stability are no motion; leave out "
            f"--until {given.until:g}"
        )


NOWHERE = "none in its range"


def _limits(given: argparse.Namespace, found: Instrument, values: dict[str, float]) -> Printout:
    unit = {c: q.unit for q in found.quantities() for c in q.components}
    wanted = found.library.scene.wanted
    if "linearised" not in wanted:
        raise SceneError(f"scene '{found.name}': --limit needs wanted = [..., \"linearised\"]")
    rows: list[PrintedRow] = []
    for name in given.limit:
        each = [f"{v:.12g}" for v in limits(found, values, _settable(found, name))]
        rows += [("limit of stability", name, v, unit.get(name, "")) for v in each or [NOWHERE]]
    return Printout(rows, [])


def _every_answer(found: Instrument, values: dict[str, float]) -> Printout:
    answered = Printout([], [])
    for name in found.library.scene.wanted:
        missing = _missing(found, name, values)
        if missing:
            answered.unanswered.append(f"'{name}' needs {', '.join(missing)}")
        else:
            answered.rows.extend(_rows(found, name, values))
    return answered


def settings(found: Instrument, texts: Sequence[str]) -> dict[str, float]:
    """Return the values of a list such as ``m=1200 skew=3deg``.

    Raises SceneError for a name that the scene does not have or that is set twice, and for a value
    that is no number or in a unit of something else.
    """
    values: dict[str, float] = {}
    units = {c: q.unit for q in found.quantities() for c in q.components}
    for text in texts:
        name, _, value = text.partition("=")
        known = _settable(found, name.strip())
        if known in values:
            raise SceneError(f"--set {text[:60]}: '{known}' is set twice")
        values[known] = _number(text, value.strip(), units[known])
    return values


def _settable(found: Instrument, name: str) -> str:
    names = [c for q in found.quantities() for c in q.components]
    if name not in names:
        few = f" (known: {', '.join(names[:MANY])} and {len(names) - MANY} more)"
        hint = nearest(name, names) or few
        raise SceneError(f"scene '{found.name}' has no {shown(name)} to set{hint}")
    return name


def _number(text: str, value: str, unit: str) -> float:
    found = NUMBER.fullmatch(value)
    if found and found[2] and dimension(unit) != OF[found[2]]:
        raise SceneError(f"--set {text[:60]}: the value is in {unit}, not in {found[2]}")
    number = float(found[1]) * FACTORS[found[2]] if found else nan
    if not isfinite(number):
        raise SceneError(
            f"--set {text[:60]}: a value is a number, as m=1200 or skew=3deg, not {shown(value)}"
        )
    return number


def _unknowns(found: Instrument, name: str, values: dict[str, float]) -> tuple[str, ...]:
    """Return the unknowns of a steady motion that is to be found; none if they are all set."""
    scene = found.library.scene
    steady = scene.steady if name == "steady" else None
    return () if steady is None or all(n in values for n in steady.unknown) else steady.unknown


def _missing(found: Instrument, name: str, values: dict[str, float]) -> list[str]:
    given = (*values, *_unknowns(found, name, values))
    return [c for c in found.needed(name.removesuffix("_jacobian")) if c not in given]


def _rows(found: Instrument, name: str, values: dict[str, float]) -> Iterator[PrintedRow]:
    if _unknowns(found, name, values):
        unit = {c: q.unit for q in found.quantities() for c in q.components}
        for number, root in enumerate(roots(found, values), 1):
            for unknown, value in root.items():
                yield f"steady motion {number}", unknown, f"{value:.12g}", unit[unknown]
        return
    units = {c: q.unit for q in found.library[name].outputs for c in q.components}
    for component, value in found.answer(name, values).items():
        if not isfinite(value):
            raise SceneError(
                f"scene '{found.name}': '{name}' must be finite, but with these values "
                f"{component} is {value}"
            )
        shown = f"{component}, {LEFT_OVER}" if name == "steady" else component
        yield name, shown, f"{value:.12g}", units[component]
    if name == "linearised":
        for number, value in enumerate(frequencies(found, values), 1):
            yield "small motion", f"frequency {number}", f"{value:.12g}", "rad/s"
        yield "small motion", "growth", f"{growth(found, values):.12g}", "1/s"
