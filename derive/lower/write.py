"""Operations in the order in which the outputs need them."""

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from fractions import Fraction

from derive.lower.graph import Value
from derive.lower.numbering import Numbering, SignedKey
from derive.program.program import Operand
from derive.program.tape import Tape


@dataclass
class Writer:
    """Writes operations in the order in which the outputs need them."""

    numbering: Numbering
    constant: Callable[[Value], Operand]
    tape: Tape
    done: dict[int, Operand] = field(default_factory=dict)

    def _emit(self, operator: str, *operands: Operand) -> str:
        return self.tape.record(operator, operands)

    def operand(self, key: int) -> Operand:
        """Return the operand that holds ``key``, written if need be."""
        if key not in self.done:
            self.done[key] = self._write(key)
        return self.done[key]

    def signed(self, term: SignedKey) -> Operand:
        """Return the operand that holds a signed key."""
        sign, key = term
        operand = self.operand(key)
        if sign > 0:
            return operand
        return -operand if isinstance(operand, Fraction) else self._emit("neg", operand)

    def _write(self, key: int) -> Operand:
        numbering = self.numbering
        if key in numbering.leaves:
            return numbering.leaves[key]
        if key in numbering.constants:
            return self.constant(numbering.constants[key])
        if key in numbering.calls:
            function, terms = numbering.calls[key]
            return self._emit(function, *(self.signed(term) for term in terms))
        if key in numbering.inverse:
            return self._emit("div", Fraction(1), self.operand(numbering.inverse[key]))
        if key in numbering.addends:
            return self._sum(numbering.addends[key])
        return self._multiplied(numbering.factors[key])

    def _sum(self, addends: list[SignedKey]) -> Operand:
        plus = [key for sign, key in addends if sign > 0]
        minus = [key for sign, key in addends if sign < 0]
        first, *rest = plus or minus
        total = self.operand(first)
        for key in rest:
            total = self._emit("add", total, self.operand(key))
        if not plus:
            return self._emit("neg", total)
        for key in minus:
            total = self._emit("sub", total, self.operand(key))
        return total

    def _multiplied(self, factors: list[int]) -> Operand:
        shared = {f for f in factors if f in self.done}
        top = [f for f in factors if f not in self.numbering.inverse or f in shared]
        top.sort(
            key=lambda f: f in self.numbering.constants
        )  # constants last: they come from memory
        bottom = [
            self.numbering.inverse[f]
            for f in factors
            if f in self.numbering.inverse and f not in shared
        ]
        total: Operand = self.operand(top[0]) if top else Fraction(1)
        for key in top[1:]:
            total = self._emit("mul", total, self.operand(key))
        if not bottom:
            return total
        divisor = self.operand(bottom[0])
        for key in bottom[1:]:
            divisor = self._emit("mul", divisor, self.operand(key))
        return self._emit("div", total, divisor)


def shared_reciprocals(numbering: Numbering, writer: Writer) -> None:
    uses = Counter(f for factors in numbering.factors.values() for f in set(factors))
    for inverse in numbering.inverse:
        if uses[inverse] > 1:
            writer.operand(inverse)
