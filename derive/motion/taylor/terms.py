"""The terms of a Taylor series at order k while they are written down: sums, ends, what is kept.

A product's term is the sum of left_j right_(k-j). All of it but the ends j = 0 and j = k rests on
lower orders only, so the sums of all products run in one loop; additions of products join them.
"""

from dataclasses import dataclass, field

from derive.motion.taylor.series import Convolution
from derive.program.program import Op, Operand


@dataclass(frozen=True)
class Sum:
    """A term of order k: signed products, their ends (order 0 times order k), and lone terms."""

    products: tuple[tuple[int, str, str], ...] = ()
    ends: tuple[tuple[int, Operand, str], ...] = ()
    lone: tuple[tuple[int, str], ...] = ()

    def plus(self, sign: int, other: "Sum") -> "Sum":
        """Return this sum with another added or taken away."""
        return Sum(
            self.products + tuple((sign * s, a, b) for s, a, b in other.products),
            self.ends + tuple((sign * s, a, b) for s, a, b in other.ends),
            self.lone + tuple((sign * s, a) for s, a in other.lone),
        )


@dataclass
class Draft:
    """A series in the making.

    moving : values that change along the step      joins : values that one addition alone reads
    sums   : values whose term of order k is not yet written
    same   : values that differ from another at order 0 only
    """

    moving: set[str]
    joins: frozenset[str]
    start: list[Op] = field(default_factory=list)
    each: list[Op] = field(default_factory=list)
    products: list[Convolution] = field(default_factory=list)
    squares: list[Convolution] = field(default_factory=list)
    kept: dict[str, None] = field(default_factory=dict)
    same: dict[str, str] = field(default_factory=dict)
    sums: dict[str, Sum] = field(default_factory=dict)

    def once(self, name: str, operator: str, *operands: Operand) -> str:
        """Record an operation of order 0 that the rate does not have, and return its name."""
        op = Op(name, operator, operands)
        if op not in self.start:
            self.start.append(op)
        return name

    def at_k(self, result: str, operator: str, *operands: Operand) -> str:
        """Record an operation of order k, and return its name."""
        self.each.append(Op(result, operator, operands))
        return result

    def moves(self, operand: Operand) -> bool:
        """Tell whether an operand changes along the step."""
        return operand in self.moving

    def term(self, value: Operand) -> str:
        """Return the name of a moving value's term of order k."""
        if value in self.sums:
            self.write(str(value), self.sums.pop(str(value)))
        return f"{self.same.get(str(value), value)}_k"

    def series(self, value: Operand) -> str:
        """Return the name under which the terms of a moving value are kept."""
        name = self.term(value).removesuffix("_k")
        self.kept[name] = None
        return name

    def summed(self, value: Operand) -> Sum:
        """Return a moving value's term as a sum; what nothing else reads is not written itself."""
        if value in self.sums and value in self.joins:
            return self.sums.pop(str(value))
        return Sum(lone=((1, self.term(value)),))

    def write(self, value: str, total: Sum) -> str:
        """Record a sum as ``value``'s term of order k: what the loop has summed, ends, the rest."""
        parts: list[tuple[int, str]] = []
        for name, found, square in (
            (f"{value}_products", self.products, False),
            (f"{value}_squares", self.squares, True),
        ):
            own = [(s, (a, b)) for s, a, b in total.products if (a == b) is square]
            if own:
                plus, minus = (tuple(p for s, p in own if s == sign) for sign in (1, -1))
                found.append(Convolution(name, plus, minus))
                parts.append((1, name))
        for i, (sign, zeroth, kth) in enumerate(total.ends):
            parts.append((sign, self.at_k(f"{value}_end{i}", "mul", zeroth, kth)))
        (_, so_far), *rest = parts + list(total.lone)
        for i, (sign, part) in enumerate(rest, 1):
            name = f"{value}_k" if i == len(rest) else f"{value}_part{i}"
            so_far = self.at_k(name, "add" if sign > 0 else "sub", so_far, part)
        return so_far
