"""The step and its length for a wanted error, as the report of a scene finds them."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from derive.emit.c.members import is_in_vectors
from derive.library.library import Library
from derive.program.precision import F64
from derive.report.courses import step_errors
from derive.report.driver import drivers
from derive.report.sentence import cheapest, choice, in_time, least, of_step, rounded_down
from derive.report.wishes import STEPS, Wished
from derive.scene import SceneError
from derive.solve.simulation import STEP


@dataclass(frozen=True)
class Recommended:
    """A step, its length in s, and a sentence on where these are from.

    replay : s, the length of the step of ``derive solve`` that keeps to the same error, or nearest
    """

    step: str
    length: float
    replay: float
    says: str


def recommended(
    library: Library, until: float, error: float, tell: Callable[[str], None]
) -> Recommended:
    """Return the cheapest of the scene's own steps over members that keeps to an error.

    Raises SceneError where none does, and where the report cannot follow motions so long.
    """
    scene, own = library.scene, usable(library)
    try:
        with TemporaryDirectory(prefix="derive-") as folder:
            by = drivers(library, (F64,), Path(folder))
            found = step_errors(Wished(library, own, own, {}), by, until, tell)
    except SceneError as refused:
        raise SceneError(f"{refused}; or --step sets the length of a step") from None
    best = cheapest(found, F64.name, error)
    if best is None:
        low = least(found, F64.name, own)
        keeps = f"keeps below {rounded_down(low, 1)}" if low < 1 else "ends near the true motion"
        says = f"over {until:g} s none of {', '.join(own)} was seen to keep below {error:g}"
        best_of = f"the best {keeps}" if low < 1 else f"none {keeps}"
        mend = "--step sets a length all the same"
        raise SceneError(f"scene '{scene.name}': {says}: {best_of}; {mend}")
    length = best.attempt.length
    says = f"{best.attempt.step} at {in_time(length)} keeps below {error:g} over {until:g} s"
    alone = choice(found, STEP, F64.name, error)
    tried = [alone.attempt] if alone else of_step(found, STEP, F64.name)
    replay = min(tried, key=lambda a: a.worst).length
    return Recommended(best.attempt.step, length, replay, f"{says} from the hardest states found")


def usable(library: Library) -> tuple[str, ...]:
    """Return the steps that a scene wants and that move members in vectors, by state alone."""
    states = {q.name for q in library.vocabulary.states}
    given = {q.name for q in library.vocabulary.given()} | states | {"time_step"}

    def fits(name: str) -> bool:
        program = library[name]
        inputs = {q.name for q in program.inputs if q.role != "constants"}
        return is_in_vectors(program) and inputs <= given and "time_step" in inputs

    return tuple(name for name in library.scene.wanted if name in STEPS and fits(name))
