"""A machine on its page: what it is made of, which balances were chosen, what did not matter."""

from collections.abc import Sequence

from sympy import Expr, Symbol

from derive.emit.notation import equation_mathml, sympy_equation_mathml
from derive.emit.page.equation import written_names
from derive.emit.page.passage import Line, Passage
from derive.lecture.chapters import LECTURE
from derive.library.library import Library
from derive.mechanics.answers import FRAME_STEPS, balance_steps
from derive.mechanics.mechanism import Mechanism, dropped
from derive.mechanics.problem import Problem
from derive.scene import Machine
from derive.scene.formula import ZERO, Formula
from derive.scene.machine import INERTIAL, Force, Frame, Gradient, Load, Member, Spring


def given(machine: Machine) -> list[str]:
    """Return what a machine is made of, one sentence each."""
    found = [_frame(f) for f in machine.frames if f.name != INERTIAL]
    found += [_body(b) for b in machine.bodies]
    return [*found, *(_load(load) for load in machine.loads), f"Source: {machine.source}."]


def _column(formulas: Sequence[Formula]) -> str:
    return f"({', '.join(map(str, formulas))})"


def _frame(frame: Frame) -> str:
    start = f"Frame {frame.name} is carried by {frame.parent}"
    if frame.angular_velocity is not None:
        start += f" and turns in it with {_column(frame.angular_velocity)} along its own axes"
    if frame.turned:
        turns = ", then ".join(f"about {t.axis} by {t.angle}" for t in frame.turned)
        start += f" and turned from it {turns}"
    if any(f != ZERO for f in frame.origin):
        start += f"; its origin lies at {_column(frame.origin)}"
    if frame.rolls is not None:
        start += (
            f"; it moves so that {frame.rolls.body} rolls on its point {_column(frame.rolls.at)}"
        )
    for name, value in (("velocity", frame.velocity), ("acceleration", frame.acceleration)):
        if value is not None:
            start += f"; its origin has the {name} {_column(value)}"
    return start + "."


def _body(body: Member) -> str:
    says = f"Body {body.name}{f', a {body.look},' if body.look else ''} is carried by {body.frame}"
    if any(f != ZERO for f in body.centre):
        says += f", its mass centre at {_column(body.centre)}"
    if body.spin is not None:
        says += f", and spins about its {body.axis} axis at {body.spin} relative to it"
    if body.axial_speed is not None:
        says += f", and has the angular velocity {body.axial_speed} along its {body.axis} axis"
    return says + "."


def _load(load: Load) -> str:
    if isinstance(load, Force):
        parts = [f"the {kind} {_column(value)}" for kind, value in
                 (("force", load.force), ("couple", load.couple))
                 if any(f != ZERO for f in value)]  # fmt: skip
        against = f", and the opposite on {load.against}" if load.against else ""
        where = f" at {_column(load.at)} of {load.frame}"
        says = f"{' and '.join(parts)} along {load.along}{where}"
        return f"Load {load.name}: {says}, on {load.on}{against}."
    if isinstance(load, Spring):
        return (
            f"Load {load.name}: a spring {load.stiffness} with damper {load.damping} on {load.on}."
        )
    if isinstance(load, Gradient):
        return f"Load {load.name}: the gravity gradient {load.strength} on {', '.join(load.on)}."
    where = f"along {load.along}, on {', '.join(load.on)}"
    return f"Load {load.name}: gravity {_column(load.gravity)} {where}."


def notes(known: Mechanism, base: str) -> list[str]:
    """Return which balances a function uses, and what was found not to matter to it, and why."""
    found, parts = [], dropped(known, base)
    balances = known.question(base).balances
    if balances:
        found.append(f"Balances: {'; '.join(map(str, balances))}.")
    if parts["unknowns left out"] and balances:
        found.append(
            f"Chosen so that these unknowns do not enter: {', '.join(parts['unknowns left out'])}."
        )
    if parts["cancels"]:
        found.append("Stands in the equations, but no answer changes with it: "
                     f"{', '.join(parts['cancels'])}.")  # fmt: skip
    if parts["never enters"]:
        found.append(f"Stands in none of these equations: {', '.join(parts['never enters'])}.")
    return found


def passages(library: Library, fact: Problem) -> tuple[Passage, ...]:
    """Return the equations of a function: named quantities, balances, answers."""
    known = library.known.posed(fact.name)
    question, names = known.question(fact.name), all_names(known) | written_names(library)
    motion = [(s, s, value) for s, value in question.definitions.items()]
    rows = [(u, row - row, row) for u, row in zip(question.unknowns, question.rows, strict=True)]
    answers = [(s, s, value) for s, value in question.answers.items() if s != value]
    of_rows = balance_steps(question.balances) if rows else ()
    of_motion = FRAME_STEPS if motion else ()
    others = tuple(s for s in dict.fromkeys(question.steps) if s not in (*of_rows, *of_motion))
    groups = ((of_motion, motion), (of_rows, rows), (others, answers))
    return tuple(_passage(known, fact, steps, lines, names) for steps, lines in groups if lines)


def _passage(
    known: Mechanism,
    fact: Problem,
    steps: tuple[str, ...],
    lines: list[tuple[Symbol, Expr, Expr]],
    names: dict[Symbol, str],
) -> Passage:
    label = known.made.sheet.label
    shown = tuple(
        Line(f"{fact.name}.{label(s)}", label(s), sympy_equation_mathml(left, right, names))
        for s, left, right in lines
    )
    general = tuple(equation_mathml(LECTURE[step]) for step in steps)
    return Passage(tuple(LECTURE[step] for step in steps), general, shown)


def all_names(known: Mechanism) -> dict[Symbol, str]:
    """Return how the page writes each symbol: named quantities by frame or body, and axis."""
    return {symbol: _written(name) for name, symbol in known.made.sheet.symbols.items()}


def _written(label: str) -> str:
    """Return a label as a name: a letter, whose frame or body it belongs to is an index.

    >>> _written("stem.Omega.x.dot.by.alpha_ddot"), _written("balance#2")
    ('Omega_dot_stem_x_by_alpha_ddot', 'balance_2')
    """
    owner, *rest = label.replace("#", "_").split(".")
    if not rest:
        return owner
    about = rest[:1] if rest[0] == "about" else []
    letter, *indices = rest[len(about) :]
    dots = [part for part in indices if part == "dot"]
    return "_".join([letter, *dots, *about, owner, *(part for part in indices if part != "dot")])
