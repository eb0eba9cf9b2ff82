"""What each wanted answer is made of: unknowns, energies, momenta, results, small motion."""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from sympy import Expr, Integer, Matrix, Symbol

from derive.lecture.stated import by_law
from derive.mechanics.balance import ValuedBalance
from derive.mechanics.balances import Balances
from derive.mechanics.bodies import (
    centre,
    centre_velocity,
    energy_form,
    kinetic_energy,
    mass,
    momentum,
)
from derive.mechanics.contradiction import unbalanced
from derive.mechanics.frames import ZERO, Frames
from derive.mechanics.held import bindings
from derive.mechanics.linearised import Linearised, linearised, require_nothing_prescribed
from derive.mechanics.linearised_held import held_linearised
from derive.mechanics.loads import potential_energy
from derive.mechanics.matter import without_factors
from derive.mechanics.probe import PROBES, independent
from derive.mechanics.problem import Problem, substituted
from derive.mechanics.regular import Regular
from derive.mechanics.told_by import steps_of
from derive.program.program import Quantity
from derive.scene import Input, Scene, SceneError
from derive.scene.formula import Formula, symbols
from derive.scene.results import DISTANCES, MATRICES, written_out
from derive.scene.wanted import JACOBIAN


@dataclass
class Answers:
    """The answers of a machine, each as an expression in unknowns and named quantities."""

    machine: Scene
    frames: Frames
    balances: Balances

    def problem(self, base: str) -> Problem:
        """Return a wanted function as a problem."""
        asked = self.machine.asked
        names = asked.get(base) or asked.get(base + JACOBIAN) or (base,)
        if names[0] in self.machine.steady:
            self._require_free(base)
            return self._steady(base, names[0])
        parts = {q: e for name in names for q, e in self._answer(name).items()}
        quantities = tuple(parts)
        answers = {
            s: e for q, own in parts.items() for s, e in zip(self._symbols(q), own, strict=True)
        }
        steps = [s for name in names for s in self._steps(name)]
        found = self._asked(base, quantities, answers, steps)
        return replace(found, says=SAYS[base]) if (base,) == names and base in SAYS else found

    def _require_free(self, answer: str) -> None:
        """Refuse what is only known of coordinates that no constraint holds together."""
        if self.machine.constraints:
            rule = "needs coordinates that are free of each other, and a constraint holds"
            raise SceneError(f"'{answer}' {rule}: '{self.machine.constraints[0].name}'")

    @cached_property
    def _regular(self) -> Regular:
        return Regular(self.frames, self.balances)

    def _symbols(self, q: Quantity) -> list[Symbol]:
        return [self.frames.sheet.symbols[c] for c in q.components]

    def _quantity(self, name: str) -> Quantity:
        return self.frames.words.vocabulary[name]

    def _asked(
        self,
        base: str,
        outputs: tuple[Quantity, ...],
        answers: Mapping[Symbol, Expr],
        steps: Sequence[str],
    ) -> Problem:
        sheet = self.frames.sheet
        used = {s for e in (*answers.values(), *sheet.needed(answers.values()).values())
                for s in e.free_symbols}  # fmt: skip
        open_ = used & {s for q in self.frames.words.vocabulary.outputs for s in self._symbols(q)}
        if left := open_ - sheet.unknowns:
            names = [c for c, s in sheet.symbols.items() if s in left]
            raise KeyError(f"'{base}' has no expression for {', '.join(names)}")
        wanted = used & sheet.unknowns
        rows, unknowns = self._regular.determining(wanted)
        written = tuple(self.balances.written(row) for row in rows)
        definitions = sheet.needed([*written, *answers.values()])
        held = tuple(row.balance for row in rows)
        every = (*self._balanced(rows), *steps, *sheet.steps([*written, *answers.values()]))
        says = f"{_listed([q.meaning for q in outputs])}."
        if outputs[0].meaning not in {str(r.formula) for r in self.machine.results}:
            says = says[:1].upper() + says[1:]  # of words; a formula stays as it is
        return Problem(base, says, outputs, answers, definitions, written,
                       unknowns, held, tuple(dict.fromkeys(every)))  # fmt: skip

    def _balanced(self, rows: Iterable[ValuedBalance]) -> tuple[str, ...]:
        """Return the lecture steps that balances are written by."""
        return tuple(
            dict.fromkeys(s for row in rows for s in steps_of(self.balances.sides, row.balance))
        )

    def _steps(self, name: str) -> tuple[str, ...]:
        """Return the lecture steps that an answer follows by, beside balances."""
        result = next((r for r in self.machine.results if r.name == name), None)
        if result is not None:
            every = symbols(written_out(result.formula, self.machine.results))
            own = {r.name for r in self.machine.results}  # of which none stands in `every`
            parts = dict.fromkeys(part for s in every if (part := ANSWER.sub("", s)) not in own)
            return tuple(s for part in parts for s in self._steps(part))
        if name in ("kinetic_energy", "energy"):
            return tuple(energy_form(self.frames, body.name) for body in self.machine.bodies)
        if name == "angular_momentum_rate":
            still = self.frames.Omega[self.machine.momentum.frame] == ZERO
            return ("rate_in_axes",) if still else ("rate_in_axes", "transport_theorem")
        if name == "state_rate":
            turns = any(q.is_quaternion for q in self._states)
            return ("quaternion_rate_scalar", "quaternion_rate_vector") if turns else ()
        if name in ("linearised", *MATRICES):
            small = self._small
            return (*self._balanced(small.rows), *self.frames.sheet.steps(small.written))
        return ("angular_momentum",) if name == "angular_momentum" else ()

    def _answer(self, name: str) -> dict[Quantity, list[Expr]]:
        if name == "state_rate" and not self._states:
            raise SceneError("'state_rate' needs something free, and nothing is")
        if name in ("accelerations", "acceleration"):
            return {q: list(self._symbols(q)) for q in self._accelerations(name)}
        if name == "state_rate":
            return self._state_rate()
        if name == "angular_momentum_rate":
            return self._momentum_rate()
        if name == "linearised":
            return {self._quantity(n): self.matrices[n] for n in MATRICES}
        q = self._quantity(name)
        if name == DISTANCES:
            parts = ((c.place, c.first) for c in bindings(self.frames).every)
            return {q: [e for pair in parts for e in pair if e is not None]}
        if name == "angular_momentum":
            return {q: list(self.angular_momentum)}
        if name in ("kinetic_energy", "potential_energy", "energy"):
            return {q: [self.energy(name)]}
        result = next((r for r in self.machine.results if r.name == name), None)
        if result is not None:
            return {q: [self.expression(result.formula)]}
        return {q: list(self._symbols(q))}

    def _accelerations(self, name: str) -> list[Quantity]:
        """Return what answers with the highest rates of all that is free, or of speeds alone."""
        machine = self.machine
        moving = (
            machine.speeds if name == "acceleration" else (*machine.coordinates, *machine.speeds)
        )
        free = [m.unknown for m in moving if m.free]
        if not free:
            raise SceneError(f"'{name}' needs a free coordinate or speed")
        every = self.frames.words.vocabulary.outputs
        held = ([q for q in every if rate in q.components] for rate in free)
        return [*dict.fromkeys(max(own, key=lambda q: len(q.components)) for own in held)]

    def _state_rate(self) -> dict[Quantity, list[Expr]]:
        """Return the rates of all states, in their order, grouped as the scene groups them."""
        rates = [self.frames.sheet.rate(s) for q in self._states for s in self._symbols(q)]
        found: dict[Quantity, list[Expr]] = {}
        for q in map(self._quantity, self.machine.groups.rates):
            found[q], rates = rates[: len(q.components)], rates[len(q.components) :]
        return found

    def _momentum_rate(self) -> dict[Quantity, list[Expr]]:
        """Return the rate of the angular momentum, seen from its axes and from inertial ones."""
        spin, frame = self.angular_momentum, self.machine.momentum.frame
        own = self.frames.sheet.rate_of_column(spin)
        known = {"l": spin, "l_dot": own, "Omega": self.frames.Omega[frame]}
        each = {"rate_in_axes": own, "rate_absolute": by_law("transport_theorem", known)}
        return {self._quantity(name): list(value) for name, value in each.items()}

    @property
    def _states(self) -> tuple[Quantity, ...]:
        return self.frames.words.vocabulary.states

    def expression(self, formula: Formula) -> Expr:
        """Return a formula of answers, with every result in it written out."""
        whole = self.frames.words.expression(written_out(formula, self.machine.results))
        symbols = self.frames.sheet.symbols
        swaps: dict[Symbol, Expr] = {}
        for name in ("kinetic_energy", "potential_energy", "energy"):
            if symbols[name] in whole.free_symbols:
                swaps[symbols[name]] = self.energy(name)
        for k, axis in enumerate("xyz"):
            own = symbols[f"angular_momentum_{axis}"]
            if own in whole.free_symbols:
                swaps[own] = self.frames.sheet.named(f"l.{axis}", self.angular_momentum[k])
        for name in MATRICES:
            own_ = self._symbols(self._quantity(name))
            if whole.free_symbols & set(own_):
                swaps |= dict(zip(own_, self.matrices[name], strict=True))
        return whole.xreplace(swaps)

    @cached_property
    def matrices(self) -> Mapping[str, list[Expr]]:
        """Return the entries of the matrices of small motion, column by column."""
        return {name: list(self._small.matrices[name].T) for name in MATRICES}

    @cached_property
    def _small(self) -> Linearised:
        if self.machine.constraints:
            return held_linearised(self.machine, self.balances)
        return linearised(self.machine, self.balances)

    def energy(self, name: str) -> Expr:
        """Return an energy of all bodies; what is not asked for may not exist."""
        bodies = self.machine.bodies if name != "potential_energy" else ()
        total = sum((kinetic_energy(self.frames, body.name) for body in bodies), Integer(0))
        return total if name == "kinetic_energy" else total + potential_energy(self.frames)

    @cached_property
    def angular_momentum(self) -> Matrix:
        """Return the angular momentum of bodies about the point that the scene names."""
        frames, place = self.frames, self.machine.momentum
        at = (place.frame, frames.words.column(place.at))
        total = ZERO
        for body in place.of:
            own = frames.own(body)
            spin = frames.carried(momentum(frames, body), own, place.frame)
            v = frames.carried(centre_velocity(frames, body), own, place.frame)
            if v != ZERO:
                arm = frames.apart(at, centre(frames, body), place.frame)
                known = {"M_G": ZERO, "rho_G": arm, "F": mass(frames, body) * v}
                spin = spin + by_law("moment_about_any_point", known)
            total = total + spin
        return total

    def _steady(self, base: str, name: str) -> Problem:
        """Return what vanishes in a steady motion: formulas, or balances without an unknown."""
        steady, q = self.machine.steady[name], self._quantity(name)
        if steady.vanishes:
            values: list[Expr] = [self.expression(f) for f in steady.vanishes]
            return self._asked(base, (q,), dict(zip(self._symbols(q), values, strict=True)), ())
        require_nothing_prescribed(
            self.machine.coordinates, "steady", ", or say what vanishes by steady.vanishes"
        )
        rows = self._at_rest(len(steady.unknown))
        split = self.frames.sheet.split
        written = [split(self.balances.written(row))[0] for row in rows]
        answers = dict(zip(self._symbols(q), written, strict=True))
        held = tuple(row.balance for row in rows)
        found = self._asked(base, (q,), answers, self._balanced(rows))
        found = replace(found, balances=held)
        still = substituted(found, dict.fromkeys(self._velocities, Integer(0)))
        sought = {self.frames.sheet.symbols[name] for name in steady.unknown}
        return without_factors(still, self.frames.words, sought)

    @property
    def _velocities(self) -> list[Symbol]:
        """Return the rates of free coordinates, which are zero while motion is steady."""
        rates = [c.rate for c in self.machine.coordinates if c.free]
        return [self.frames.sheet.symbols[r.name] for r in rates if isinstance(r, Input)]

    def _at_rest(self, count: int) -> list[ValuedBalance]:
        """Return so many independent balances that no reaction enters and that do not vanish."""
        free = [m.unknown for m in (*self.machine.coordinates, *self.machine.speeds) if m.free]
        every, symbols = self.balances.unknowns, self.frames.sheet.symbols
        still = frozenset(every.index(symbols[n]) for n in free if symbols[n] in every)
        found = unbalanced(self.balances, still)
        rows = [row for row in found if row.lasts] or list(found)
        kept = independent(({p: row.values[p][0] for p in range(PROBES)} for row in rows), count)
        if len(kept) < count:
            raise SceneError(
                f"'steady' needs {count} balances that no reaction enters and that do not vanish "
                f"by themselves, found {len(kept)}; say what vanishes instead, "
                "as steady.vanishes = 'theta_ddot'"
            )
        return [rows[k] for k in kept]


SAYS = {
    DISTANCES: "How far a state is from what the constraints ask of places and of rates.",
    "linearised": "Mass, damping and stiffness matrices of small motion.",
    "acceleration": "Rate of the angular velocity from the moment (forward dynamics).",
    "state_rate": "Rate of the state from the state and the inputs (forward dynamics).",
    "moment": "External moment that the motion needs (inverse dynamics).",
    "angular_momentum": "Angular momentum from the angular velocity.",
    "angular_momentum_rate": "Rate of the angular momentum, seen from the axes and from the "
    "inertial frame.",
}
ANSWER = re.compile("(_[xyz]|(_[0-9]+){2})$")
"""How the name of a component of an answer ends."""


def _listed(parts: list[str]) -> str:
    *first, last = [part or "result" for part in parts]
    return f"{', '.join(first)} and {last}" if first else last
