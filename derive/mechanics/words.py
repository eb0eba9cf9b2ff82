"""What a machine's quantities are called: arguments, answers, and the data that nobody knows."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from sympy import Expr, Integer, Matrix, Symbol, cos, expand_trig, sin, tan

from derive.mechanics.sheet import Sheet
from derive.mechanics.vocabulary import ANY, Vocabulary
from derive.program.program import Quantity
from derive.scene import Input, Scene
from derive.scene.declaration import AXES, Moving
from derive.scene.formula import Formula
from derive.scene.machine import Group
from derive.scene.results import ENERGIES, groups
from derive.scene.scalars import PER_SECOND

QUATERNION = ("w", "x", "y", "z")
MATRICES = {
    "mass_matrix": "acceleration",
    "damping_matrix": "velocity, gyroscopic terms included",
    "stiffness_matrix": "displacement",
}


@dataclass(frozen=True)
class Words:
    """The vocabulary of a machine, its working sheet, and the data left out by the user.

    spoken : the vocabulary in which an input may be an answer of another function as well
    """

    vocabulary: Vocabulary
    spoken: Vocabulary
    sheet: Sheet
    hidden: Mapping[Symbol, str]

    def expression(self, formula: Formula) -> Expr:
        """Return a formula in the symbols of the scene, sines and cosines of sums written out.

        Only so are sin(2 x) and sin(x) known to belong together when programs are proved.
        """
        written = self.vocabulary.expression(formula)
        return expand_trig(written) if written.has(sin, cos, tan) else written

    def column(self, formulas: tuple[Formula, Formula, Formula]) -> Matrix:
        """Return three formulas as a column."""
        return Matrix([self.expression(f) for f in formulas])

    def data(self, formula: Formula | None, name: str) -> Expr:
        """Return a datum of a body, or a symbol for what the user left out."""
        return self.sheet.symbol(name) if formula is None else self.expression(formula)


def words(machine: Scene) -> Words:
    """Return what ``machine`` speaks of; symbols are named by place, never by the user's words."""
    parameters = tuple(
        _scalar(p.name, p.unit, p.low, p.high, p.meaning)
        for p in machine.parameters
        if p.value is None
    )
    numbers = {p.name: p.value for p in machine.parameters if p.value is not None}
    states, inputs, outputs = _grouped(machine)
    every = (*parameters, *states, *inputs, *outputs)
    names = dict.fromkeys(c for q in every for c in q.components)
    above = {c for q in every for c in q.components if q.low is not None and q.low > 0}
    symbols = {
        name: Symbol(f"s{place:04d}", positive=True) if name in above else Symbol(f"s{place:04d}")
        for place, name in enumerate(names)
    }
    unknowns = {u.name for u in machine.unknowns} | {m.unknown for m in machine.moving if m.free}
    given = tuple(q for q in inputs if not unknowns & set(q.components))
    sought = tuple(q for q in inputs if q not in given)
    every_role = Vocabulary(parameters, states, inputs, outputs, numbers, symbols)
    book = replace(every_role, inputs=given, outputs=(*outputs, *sought))
    sheet = Sheet(symbols, {}, frozenset(), {})
    rateless = {sheet.symbol(m.name): f"the rate of input '{m.name}' is not known"
                for m in machine.inputs}  # fmt: skip
    sheet = replace(sheet, unknowns=frozenset(map(sheet.symbol, sorted(unknowns))),
                    rateless=rateless)  # fmt: skip
    made = Words(book, every_role, sheet, {})
    sheet.rates |= _rates(machine, made)
    return replace(made, hidden=_hidden(machine, sheet))


def _scalar(
    name: str, unit: str, low: Fraction | None, high: Fraction | None, says: str
) -> Quantity:
    return Quantity(name, (name,), (), unit, "", low, high, says)


def _of(entry: Input | Moving) -> Quantity:
    return _scalar(entry.name, entry.unit, entry.low, entry.high, entry.meaning)


Quantities = tuple[Quantity, ...]


def _grouped(machine: Scene) -> tuple[Quantities, Quantities, Quantities]:
    """Return states, inputs and outputs: as the scene groups them, or a scalar each."""
    if machine.groups is None:
        return tuple(_states(machine)), tuple(_inputs(machine)), tuple(_outputs(machine))
    states, inputs, outputs = (
        tuple(map(_of_group, each))
        for each in (machine.groups.states, machine.groups.inputs, machine.groups.outputs)
    )
    return states, inputs, outputs


def _of_group(g: Group) -> Quantity:
    shape = () if g.components == (g.name,) else (len(g.components),)
    return Quantity(g.name, g.components, shape, g.unit, g.frame, g.low, g.high, g.meaning)


def rate_names(machine: Scene) -> tuple[str, ...]:
    """Return the outputs that answer with the rates of all states, in their order."""
    if machine.groups is not None:
        return machine.groups.rates
    return tuple(f"{q.name}_rate" for q in _states(machine))


def rate_of_each(machine: Scene) -> dict[str, str]:
    """Return what answers with the rate of each component of the state."""
    states, inputs, outputs = _grouped(machine)
    named = {q.name: q.components for q in (*inputs, *outputs)}
    rates = [c for name in rate_names(machine) for c in named[name]]
    return dict(zip((c for q in states for c in q.components), rates, strict=True))


def _states(machine: Scene) -> Iterator[Quantity]:
    yield from _with_rates(m for m in (*machine.coordinates, *machine.speeds) if m.state)
    for frame in machine.frames:
        if name := frame.attitude:
            parts = tuple(f"{name}_{p}" for p in QUATERNION)
            says = f"quaternion of {frame.name}, scalar first, to {frame.parent}, of norm 1"
            yield Quantity(name, parts, (4,), "1", "", *ANY, says)


def _inputs(machine: Scene) -> Iterator[Quantity]:
    yield from _with_rates(m for m in machine.moving if not m.state)


def _with_rates(moving: Iterable[Moving]) -> Iterator[Quantity]:
    """Yield what moves, each with its rates that are inputs or states; components as one vector."""
    found: dict[str, list[Quantity]] = {}
    for m in moving:
        found.setdefault(m.vector or m.name, []).append(_of(m))
        for rate in m.given:
            found.setdefault(m.of_vector(rate.name), []).append(_of(rate))
    for name, parts in found.items():
        yield _joined(name, parts)


def _joined(name: str, parts: Sequence[Quantity]) -> Quantity:
    """Return the vector of some scalars, or the scalar that is alone."""
    if len(parts) == 1:
        return parts[0]
    components = tuple(q.name for q in parts)
    return replace(parts[0], name=name, components=components, shape=(len(parts),))


def _outputs(machine: Scene) -> Iterator[Quantity]:
    for u in machine.unknowns:
        yield _scalar(u.name, u.unit, None, None, u.meaning)
    for group in groups(machine.unknowns):
        first = next(u for u in machine.unknowns if u.name == f"{group}_x")
        parts = tuple(f"{group}_{a}" for a in AXES)
        says = first.meaning.removesuffix(" along x")
        if len({u.unit for u in machine.unknowns if u.name in parts}) > 1:
            first, says = replace(first, unit=""), f"{says}, each in its own unit"
        yield Quantity(group, parts, (3,), first.unit, "", None, None, says)
    vectors: dict[str, list[Quantity]] = {}
    for m in (*machine.coordinates, *machine.speeds):
        if m.free:
            unit = PER_SECOND[m.unit]
            unit = PER_SECOND[unit] if m.kind == "coordinate" else unit
            one = _scalar(m.unknown, unit, None, None, f"acceleration of {m.vector or m.name}")
            yield one
            if m.vector:
                vectors.setdefault(m.answer, []).append(one)
    yield from (_joined(vector, each) for vector, each in vectors.items())
    results = {r.name for r in machine.results}
    rates = [_rate_of(q) for q in _states(machine)]
    yield from (q for q in rates if q.name not in results)
    for name in ENERGIES:
        yield _scalar(name, "J", None, None, name.replace("_", " "))
    says = f"angular momentum along {machine.momentum.frame}"
    parts = tuple(f"angular_momentum_{a}" for a in AXES)
    yield Quantity("angular_momentum", parts, (3,), "kg m^2/s", "", None, None, says)
    for r in machine.results:
        yield _scalar(r.name, r.unit, None, None, r.meaning)
    yield from (q for q in rates if q.name in results)  # by this name the result is meant
    yield from _matrices(machine)
    count = len(machine.steady.unknown) if machine.steady else 1
    parts = tuple(f"steady_{n + 1}" for n in range(count)) if count > 1 else ("steady",)
    unit = machine.steady.unit if machine.steady else ""
    free_of = "" if unit else ", without factors that never vanish, so in no unit"
    says = f"what vanishes in a steady motion{free_of}"
    yield Quantity("steady", parts, (count,) if count > 1 else (), unit, "", None, None, says)


def _rate_of(q: Quantity) -> Quantity:
    """Return the rate of a state."""
    parts = tuple(f"{c}_rate" for c in q.components)
    unit = PER_SECOND.get(q.unit, f"{q.unit}/s").replace("rad/s^2/s", "rad/s^3")
    return Quantity(f"{q.name}_rate", parts, q.shape, unit, "", None, None, f"rate of {q.name}")


def _matrices(machine: Scene) -> Iterator[Quantity]:
    names = [m.name for m in (*machine.coordinates, *machine.speeds) if m.free]
    for name, by in MATRICES.items():
        parts = tuple(f"{name}_{i + 1}_{k + 1}" for k in range(len(names))
                      for i in range(len(names)))  # fmt: skip
        says = f"forces by {by}, column by column, for {', '.join(names)}, each in its own unit"
        yield Quantity(name, parts, (len(parts),), "", "", None, None, says)


def _rates(machine: Scene, made: Words) -> dict[Symbol, Expr]:
    """Return the rate of every coordinate, of its rate where it has a name, and of every speed."""
    symbols, found = made.sheet.symbols, dict[Symbol, Expr]()
    for m in (*machine.coordinates, *machine.speeds):
        first = symbols[m.name]
        if isinstance(m.rate, Input):
            found[first] = symbols[m.rate.name]
            second = m.acceleration
            if m.kind == "coordinate":
                last = symbols[m.unknown] if m.free else _second(made, second)
                found[symbols[m.rate.name]] = last
        elif m.free:
            found[first] = symbols[m.unknown]
        else:
            found[first] = made.expression(m.rate) if m.rate is not None else Integer(0)
    return found


def _second(made: Words, second: Input | Formula | None) -> Expr:
    if isinstance(second, Input):
        return made.sheet.symbols[second.name]
    return Integer(0) if second is None else made.expression(second)


def _hidden(machine: Scene, sheet: Sheet) -> dict[Symbol, str]:
    """Return symbols for data of bodies that the user left out."""
    found: dict[Symbol, str] = {}
    for body in machine.bodies:
        if body.mass is None:
            found[sheet.symbol(mass_name(body.name))] = f"the mass of body '{body.name}'"
        for place, entry in enumerate(body.inertia):
            if entry is None:
                what = f"the inertia of body '{body.name}'"
                if body.axis is not None:
                    kind = "axial" if "xyz"[place] == body.axis else "transverse"
                    what = f"the {kind} moment of inertia of body '{body.name}'"
                found[sheet.symbol(inertia_name(machine, body.name, place))] = what
    return found


def mass_name(body: str) -> str:
    """Return what the unknown mass of a body is called."""
    return f"{body}.mass"


def inertia_name(machine: Scene, body: str, place: int) -> str:
    """Return what an unknown moment is called; the transverse ones of a body are one."""
    axis = machine.body(body).axis
    if axis is not None and place < 3:
        return f"{body}.{'axial' if 'xyz'[place] == axis else 'transverse'}"
    return f"{body}.inertia.{place}"
