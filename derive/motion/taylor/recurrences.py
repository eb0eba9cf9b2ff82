"""The recurrence of each operation: its term of order k from the terms of its operands.

Griewank and Walther, Evaluating Derivatives (2008), table 13.2.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from fractions import Fraction

from derive.motion.taylor.series import INVERSE, ORDER, Convolution
from derive.program.program import Op, Operand


@dataclass(frozen=True)
class OrderTerm:
    """A term of order k: signed products, their ends (order 0 times order k), and lone terms."""

    products: tuple[tuple[int, str, str], ...] = ()
    ends: tuple[tuple[int, Operand, str], ...] = ()
    lone: tuple[tuple[int, str], ...] = ()

    def plus(self, sign: int, other: "OrderTerm") -> "OrderTerm":
        """Return this sum with another added or taken away."""
        return OrderTerm(
            self.products + tuple((sign * s, a, b) for s, a, b in other.products),
            self.ends + tuple((sign * s, a, b) for s, a, b in other.ends),
            self.lone + tuple((sign * s, a) for s, a in other.lone),
        )


@dataclass
class Recurrences:
    """A series in the making.

    varying : values that change along the step      joins : values that one addition alone reads
    sums   : values whose term of order k is not yet written
    same   : values that differ from another at order 0 only
    """

    varying: set[str]
    joins: frozenset[str]
    start: list[Op] = field(default_factory=list)
    each: list[Op] = field(default_factory=list)
    products: list[Convolution] = field(default_factory=list)
    squares: list[Convolution] = field(default_factory=list)
    kept: dict[str, None] = field(default_factory=dict)
    same: dict[str, str] = field(default_factory=dict)
    sums: dict[str, OrderTerm] = field(default_factory=dict)

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

    def varies(self, operand: Operand) -> bool:
        """Tell whether an operand changes along the step."""
        return operand in self.varying

    def term(self, value: Operand) -> str:
        """Return the name of a varying value's term of order k."""
        if value in self.sums:
            self.write(str(value), self.sums.pop(str(value)))
        return f"{self.same.get(str(value), value)}_k"

    def kept_terms(self, value: Operand) -> str:
        """Return the name under which the terms of a varying value are kept."""
        name = self.term(value).removesuffix("_k")
        self.kept[name] = None
        return name

    def summed(self, value: Operand) -> OrderTerm:
        """Return a varying value's term as a sum; what nothing else reads is not written itself."""
        if value in self.sums and value in self.joins:
            return self.sums.pop(str(value))
        return OrderTerm(lone=((1, self.term(value)),))

    def write(self, value: str, total: OrderTerm) -> str:
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


TWIN = {"sin": "cos", "cos": "sin"}


def record(recurrences: Recurrences, op: Op, ops: Sequence[object]) -> None:
    """Record an operation at order 0 and, if it changes along the step, at order k."""
    if op not in recurrences.start:
        recurrences.start.append(op)
    if not any(map(recurrences.varies, op.operands)):
        return
    recurrences.varying.add(op.result)
    if op.operator in ("add", "sub", "neg"):
        _linear(recurrences, op)
    elif op.operator == "mul":
        _product(recurrences, op)
    elif op.operator == "div":
        _quotient(recurrences, op)
    elif op.operator == "sqrt":
        _root(recurrences, op)
    elif op.operator in TWIN:
        _sine_and_cosine(recurrences, op, ops)
    else:
        raise ValueError(f"'{op.operator}' has no Taylor recurrence")


def _linear(recurrences: Recurrences, op: Op) -> None:
    signs = (-1,) if op.operator == "neg" else (1, -1 if op.operator == "sub" else 1)
    parts = [(s, o) for s, o in zip(signs, op.operands, strict=True) if recurrences.varies(o)]
    if any(o in recurrences.sums and o in recurrences.joins for _, o in parts):
        total = OrderTerm()
        for sign, operand in parts:
            total = total.plus(sign, recurrences.summed(operand))
        recurrences.sums[op.result] = total
    elif len(parts) == 2:
        recurrences.at_k(f"{op.result}_k", op.operator, *(recurrences.term(o) for _, o in parts))
    elif parts[0][0] > 0:
        recurrences.same[op.result] = recurrences.term(parts[0][1]).removesuffix("_k")
    else:
        recurrences.at_k(f"{op.result}_k", "neg", recurrences.term(parts[0][1]))


def _product(recurrences: Recurrences, op: Op) -> None:
    a, b = op.operands
    if not (recurrences.varies(a) and recurrences.varies(b)):
        terms = (recurrences.term(o) if recurrences.varies(o) else o for o in op.operands)
        recurrences.at_k(f"{op.result}_k", "mul", *terms)
        return
    ends: tuple[tuple[int, Operand, str], ...] = (
        (1, a, recurrences.term(b)),
        (1, b, recurrences.term(a)),
    )
    if a == b:
        ends = ((1, recurrences.once(f"{a}_twice", "add", a, a), recurrences.term(a)),)
    recurrences.sums[op.result] = OrderTerm(
        ((1, recurrences.kept_terms(a), recurrences.kept_terms(b)),), ends
    )


def _quotient(recurrences: Recurrences, op: Op) -> None:
    """c = a / b: b_0 c_k = a_k - sum b_j c_(k-j), j = 1 .. k."""
    a, b = op.operands
    name = f"{b}_inverse" if isinstance(b, str) else f"{op.result}_divisor_inverse"
    inverse = recurrences.once(name, "div", Fraction(1), b)
    if not recurrences.varies(b):
        recurrences.at_k(f"{op.result}_k", "mul", recurrences.term(a), inverse)
        return
    total = recurrences.summed(a) if recurrences.varies(a) else OrderTerm()
    recurrences.kept[op.result] = None
    unknown = OrderTerm(
        ((1, recurrences.kept_terms(b), op.result),), ((1, op.result, recurrences.term(b)),)
    )
    if not recurrences.varies(a):
        taken = recurrences.write(f"{op.result}_taken", unknown)
        numerator = recurrences.at_k(f"{op.result}_numerator", "neg", taken)
    else:
        numerator = recurrences.write(f"{op.result}_numerator", total.plus(-1, unknown))
    recurrences.at_k(f"{op.result}_k", "mul", numerator, inverse)


def _root(recurrences: Recurrences, op: Op) -> None:
    """r = sqrt(a): 2 r_0 r_k = a_k - sum r_j r_(k-j), 0 < j < k."""
    r = op.result
    half = recurrences.once(f"{r}_half_inverse", "div", Fraction(1, 2), r)
    a = recurrences.term(op.operands[0])
    recurrences.kept[r] = None
    recurrences.squares.append(Convolution(f"{r}_squares", ((r, r),), ()))
    rest = recurrences.at_k(f"{r}_numerator", "sub", a, f"{r}_squares")
    recurrences.at_k(f"{r}_k", "mul", rest, half)


def _sine_and_cosine(recurrences: Recurrences, op: Op, ops: Sequence[object]) -> None:
    """k s_k = sum j u_j c_(k-j), k c_k = -sum j u_j s_(k-j), j = 1 .. k."""
    if op.result in recurrences.kept:
        return
    (u,) = op.operands
    twins = [
        o.result for o in ops if isinstance(o, Op) and o == Op(o.result, TWIN[op.operator], (u,))
    ]
    twin = recurrences.once(twins[0] if twins else f"{op.result}_twin", TWIN[op.operator], u)
    sine, cosine = (op.result, twin) if op.operator == "sin" else (twin, op.result)
    recurrences.varying |= {sine, cosine}
    slope = f"{u}_slope"
    recurrences.at_k(f"{slope}_k", "mul", ORDER, recurrences.term(u))
    recurrences.kept |= dict.fromkeys((slope, sine, cosine))
    for value, other, negative in ((sine, cosine, False), (cosine, sine, True)):
        total = OrderTerm(((1, slope, other),), ((1, other, f"{slope}_k"),))
        whole = recurrences.write(f"{value}_whole", total)
        if negative:
            whole = recurrences.at_k(f"{value}_negative", "neg", whole)
        recurrences.at_k(f"{value}_k", "mul", whole, INVERSE)
