"""``derive solve``: the answers of a machine as numbers with units, from the command line."""

import argparse
from collections.abc import Iterator, Sequence
from math import pi
from pathlib import Path

from derive.scene import Machine, SceneError
from derive.scene.table import nearest
from derive.solve.instrument import Instrument, opened
from derive.solve.motions import frequencies, growth, limits, roots
from derive.solve.simulation import plot, simulated

Row = tuple[str, str, str, str]
FACTORS = {"deg": pi / 180, "rpm": 2 * pi / 60}
"""Units that a value may be set in beside SI: ``skew=3deg``."""


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
        "--step", type=float, default=1e-3, metavar="SECONDS", help="length of a step (0.001)"
    )
    command.add_argument(
        "--plot", type=Path, metavar="FILE", help="write the motion as SVG (with --until)"
    )


def _moved(given: argparse.Namespace, found: Instrument, values: dict[str, float]) -> list[Row]:
    """Return the state at the end of a motion, its plot written if a file is named."""
    motion = simulated(found, values, given.until, given.step)
    if given.plot is not None:
        given.plot.write_text(plot(motion), encoding="utf-8")
    at = f"at {motion.times[-1]:.6g} s"
    return [(at, n, f"{v[-1]:.12g}", motion.units[n]) for n, v in motion.states.items()]


def solved(given: argparse.Namespace) -> list[Row]:
    """Return rows of what, where from, value and unit."""
    found = opened(given.scene)
    values = settings(found, [text for group in given.set for text in group])
    if given.until is not None:
        return _moved(given, found, values)
    if given.limit:
        unit = {c: q.unit for q in found.quantities() for c in q.components}
        return [
            ("limit of stability", name, f"{value:.12g}", unit.get(name, ""))
            for name in given.limit
            for value in limits(found, values, _known(found, name))
        ]
    return [row for name in found.library.known.scene.wanted for row in _rows(found, name, values)]


def settings(found: Instrument, texts: Sequence[str]) -> dict[str, float]:
    """Return the values of a list such as ``m=1200 skew=3deg``.

    Raises SceneError for a name that the scene does not have or a value that is no number.
    """
    values = {}
    for text in texts:
        name, _, value = text.partition("=")
        values[_known(found, name.strip())] = _number(text, value.strip())
    return values


def _known(found: Instrument, name: str) -> str:
    names = [c for q in found.quantities() for c in q.components]
    if name not in names:
        raise SceneError(f"scene '{found.name}' has no '{name}' to set{nearest(name, names)}")
    return name


def _number(text: str, value: str) -> float:
    for unit, factor in FACTORS.items():
        if value.endswith(unit):
            return _number(text, value.removesuffix(unit).strip()) * factor
    try:
        return float(value)
    except ValueError:
        raise SceneError(f"--set {text}: a value is a number, as m=1200 or skew=3deg") from None


def _rows(found: Instrument, name: str, values: dict[str, float]) -> Iterator[Row]:
    scene = found.library.known.scene
    steady = scene.steady if isinstance(scene, Machine) else None
    if name == "steady" and steady and not all(n in values for n in steady.unknown):
        unit = {c: q.unit for q in found.quantities() for c in q.components}
        for number, root in enumerate(roots(found, values), 1):
            for unknown, value in root.items():
                yield f"steady motion {number}", unknown, f"{value:.12g}", unit[unknown]
        return
    missing = [c for c in found.needed(name.removesuffix("_jacobian")) if c not in values]
    if missing:
        yield name, "", f"needs {', '.join(missing)}", ""
        return
    units = {c: q.unit for q in found.library[name].outputs for c in q.components}
    for component, value in found.answer(name, values).items():
        yield name, component, f"{value:.12g}", units[component]
    if name == "linearised":
        for number, value in enumerate(frequencies(found, values), 1):
            yield "small motion", f"frequency {number}", f"{value:.12g}", "rad/s"
        yield "small motion", "growth", f"{growth(found, values):.12g}", "1/s"
