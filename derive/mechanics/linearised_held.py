"""Small motion of a machine with constraints, in the coordinates and speeds that do not follow.

Virtual powers are expanded about the given motion, forces of the constraints included; then what
enforces the constraints is eliminated, and what follows by them is put in, places by places and
rates by rates.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from sympy import Expr, Integer, Matrix, Symbol, eye, zeros

from derive.mechanics.balances import Balances
from derive.mechanics.constraints import Tie
from derive.mechanics.linearised import Expansion, Linearised, Small, require_nothing_prescribed
from derive.mechanics.probe import NOTHING, PROBES, Probe, random_probe, vanishes
from derive.scene import Input, Scene, SceneError
from derive.scene.declaration import Moving

NOT_HELD = Small(Integer(0), {})


def held_linearised(machine: Scene, balances: Balances) -> Linearised:
    """Return the three matrices of the coordinates and speeds that no constraint makes follow.

    Raises SceneError where the scene does not say what follows, or that does not.
    """
    return _Held(machine, balances).matrices()


@dataclass
class _Held:
    """A machine, its equations expanded about its given motion, and what follows in it.

    free : all that moves, those that follow last
    """

    machine: Scene
    balances: Balances
    free: list[Moving] = field(default_factory=list)

    def __post_init__(self) -> None:
        """Expand virtual powers and constraints."""
        every = [m for m in (*self.machine.coordinates, *self.machine.speeds) if m.free]
        self.free = [m for follows in (False, True) for m in every if m.dependent is follows]
        self.ties = self.balances.held
        self.count = len([m for m in every if not m.dependent])
        following = len(every) - self.count
        if following != len(self.ties):
            rule = f"needs to know what follows by the constraints, {len(self.ties)} in all"
            found = ", ".join(f"'{m.name}'" for m in every if m.dependent) or "none"
            raise SceneError(f"'linearised' {rule}: name as many by dependent, not {found}")
        require_nothing_prescribed(self.machine.coordinates, "linearised")
        sheet, words = self.balances.frames.sheet, self.balances.frames.words
        base = {sheet.symbols[n]: words.expression(f) for n, f in self.machine.about.items()}
        self.velocities = [
            sheet.symbols[m.rate.name if isinstance(m.rate, Input) else m.name] for m in self.free
        ]
        self.places = [sheet.symbols[m.name] if m.kind == "coordinate" else None for m in self.free]
        self.about = Expansion(base, [*self.velocities, *(p for p in self.places if p is not None)])
        own = {row.balance.spot: row for row in self.balances.enforced
               if row.balance.kind == "virtual power"}  # fmt: skip
        if lost := [m.name for m in self.free if m.name not in own]:
            raise SceneError(f"'linearised': nothing that moves with '{lost[0]}' has a mass")
        self.rows = [own[m.name] for m in self.free]
        self.written = [self.balances.written(row) for row in self.rows]
        ties = [e for t in self.ties for e in (t.place, t.first) if e is not None]
        self.about.define(sheet.needed([*self.written, *ties]))
        parts = [sheet.split(e) for e in self.written]
        self.rests = [self.about.expanded(rest) for rest, _ in parts]
        self.by = [{u: self.about.expanded(c) for u, c in slopes.items()} for _, slopes in parts]
        self.accelerations = [sheet.symbols[m.unknown] for m in self.free]
        held = {u for own_ in self.by for u in own_} - set(self.accelerations)
        self.forces = sorted(held, key=str)
        if len(self.forces) != len(self.ties):
            names = ", ".join(f"'{sheet.label(u)}'" for u in self.forces)
            rule = f"needs one force for each of {len(self.ties)} constraints"
            raise SceneError(f"'linearised' {rule}, and finds {names or 'none'}")

    def matrices(self) -> Linearised:
        """Return mass, damping and stiffness of what does not follow."""
        places = self._following_places()
        U, W = self._following_rates(places)
        gamma = self._coefficients(self.forces)
        lower = gamma[self.count :, :]
        right = -Matrix([own.value for own in self.rests[self.count :]])
        sizes = self._solved(lower, right, "forces of the constraints")
        M = self._coefficients(self.accelerations)
        D = self._slopes(self.velocities, sizes)
        K = self._slopes(self.places, sizes)
        left = [M * U, M * W * U + D * U, M * W * W + D * W + K * places]
        taken = self._solved(lower.T, gamma[: self.count, :].T, "forces of the constraints").T
        reduced = [self._plain(x[: self.count, :] - taken * x[self.count :, :]) for x in left]
        for k in range(self.count, len(self.free)):
            if any(reduced[2][i, k] != 0 for i in range(self.count)):
                name = self.free[k].name
                rule = f"'linearised': small motion depends on '{name}', whose rate alone follows"
                raise SceneError(f"{rule} by a constraint; hold its place by one, too")
        names = ("mass_matrix", "damping_matrix", "stiffness_matrix")
        found = dict(zip(names, (x[:, : self.count] for x in reduced), strict=True))
        return Linearised(found, tuple(self.rows), tuple(self.written))

    def _coefficients(self, unknowns: Sequence[Symbol]) -> Matrix:
        return self._plain(Matrix(len(self.rows), len(unknowns), lambda i, k:
                                  self.by[i].get(unknowns[k], NOT_HELD).value))  # fmt: skip

    def _slopes(self, variables: Sequence[Symbol | None], sizes: Matrix) -> Matrix:
        """Return how virtual powers change with small variables, forces held."""
        found = zeros(len(self.rows), len(variables))
        for k, v in enumerate(variables):
            for i, rest in enumerate(self.rests if v is not None else ()):
                assert v is not None  # noqa: S101
                total = rest.slopes.get(v, Integer(0))
                for u, size in zip(self.forces, sizes, strict=True):
                    total += self.by[i].get(u, NOT_HELD).slopes.get(v, Integer(0)) * size
                found[i, k] = total
        return self._plain(found)

    def _following_places(self) -> Matrix:
        """Return all places by those that no constraint of places makes follow."""
        size = len(self.free)
        each = [t for t in self.ties if t.place is not None]
        G = self._by_places(each, lambda t: t.place)
        probe, columns = self._probe(), list[int]()
        for n in range(len(each)):
            for k in range(size - 1, self.count - 1, -1):
                tried = [*columns, k]
                if k not in columns and self.places[k] is not None:
                    part = G.extract(range(n + 1), tried)
                    if abs(probe.value(part.det())) > NOTHING:
                        columns = tried
                        break
            else:
                rule = f"of constraint '{each[n].says}' none that is dependent follows"
                raise SceneError(f"'linearised': {rule} in the given motion")
        found = eye(size)
        if columns:
            others = [k for k in range(size) if k not in columns]
            own = self._solved(G.extract(range(len(each)), columns),
                               -G.extract(range(len(each)), others), "places")  # fmt: skip
            for i, k in enumerate(columns):
                found[k, k] = Integer(0)
                for j, other in enumerate(others):
                    found[k, other] = own[i, j]
        for k in range(size):
            if self.places[k] is None:
                found[k, k] = Integer(0)
        return found

    def _following_rates(self, places: Matrix) -> tuple[Matrix, Matrix]:
        """Return all rates by those that do not follow, and by places."""
        size, count = len(self.free), self.count
        B = self._by(self.ties, lambda t: t.first, self.velocities)
        A = self._by_places(self.ties, lambda t: t.first if t.place is None else None) * places
        whole = self._solved(B[:, count:], -Matrix.hstack(B[:, :count], A), "rates")
        U = Matrix.vstack(eye(count), whole[:, :count])
        W = Matrix.vstack(zeros(count, size), whole[:, count:])
        return U, W

    def _by_places(self, ties: Sequence[Tie], what: Callable[[Tie], Expr | None]) -> Matrix:
        return self._by(ties, what, self.places)

    def _by(
        self, ties: Sequence[Tie], what: Callable[[Tie], Expr | None],
        variables: Sequence[Symbol | None],
    ) -> Matrix:  # fmt: skip
        found = zeros(len(ties), len(variables))
        for i, tie in enumerate(ties):
            value = what(tie)
            if value is None:
                continue
            own = self.about.expanded(value)
            if not vanishes(self.balances.frames.words, own.value):
                rule = f"is about a state that constraint '{tie.says}' does not allow"
                raise SceneError(f"'linearised' {rule}")
            for k, v in enumerate(variables):
                if v is not None:
                    found[i, k] = own.slopes.get(v, Integer(0))
        return self._plain(found)

    def _probe(self) -> Probe:
        probe = random_probe(self.balances.frames.words, PROBES)
        probe.define(self.balances.frames.sheet.definitions)
        return probe

    def _plain(self, matrix: Matrix) -> Matrix:
        """Return a matrix with entries named, and those that vanish zero."""
        sheet, words = self.balances.frames.sheet, self.balances.frames.words
        return matrix.applyfunc(lambda e: Integer(0) if e == 0 or vanishes(words, e)
                                else sheet.named("small", e))  # fmt: skip

    def _solved(self, matrix: Matrix, right: Matrix, what: str) -> Matrix:
        """Return what a matrix takes to the right sides, by pivots that do not vanish."""
        size = matrix.rows
        table = self._plain(Matrix.hstack(matrix, right))
        for k in range(size):
            probe = self._probe()
            sizes = [abs(probe.value(table[i, k])) for i in range(k, size)]
            best = k + sizes.index(max(sizes))
            if max(sizes) <= NOTHING:
                rule = f"the {what} of what is dependent do not follow from the constraints"
                raise SceneError(f"'linearised': {rule} in the given motion; name others")
            table.row_swap(k, best)
            table[k, :] = self._plain(table[k, :] / table[k, k])
            for i in range(size):
                if i != k and table[i, k] != 0:
                    table[i, :] = self._plain(table[i, :] - table[i, k] * table[k, :])
        return table[:, size:]
