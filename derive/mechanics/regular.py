"""Balances that determine what is asked wherever the machine itself does."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial

from sympy import Expr, Integer, Symbol

from derive.mechanics.balance import ValuedBalance
from derive.mechanics.balances import Balances
from derive.mechanics.choice import chosen, clearly_told, require_no_ring
from derive.mechanics.contradiction import contradiction
from derive.mechanics.frames import Frames
from derive.mechanics.held import lost
from derive.mechanics.inertia import require_held, require_told, vanishing
from derive.mechanics.probe import Probe
from derive.mechanics.sweep import (
    LEAST,
    LEAST_OF_MASSES,
    Weakest,
    probe_at,
    ranges,
    regular,
    weakest,
)
from derive.scene import SceneError

Determining = tuple[tuple[ValuedBalance, ...], tuple[Symbol, ...]]
"""Balances, and the unknowns that they determine."""
TRIES = 6  # places at which balances must be independent, found one after another


@dataclass(frozen=True)
class Regular:
    """The balances of a machine, to choose from."""

    frames: Frames
    balances: Balances
    found: dict[frozenset[Symbol], Determining] = field(default_factory=dict, compare=False)
    """What was determined already: a rate of the state is asked for beside accelerations."""

    @cached_property
    def _contradiction(self) -> str:
        return contradiction(self.balances)

    def determining(self, wanted: set[Symbol]) -> Determining:
        """Return balances that determine the unknowns wherever the machine itself does."""
        key = frozenset(wanted)
        if key not in self.found:
            self.found[key] = self._determining(wanted)
        return self.found[key]

    def _determining(self, wanted: set[Symbol]) -> Determining:
        """Return such balances, sought anew.

        Where those chosen are found to depend on each other, others are, for that place too.
        """
        hard: list[Probe] = []
        first = rows, unknowns = self._chosen(wanted, hard)
        for _ in range(TRIES):
            worst = self._weakest(rows, unknowns)
            if not worst.vanishes:
                return rows, unknowns
            if says := lost(self.frames, worst.place):
                raise SceneError(says)
            hard.append(probe_at(self.frames.words, worst.place, self.frames.sheet.definitions))
            try:
                rows, unknowns = self._chosen(wanted, hard)
            except SceneError:
                break
        worst = self._weakest(*first)
        if rows and self._told(first[1], worst):
            if says := vanishing(self.balances, first[1], self._entries(*first), worst):
                raise SceneError(says)
            names = ", ".join(f"'{self.frames.sheet.label(u)}'" for u in first[1])
            rule = f"vanishes {worst.where}, where the machine itself is regular"
            raise SceneError(f"the divisor of {names} {rule}, and no other balances were found")
        return first

    def _weakest(self, rows: tuple[ValuedBalance, ...], unknowns: tuple[Symbol, ...]) -> Weakest:
        """Return where the balances are nearest to depending on each other."""
        if not rows:
            return Weakest(1.0, {})
        entries = self._entries(rows, unknowns)
        below = self.frames.sheet.needed([e for row in entries for e in row])
        of_masses = all(row.outboard for row in rows)
        bound = LEAST_OF_MASSES if of_masses else LEAST
        measure = partial(regular, entries=entries, of_masses=of_masses)
        return weakest(ranges(self.frames.words), below, measure, bound)

    def _entries(
        self, rows: tuple[ValuedBalance, ...], unknowns: tuple[Symbol, ...]
    ) -> list[list[Expr]]:
        """Return what balances multiply the unknowns by."""
        slopes = [self.frames.sheet.split(self.balances.written(row))[1] for row in rows]
        return [[own.get(u, Integer(0)) for u in unknowns] for own in slopes]

    def _told(self, unknowns: tuple[Symbol, ...], worst: Weakest) -> bool:
        """Tell whether the machine itself determines the unknowns where some balances do not."""
        every = self.balances.unknowns
        place = probe_at(self.frames.words, worst.place, self.frames.sheet.definitions)
        return clearly_told(self.balances, frozenset(map(every.index, unknowns)), place)

    def _chosen(self, wanted: set[Symbol], hard: Sequence[Probe]) -> Determining:
        every = self.balances.unknowns
        require_told(self.balances, wanted)
        require_held(self.balances, wanted)
        if not wanted:
            return (), ()
        require_no_ring(self.balances, frozenset(every.index(s) for s in wanted))
        if not self.frames.machine.steady and self._contradiction:
            raise SceneError(self._contradiction)
        rows, unknowns = chosen(self.balances, frozenset(every.index(s) for s in wanted), hard)
        return rows, tuple(every[k] for k in sorted(unknowns))
