"""The equations of one scene for its page: the lecture's, with the scene's own quantities in place.

Every line is arranged so that what it determines stands on the left. What the equations name in
between is put in where it is short; elsewhere it has a line of its own.
"""

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass

from sympy import Add, Expr, Symbol, cos, sin

from derive.emit.notation import equation_mathml, sympy_equation_mathml
from derive.emit.notation.glyph import glyph
from derive.lecture.chapters import LECTURE
from derive.lecture.step import Step
from derive.lecture.turning import reduced
from derive.lower.arrange.matching import matched
from derive.mechanics.mechanism import Mechanism
from derive.mechanics.problem import Problem

OF_BALANCES = ("mass_centre_motion", "general_form", "moving_point_form", "any_point_form")
OF_MOTION = (
    *("angular_velocities_add", "velocity_of_particle", "velocity_seen_from_axes"),
    *("acceleration_seen_from_axes", "transport_theorem"),
)
"""Steps by which balances stand, and what they name in between."""
LONGEST, SHORT = 45, 12
"""Operations of an equation that is shown whole, and of a part put into one that is longer."""
# Letters of the lecture for the quantities that every scene calls by a word.
_LETTERS = {
    "moment": ("M",), "force": ("F",), "attitude": ("q",), "position": ("p",), "velocity": ("v",),
    "point_acceleration": ("a_A", "moving_point_a"), "kinetic_energy": ("T", "E"),
    "angular_momentum": ("l", "L"), "rate_in_axes": ("l_dot", "L_dot"),
    "rate_absolute": ("l_N_dot", "L_N_dot"), "attitude_rate": ("q_dot",),
    "position_rate": ("p_dot",), "velocity_rate": ("v_dot",),
}  # fmt: skip

Determined = tuple[Symbol, Expr, Expr]  # what it determines, left side, right side


@dataclass(frozen=True)
class PageEquation:
    """One equation of the scene, what it determines, and the place to link to."""

    place: str
    unknown: str
    mathml: str


@dataclass(frozen=True)
class Passage:
    """Lines of a scene that come from the same lecture steps."""

    steps: tuple[Step, ...]
    general: tuple[str, ...]
    lines: tuple[PageEquation, ...]


def letter(quantity: str, taken: frozenset[str]) -> str:
    """Return the letter for a quantity on a page: the lecture's, unless the user took it."""
    free = (a for a in _LETTERS.get(quantity, ()) if a.split("_")[0] not in taken)
    return next(free, quantity)


def taken_names(mechanism: Mechanism) -> frozenset[str]:
    """Return the names that the user chose."""
    return frozenset(c for q in mechanism.vocabulary.given() for c in q.components)


def written_names(mechanism: Mechanism) -> dict[Symbol, str]:
    """Return how the page writes each symbol; what has no name of the scene's by what it is of."""
    symbols, taken = mechanism.words.sheet.symbols, taken_names(mechanism)
    marks = mechanism.scene.marks
    names = {symbol: _written(_marked(name, marks)) for name, symbol in symbols.items()}
    alone = sum(q.is_quaternion for q in mechanism.vocabulary.states) == 1
    for q in mechanism.vocabulary.every():
        attitude = q.is_quaternion and q in mechanism.vocabulary.states
        start = q.name if alone or not attitude else "attitude"
        new = letter("attitude" if attitude else q.name, taken)
        own = (c for c in q.components if new != q.name and c.startswith(start))
        names |= {symbols[c]: new + c.removeprefix(start) for c in own}
    results = {r.name for r in mechanism.scene.results}
    for q in mechanism.vocabulary.states:  # the rate of what is written q_w is written q_w_dot
        rates = ((c, f"{c}_rate") for c in q.components
                 if f"{c}_rate" in symbols and f"{c}_rate" not in results)  # fmt: skip
        names |= {symbols[rate]: _dotted(names[symbols[c]]) for c, rate in rates}
    return names


def _dotted(name: str) -> str:
    base = glyph(name).base
    return f"{base}_dot{name.removeprefix(base)}"


def _marked(label: str, marks: Mapping[str, str]) -> str:
    """Return a label with marks instead of owners that the user gave no names.

    >>> _marked("body.axes.Omega.x", {"body.axes": "B"}), _marked("xyz.Omega.x", {"xyz": ""})
    ('B.Omega.x', '.Omega.x')
    """
    found = f".{label}"
    for name, mark in marks.items():
        found = found.replace(f".{name}.", f".{mark}.")
    return found[1:]


def _written(label: str) -> str:
    """Return a label as a name: a letter, whose frame or body it belongs to is an index.

    >>> _written("stem.Omega.x.dot.by.alpha_ddot"), _written("balance#2")
    ('Omega_dot_stem_x_by_alpha_ddot', 'balance_2')
    >>> _written("disc.axes.Omega.x"), _written("balance.by.omega_x_dot")
    ('Omega_disc_axes_x', 'balance_by_omega_x_dot')
    """
    name, *by = label.replace("#", "_").split(".by.")
    owner, *rest = name.split(".")
    at = next((k for k, part in enumerate(rest) if part not in ("about", "axes")), None)
    if at is not None:
        dots = [part for part in rest[at + 1 :] if part == "dot"]
        after = [part for part in rest[at + 1 :] if part != "dot"]
        owner = "_".join(filter(None, [rest[at], *dots, owner, *rest[:at], *after]))
    return "_by_".join([owner, *by])


def _shown(mechanism: Mechanism, base: str) -> Problem:
    """Return a function's problem without what cancels, if a reader is spared more than letters.

    A parameter that cancels stays beside others: as a number it would say less.
    """
    lean = mechanism.lean(base)
    kept = set(lean.cancelled) <= mechanism.posed(base).vocabulary.fixed()
    return mechanism.whole(base) if kept else lean.problem


def notes(mechanism: Mechanism, base: str) -> list[str]:
    """Return which balances a function uses, and what was found not to matter to it, and why."""
    parts, balances = mechanism.dropped(base), mechanism.whole(base).balances
    whole = _shown(mechanism, base) is mechanism.whole(base)
    place = "Stands in the equations, but" if whole else "Left out of the equations, since"
    each = (
        ("Balances", (b.told(mechanism.scene.spoken) for b in balances), "; "),
        ("Chosen so that these unknowns do not enter",
         parts["unknowns left out"] if balances else (), ", "),
        (f"{place} no answer changes with it", _vectors(mechanism, parts["cancels"]), ", "),
        ("Stands in none of these equations", _vectors(mechanism, parts["never enters"]), ", "),
    )  # fmt: skip
    texts = ((says, between.join(names)) for says, names, between in each)
    return [f"{says}: {text}." for says, text in texts if text]


def _vectors(mechanism: Mechanism, names: Collection[str]) -> list[str]:
    """Return names with each vector by its own where all of its components stand among them."""
    vocabulary = mechanism.vocabulary
    whole = {
        c: q.name
        for q in (*vocabulary.states, *vocabulary.inputs)
        if q.components[0].startswith(q.name) and {*q.components} <= {*names}
        for c in q.components
    }
    return [*dict.fromkeys(whole.get(name, name) for name in names)]


def passages(mechanism: Mechanism, base: str) -> tuple[Passage, ...]:
    """Return the equations of a function: named quantities, balances, answers."""
    mechanism = mechanism.posed(base)
    problem = _shown(mechanism, base)
    named, rows, answers = _put_together(problem)
    motion: list[Determined] = [(s, s, value) for s, value in named.items()]
    found = {value: s for s, value in reversed(answers.items()) if value in problem.unknowns}
    each = _balanced(problem, rows, _loads(mechanism))
    balanced = [(found.get(u, u), *sides) for u, *sides in each]
    given = [(s, s, value) for s, value in answers.items() if s not in found.values()]
    every = problem.steps
    of_motion = tuple(s for s in every if s in OF_MOTION) if motion else ()
    of_rows = tuple(s for s in every if s in (*OF_BALANCES, *OF_MOTION)) if rows else ()
    of_rows = tuple(s for s in of_rows if s not in of_motion)
    others = tuple(s for s in every if s not in (*of_motion, *of_rows))
    groups = ((of_motion, motion), (of_rows, balanced), (others, given))
    names = written_names(mechanism)
    names |= {u: names[s] for u, s in found.items()}
    return tuple(_passage(mechanism, base, steps, own, names) for steps, own in groups if own)


def _put_together(
    problem: Problem,
) -> tuple[dict[Symbol, Expr], list[Expr], dict[Symbol, Expr]]:
    """Return the named quantities that keep a line, rows, and answers, with all else put in."""
    whole: dict[Expr, Expr] = {}
    short: dict[Expr, Expr] = {}
    named: dict[Symbol, Expr] = {}
    for symbol, value in problem.definitions.items():
        full, part = _plainer(value.xreplace(short | whole)), _plainer(value.xreplace(short))
        if full.count_ops() <= LONGEST:
            whole[symbol] = full
        if part.count_ops() <= SHORT:
            short[symbol] = part
        else:
            named[symbol] = part

    def shown(value: Expr) -> Expr:
        """Return a value as its line shows it; no line says only that it equals another."""
        terms = Add.make_args(value)
        if len(terms) <= 2:
            value = value.xreplace({s: n for s, n in named.items() if s in terms or -s in terms})
        full = _plainer(value.xreplace(short | whole))
        return full if full.count_ops() <= LONGEST else value.xreplace(short)

    rows = [shown(row) for row in problem.rows]
    answers = {s: shown(value) for s, value in problem.answers.items()}
    return _read(named, [*rows, *answers.values()]), rows, answers


def _read(named: dict[Symbol, Expr], ends: Iterable[Expr]) -> dict[Symbol, Expr]:
    """Return the named quantities that other lines speak of, in their order."""
    read = {s for e in ends for s in e.free_symbols}
    kept: dict[Symbol, Expr] = {}
    for symbol, value in reversed(named.items()):
        if symbol in read:
            kept[symbol] = value
            read |= value.free_symbols
    return dict(reversed(kept.items()))


def _plainer(value: Expr) -> Expr:
    """Return a value as it is, or multiplied out with sin^2 = 1 - cos^2 if that is shorter."""
    if not value.has(sin, cos) or value.count_ops() > 4 * LONGEST:
        return value
    return min(value, reduced(value), key=lambda e: e.count_ops())


def _loads(mechanism: Mechanism) -> frozenset[Symbol]:
    """Return the forces and moments that are given."""
    given = (q for q in mechanism.vocabulary.inputs if q.unit in ("N", "N m"))
    return frozenset(mechanism.vocabulary.symbols[c] for q in given for c in q.components)


def _balanced(problem: Problem, rows: list[Expr], loads: frozenset[Symbol]) -> Iterator[Determined]:
    """Yield each unknown with the row that determines it."""
    unknowns = problem.unknowns
    holds = [frozenset(k for k, u in enumerate(unknowns) if u in r.free_symbols) for r in rows]
    straight = all(k in own for k, own in enumerate(holds))
    places = {k: k for k in range(len(rows))} if straight else matched(holds)
    for k, place in sorted(places.items()):
        yield (unknowns[k], *arranged(rows[place], unknowns[k], unknowns, loads))


def arranged(
    row: Expr, unknown: Symbol, unknowns: Iterable[Symbol], loads: frozenset[Symbol]
) -> tuple[Expr, Expr]:
    """Return left and right of ``row = 0``.

    On the left stands the unknown itself if it is determined outright, else the load that the line
    balances, else every term that holds an unknown.
    """
    terms, held = Add.make_args(row), row.free_symbols & set(unknowns)
    for symbol in [unknown] * (held == {unknown}) + sorted(loads & row.free_symbols, key=str):
        for sign in (1, -1):
            if sign * symbol in terms:
                return symbol, -sign * (row - sign * symbol)
    left = Add(*(term for term in terms if term.free_symbols & held))
    return left, left - row


def _passage(
    mechanism: Mechanism, base: str, steps: tuple[str, ...], equations: list[Determined],
    names: dict[Symbol, str],
) -> Passage:  # fmt: skip
    label = mechanism.words.sheet.label
    lines = tuple(
        PageEquation(
            f"{base}.{label(s)}".replace(" ", "_"),
            label(s),
            sympy_equation_mathml(left, right, names),
        )
        for s, left, right in equations
    )
    own = tuple(LECTURE[step] for step in steps)
    return Passage(own, tuple(map(equation_mathml, own)), lines)
