"""What a sweep is asked for, checked: numbers, counts, what is missing, what lies out of range."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from math import isfinite
from typing import Any

from derive.scene import SceneError
from derive.scene.declaration import Input
from derive.scene.table import shown
from derive.scene.unit import behind
from derive.solve.arguments import one_number
from derive.solve.instrument import Instrument
from derive.solve.lacking import advice_on
from derive.solve.simulation import STEP
from derive.solve.sweep.design import Design
from derive.solve.sweep.job import OWN_COLUMNS
from derive.solve.sweep.recommended import usable
from derive.solve.sweep.vary import Spread, variations
from derive.solve.told import count, met

EXTRA = "pip install 'derive-eom[sweep]'"
MOST_MEMBERS = 1 << 32
MOST_SEED = 2**63 - 1
MOST_INSTANTS = 10_000
MOST_WORKERS = 4096
ERROR = 1e-6
FARTHEST_START = 0.5
"""Of its declared range, how far a component is moved at most so that constraints hold."""


@dataclass(frozen=True)
class Request:
    """What a sweep is asked for, as it was given; ``Handle.sweep`` says what each means."""

    vary: object
    samples: Any
    until: Any
    keep: object
    stop: object
    error: Any
    step: Any
    seed: Any
    instants: Any
    pairs: Any
    workers: Any
    scheduler: object
    chunk: Any
    near: Any


def require_installed(modules: Sequence[str]) -> None:
    """Raise SceneError if something that a sweep needs is not installed."""
    missing = [name for name in modules if find_spec(name) is None]
    if missing:
        says = f"{' and '.join(missing)} {'is' if len(missing) == 1 else 'are'} not installed"
        raise SceneError(f"a sweep needs the extra of that name, and {says}: {EXTRA}")


def design_of(found: Instrument, asked: Request, values: Mapping[str, float]) -> Design:
    """Return the members of a sweep. Raises SceneError for counts and spreads that make none."""
    label = f"scene '{found.name}'"
    each = variations(found.name, found.quantities(), asked.vary, values)
    taken = [s.name for s in each if s.name in OWN_COLUMNS]
    if taken:
        raise SceneError(f"{label}: '{taken[0]}' cannot vary: a column of every sweep is called so")
    samples = whole_number(f"{label}: samples", asked.samples, MOST_MEMBERS, least=1)
    seed = whole_number(f"{label}: seed", asked.seed, MOST_SEED, least=0)
    pairs = whole_number(f"{label}: pairs", asked.pairs, 2**40, least=0)
    if pairs and pairs & (pairs - 1):
        raise SceneError(f"{label}: pairs must be a power of two, or 0, not {pairs}")
    made = Design(each, samples, pairs, seed)
    if not made.drawn and samples > 1:
        says = f"all that varies is on grids, of {made.points} points, so samples must be 1"
        raise SceneError(f"{label}: {says}, not {samples}")
    if made.members > MOST_MEMBERS:
        rule = f"a sweep has at most {MOST_MEMBERS} members"
        raise SceneError(f"{label}: {rule}, not {made.members}")
    return made


def whole_number(what: str, value: Any, most: int, least: int) -> int:
    """Return a whole number, which may be given as 1e6. Raises SceneError for any other."""
    if isinstance(value, float) and isfinite(value) and value == int(value):
        value = int(value)
    if least == 0 and type(value) is int and value == 0:
        return 0
    return count(what, value, range(1, most + 1))


def above_zero(label: str, name: str, value: Any) -> float:
    """Return a number above zero. Raises SceneError for any other."""
    found = one_number(label, name, value)
    if not (isfinite(found) and found > 0):
        raise SceneError(f"{label}: {name} must be a number above zero, not {found:g}")
    return found


def resting(found: Instrument, known: Mapping[str, float]) -> dict[str, float]:
    """Return the rates of coordinates that nobody tells: members begin at rest in them."""
    states = {c for q in found.library.vocabulary.states for c in q.components}
    rates = (c.rate for c in found.library.scene.coordinates)
    names = [rate.name for rate in rates if isinstance(rate, Input)]
    return {name: 0.0 for name in names if name in states and name not in known}


def require_motion(found: Instrument, known: Mapping[str, float]) -> None:
    """Raise SceneError if a scene cannot be moved as `solve` moves it, or values are missing."""
    scene, label = found.library.scene, f"scene '{found.name}'"
    if STEP not in scene.wanted:
        raise SceneError(advice_on(scene, STEP, "a sweep"))
    states = [c for q in found.library.vocabulary.states for c in q.components]
    if missing := [n for n in states if n not in known]:
        raise SceneError(f"{label}: a sweep begins at {', '.join(missing)}: set it, or let it vary")
    if STEP not in usable(found.library):
        raise SceneError(f"{label}: '{STEP}' has no code over members: it has loops or angles")
    needed = [n for n in found.needed(STEP) if n != "time_step"]
    if missing := [n for n in needed if n not in known]:
        raise SceneError(f"{label}: '{STEP}' needs {', '.join(missing)}: set it, or let it vary")


def outside_at_start(
    found: Instrument, each: Sequence[Spread], values: Mapping[str, float]
) -> Iterator[str]:
    """Yield a warning for each number at the start that may lie outside of its declared range."""
    within = {name: (x, x) for name, x in values.items()} | {s.name: s.within for s in each}
    for q in found.quantities():
        low, high = float(q.low or 0), float(q.high or 0)
        for c in () if q.is_quaternion else q.components:
            least, most = within.get(c, (low, low))
            if least < low or most > high:
                is_at = f"{least:.6g}" if least == most else f"{least:.6g} to {most:.6g}"
                says = f"{c} is {is_at}{behind(q.unit)}"
                yield f"{says}, outside of its range, {low:g} to {high:g}"


def scheduler_of(value: object) -> str | None:
    """Return the address of a scheduler, None for this machine. Raises SceneError for no text."""
    if value is not None and (not isinstance(value, str) or not value.strip()):
        rule = "scheduler must be an address, as 'tcp://10.0.0.1:8786'"
        raise SceneError(f"{rule}, not {met(value)}")
    return value


def stop_of(value: object) -> str:
    """Return how a file tells of an event."""
    return value.strip() if isinstance(value, str) else "" if value is None else shown(str(value))
