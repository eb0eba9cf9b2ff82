"""What a machine's quantities are called: arguments, answers, and the data that nobody knows."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from sympy import Expr, Integer, Matrix, Symbol, cos, expand_trig, sin, tan

from derive.lecture.stated import by_law
from derive.mechanics.sheet import Sheet
from derive.mechanics.vocabulary import Vocabulary, require_floats
from derive.program.program import Quantity, Role
from derive.scene import Input, Scene
from derive.scene.formula import Formula
from derive.scene.machine import Group


@dataclass(frozen=True)
class Words:
    """The vocabulary of a machine, its working sheet, and the data left out by the user.

    spoken : the vocabulary in which an input may be an answer of another function as well
    trials : values that were drawn already, by the number of their trial point
    held   : the conditions of its constraints, once they were looked at
    """

    vocabulary: Vocabulary
    spoken: Vocabulary
    sheet: Sheet
    hidden: Mapping[Symbol, str]
    trials: dict[int, Mapping[Symbol, Any]] = field(default_factory=dict)
    held: list[Any] = field(default_factory=list)

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
        Quantity(p.name, (p.name,), (), p.unit, "", p.low, p.high, p.meaning)
        for p in machine.parameters
        if p.value is None
    )
    numbers = {p.name: p.value for p in machine.parameters if p.value is not None}
    groups = machine.groups
    states, inputs, outputs = (
        tuple(map(_quantity, each)) for each in (groups.states, groups.inputs, groups.outputs)
    )
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
    require_floats(every_role.given())
    book = replace(every_role, inputs=given, outputs=(*outputs, *sought))
    sheet = Sheet(symbols, {}, frozenset(), {})
    rateless = {sheet.symbol(m.name): f"the rate of input '{m.name}' is not known"
                for m in machine.inputs}  # fmt: skip
    sheet = replace(sheet, unknowns=frozenset(map(sheet.symbol, sorted(unknowns))),
                    rateless=rateless)  # fmt: skip
    made = Words(book, every_role, sheet, {})
    sheet.rates |= _rates(machine, made)
    return replace(made, hidden=_hidden(machine, sheet))


def _quantity(g: Group) -> Quantity:
    shape = () if g.components == (g.name,) else (len(g.components),)
    role: Role = "attitude" if g.quaternion else "value"
    return Quantity(g.name, g.components, shape, g.unit, g.frame, g.low, g.high, g.meaning, role)


def _rates(machine: Scene, made: Words) -> dict[Symbol, Expr]:
    """Return the rate of coordinates, of their rates with a name, of speeds and of attitudes."""
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
    for frame in machine.frames:
        if frame.attitude and frame.angular_velocity is not None:
            w, *v = made.vocabulary.column(frame.attitude)
            omega = made.column(frame.angular_velocity)
            known = {"q_w": w, "q_v": Matrix(v), "omega": omega}
            found[w] = by_law("quaternion_rate_scalar", known)
            found |= zip(v, by_law("quaternion_rate_vector", known), strict=True)
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
