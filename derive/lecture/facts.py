"""What a step may use: some reasons explain a symbol, others relate what is left unexplained."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

from sympy import Expr

from derive.lecture.rate import rate, rate_of, seen_from_axes, seen_from_N
from derive.lecture.relations import left_by_relations
from derive.lecture.sums import expanded, flattened, reading
from derive.lecture.tree import collected, rebuilt, renamed, size, symbols
from derive.lecture.vectors import Expression

Claim = tuple[Expression, Expression]
_LONG = 60  # symbols and operators beyond which a leftover is no longer read with pleasure
ANY = "u_any"  # a vector of which nothing is assumed: what is shown for it holds for every vector
_PAIR = ("P_ij", "P_ji")  # explained only after i and j were exchanged


class CircularError(ValueError):
    """Two reasons explain a symbol by itself."""


@dataclass(frozen=True)
class Facts:
    """The explanations of symbols, the relations, and what was already explained."""

    explained: dict[str, Expression]
    related: tuple[Claim, ...]
    _full: dict[str, Expression] = field(default_factory=dict)

    @staticmethod
    def of(reasons: Iterable[Sequence[Claim]], names: dict[str, str]) -> Facts:
        """Sort the claims: the first to explain a symbol does, a later one relates."""
        facts = Facts({}, ())
        for left, right in (claim for claims in reasons for claim in claims):
            claim = (renamed(left, names), renamed(right, names))
            bare = left.operator in ("symbol", "inertia") and left.name not in symbols(right)
            if bare and facts.explanation(claim[0]) is None:
                facts.explained[claim[0].name] = claim[1]
            else:
                facts = Facts(facts.explained, (*facts.related, claim))
        return facts

    def explanation(self, symbol: Expression) -> Expression | None:
        """Return what the reasons say a symbol is: outright, by a rate, or as of any vector."""
        if symbol.name in self.explained:
            return self.explained[symbol.name]
        below = rate_of(symbol.name)
        if below is None:
            return None
        base = Expression(symbol.operator, shape=symbol.shape, name=below[0])
        if (reason := self.explanation(base)) is not None:
            return rate(reason, below[1])
        of_any = self.explained.get(seen_from_N(ANY))
        if of_any is None or below[1] is not seen_from_N or symbol.shape != (3,):
            return None
        return renamed(of_any, {ANY: base.name, seen_from_axes(ANY): seen_from_axes(base.name)})

    def explain(self, expression: Expression, within: tuple[str, ...] = ()) -> Expression:
        """Return ``expression`` with every symbol that the reasons explain replaced."""
        if expression.operator not in ("symbol", "inertia"):
            return rebuilt(expression, lambda operand: self.explain(operand, within))
        name = expression.name
        if name in within:
            raise CircularError(f"the reasons explain {name} by itself")
        if name not in self._full:
            reason = None if name in _PAIR else self.explanation(expression)
            self._full[name] = (
                expression if reason is None else self.explain(reason, (*within, name))
            )
        return self._full[name]

    def read(self, expression: Expression) -> Any:
        """Return the components of ``expression`` after every explanation."""
        return expanded(reading(self.explain(expression), self._pairs()))

    def _pairs(self) -> dict[str, Any]:
        bindings: dict[str, Any] = {}
        for name in _PAIR:
            if name in self.explained:
                bindings[name] = reading(self.explain(self.explained[name]), bindings)
        return bindings

    def differences(self, claims: Sequence[Claim]) -> tuple[Expr, ...]:
        """Return left - right of every claim, entry by entry."""
        return tuple(d for left, right in claims for d in self._difference(left, right))

    def _difference(self, left: Expression, right: Expression) -> list[Expr]:
        return flattened(self.read(left) - self.read(right))

    def relations(self) -> tuple[Expr, ...]:
        """Return what the reasons say is zero."""
        return tuple(d for d in self.differences(self.related) if d != 0)

    def rates(self) -> tuple[Expr, ...]:
        """Return the rates of the relations, which are zero too."""
        moving = self.differences([(rate(left), rate(right)) for left, right in self.related])
        return tuple(d for d in moving if d != 0)

    def gap(self, claims: Sequence[Claim]) -> tuple[Expr, ...]:
        """Return what is left of left - right of every claim, entry by entry."""
        differences = self.differences(claims)
        if not any(differences) or not self.related:
            return differences
        return left_by_relations(differences, self.relations(), self.rates())

    def leftover(self, left: Expression, right: Expression) -> Expression:
        """Return left - right for people, explained as long as that makes it shorter."""
        sides = self._rewritten(left), self._rewritten(right)
        if sides[1].operator == "zero":
            return sides[0]
        full = self.explain(left), self.explain(right)
        candidates = (collected(a - b) for a, b in (sides, map(self._rewritten, full), full))
        remaining = (each for each in candidates if each.operator != "zero")
        shortest = min(remaining, key=size, default=left - right)
        if size(shortest) <= _LONG:
            return shortest
        return left - right if size(sides[0] - sides[1]) > _LONG else sides[0] - sides[1]

    def _rewritten(self, expression: Expression) -> Expression:
        """Return ``expression`` with the left sides of reasons replaced, once, as they stand."""
        for left, right in self.related:
            if expression == left:
                return right
            if _acts_twice(expression) and left == _composed(expression):
                return self._rewritten(right @ expression.operands[1].operands[1])
        if expression.operator in ("symbol", "inertia"):
            reason = self.explanation(expression)
            return expression if reason is None else reason
        return rebuilt(expression, self._rewritten)


def _acts_twice(expression: Expression) -> bool:
    """Return whether a tensor acts on what another tensor gives, as in R^T (R v)."""
    return expression.operator == "apply" and expression.operands[1].operator == "apply"


def _composed(expression: Expression) -> Expression:
    return expression.operands[0] @ expression.operands[1].operands[0]


def expressions_of(side: Expression | tuple[Expression, ...]) -> tuple[Expression, ...]:
    """Return the expressions of one side of a step, one or several."""
    return side if isinstance(side, tuple) else (side,)
