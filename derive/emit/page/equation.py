"""The equations of one scene for its page: the lecture's, with its own quantities in place."""

from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass

from sympy import Expr, Symbol

from derive.emit.notation import equation_mathml, sympy_equation_mathml
from derive.emit.notation.glyph import Glyph, glyph
from derive.emit.page.readable import LONGEST, Determined, Readable, readable
from derive.emit.page.tidied import neatened
from derive.lecture.chapters import LECTURE
from derive.lecture.step import Step
from derive.mechanics.mechanism import Mechanism
from derive.mechanics.problem import Problem

NEAT = 100
"""Lines of a function that are written as by hand: those of more are shown as they were derived."""
# Letters of the lecture for the quantities that every scene calls by a word.
_LETTERS = {
    "moment": ("M",), "force": ("F",), "attitude": ("q",), "position": ("p",), "velocity": ("v",),
    "point_acceleration": ("a_A", "moving_point_a"), "kinetic_energy": ("T", "E"),
    "angular_momentum": ("l", "L"), "rate_in_axes": ("l_dot", "L_dot"),
    "rate_absolute": ("l_N_dot", "L_N_dot"), "attitude_rate": ("q_dot",),
    "position_rate": ("p_dot",), "velocity_rate": ("v_dot",),
}  # fmt: skip


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


def is_short(value: Expr) -> bool:
    """Tell whether a value is short enough for an equation that is shown whole."""
    return bool(value.count_ops() <= LONGEST)


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
    names = _apart(names)
    chosen = {r.name for r in mechanism.scene.results} | {name.replace("_dot", "_rate")
                                                          for name in taken}  # fmt: skip
    states = {c for q in mechanism.vocabulary.states for c in q.components}
    for q in mechanism.vocabulary.states:  # the rate of what is written q_w is written q_w_dot
        rates = ((c, f"{c}_rate") for c in q.components
                 if f"{c}_rate" in symbols and f"{c}_rate" not in chosen)  # fmt: skip
        names |= {symbols[rate]: _dotted(names[symbols[c]]) for c, rate in rates}
        unknown = ((c, _acceleration(c)) for c in q.components)
        names |= {symbols[a]: _dotted(names[symbols[c]]) for c, a in unknown
                  if a in symbols and a not in states}  # fmt: skip
    return names


def _apart(names: Mapping[Symbol, str]) -> dict[Symbol, str]:
    """Return names of which no two look alike: omega_roller_x is words beside roller_omega_x."""
    seen: dict[Glyph, str] = {}
    return {
        symbol: name if seen.setdefault(glyph(name), name) == name else name.replace("_", " ")
        for symbol, name in names.items()
    }


def _acceleration(speed: str) -> str:
    """Return the name by which balances know the rate of a speed, as w_x_dot, q_1_ddot."""
    return f"{speed.removesuffix('_dot')}_d{'d' * speed.endswith('_dot')}ot"


def _dotted(name: str) -> str:
    first, *rest = name.split("_")
    return "_".join([first, "dot", *rest])


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


def for_readers(mechanism: Mechanism, base: str) -> Problem:
    """Return a function's problem without what cancels, if a reader is spared more than letters.

    A parameter that cancels stays beside others: as a number it would say less.
    """
    lean = mechanism.lean(base)
    kept = set(lean.cancelled) <= mechanism.posed(base).vocabulary.fixed()
    return mechanism.whole(base) if kept else lean.problem


def written_equations(mechanism: Mechanism, base: str) -> Readable:
    """Return the equations of a function as a reader wants them, made once."""
    return mechanism.told_once("written", base, lambda: _written_equations(mechanism, base))


def _written_equations(mechanism: Mechanism, base: str) -> Readable:
    own, told = mechanism.posed(base).vocabulary, for_readers(mechanism, base)
    loads = (c for q in own.inputs if q.unit in ("N", "N m") for c in q.components)
    given = frozenset(own.symbols[c] for c in loads)
    each = (told.definitions, told.rows, told.answers, told.unknowns, told.steps)
    return readable(*each, given)


def notes(mechanism: Mechanism, base: str) -> list[str]:
    """Return which balances a function uses, and what was found not to matter to it, and why."""
    parts, balances = mechanism.dropped(base), mechanism.whole(base).balances
    whole = for_readers(mechanism, base) is mechanism.whole(base)
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
    own, written = mechanism.posed(base), written_equations(mechanism, base)
    names = written_names(own)
    names |= {u: names[s] for u, s in written.found.items()}
    lines = [line for _, each in written.groups for line in each]
    tidy = neatened if len(lines) <= NEAT else _as_it_stands
    groups = [(steps, each) for steps, each in written.groups if each]
    return tuple(_passage(own, base, steps, each, names, tidy) for steps, each in groups)


def _as_it_stands(value: Expr) -> Expr:
    return value


def _passage(
    mechanism: Mechanism, base: str, steps: tuple[str, ...], equations: Iterable[Determined],
    names: Mapping[Symbol, str], tidy: Callable[[Expr], Expr],
) -> Passage:  # fmt: skip
    label = mechanism.words.sheet.label
    lines = tuple(
        PageEquation(
            f"{base}.{label(s)}".replace(" ", "_"),
            label(s),
            sympy_equation_mathml(tidy(left), tidy(right), names),
        )
        for s, left, right in equations
    )
    own = tuple(LECTURE[step] for step in steps)
    return Passage(own, tuple(map(equation_mathml, own)), lines)
