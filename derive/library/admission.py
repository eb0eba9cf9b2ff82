"""What set-up tries before a function is used: the demands of the scene, as far as it is told.

A demand on a parameter that no constant rests on is not tried: what does not matter is no argument.
Tensors are tried by the pivots of L D L^T, in pairs: no definite tensor is refused before its
condition nears 1/u^2.
"""

from collections.abc import Iterator, Sequence
from collections.abc import Set as AbstractSet
from fractions import Fraction
from itertools import combinations

from derive.library.function import Graphed
from derive.library.setting import Setting
from derive.lower.apart import apart
from derive.lower.lower import value_of
from derive.lower.setup import SetupPart
from derive.program.operations import less, select, unit_roundoff
from derive.program.program import Precondition
from derive.program.status import OF_KIND
from derive.program.tape import Number, Tape, free_prefix
from derive.scene.demands import kind
from derive.scene.formula import ZERO, Formula, symbols
from derive.scene.machine import Above, Demand, Tensor

SLACK = 4
"""How far a rod's tensor may be from one, in u of its trace: its entries come rounded."""
NOTHING = Fraction(1, 2**100)
"""What stands for that slack where all moments vanish, as a point's do."""
PLACES = {(0, 0): 0, (1, 1): 1, (2, 2): 2, (0, 1): 3, (0, 2): 4, (1, 2): 5}
SparseMatrix = dict[tuple[int, int], Number]


def tried_rules(terms: Graphed, parameters: AbstractSet[str]) -> SetupPart:
    """Return the rules of ``terms`` that rest on nothing but these parameters."""
    tape = Tape(free_prefix("r", terms.graph.leaf_names()))
    setting = Setting(terms, {}, None, tape)
    numbers = set(terms.vocabulary.numbers) | {"pi"}
    rules: dict[tuple[int, object], Precondition] = {}
    every = terms.scene.demands
    above = {d.formula for d in every if isinstance(d, Above) and d.kind != "inertia"}
    for demand in every:
        if isinstance(demand, Tensor) and _follows(demand, above):
            continue
        for value in _values(setting, demand, parameters | numbers):
            if value.exact is None:  # a number was tried when the scene was read
                relation = "positive" if isinstance(demand, Above) else demand.relation
                rule = Precondition(OF_KIND[kind(demand)], _says(demand), value.operand, relation)
                rules.setdefault((rule.status, rule.value), rule)
    return SetupPart(tuple(tape.ops), dict(setting.given), rules=tuple(rules.values()))


def _says(demand: Demand) -> str:
    if isinstance(demand, Above):
        return f"{demand.label} must be positive"
    rule = "be positive definite" if demand.relation == "positive" else "have no negative moment"
    return f"{demand.label} must {rule}"


def _follows(tensor: Tensor, above: AbstractSet[Formula]) -> bool:
    """Tell whether a tensor is a body's by the signs of masses and lengths, as a shape's is."""
    moments, products = tensor.entries[:3], tensor.entries[3:]
    least = 2 if tensor.relation == "positive" else 1
    signs = [0 if m is None else _sign(m, above) for m in moments]
    return all(p == ZERO for p in products) and min(signs) >= least


def _sign(f: Formula, above: AbstractSet[Formula]) -> int:
    """Return 2 for what is positive if ``above`` are, 1 for not negative, 0 for not known."""
    if f in above:
        return 2
    if f.operator == "number":
        return 2 if f.number > 0 else int(f.number == 0)
    parts = [_sign(part, above) for part in f.operands]
    if f.operator == "power" and (parts[0] == 2 or f.number % 2 == 0):
        return 2 if parts[0] == 2 else int(f.number > 0)
    if f.operator == "mul" or (f.operator == "div" and parts[1] == 2):
        return min(parts)
    return max(parts) if f.operator == "add" and min(parts) else 0


def _values(setting: Setting, demand: Demand, known: AbstractSet[str]) -> Iterator[Number]:
    """Yield the numbers that must be above zero, or not below it, for a demand to be met."""
    if isinstance(demand, Above):
        if set(symbols(demand.formula)) <= known:
            yield _number(setting, demand.formula)
        return
    entries = {
        place: _number(setting, part)
        for place, index in PLACES.items()
        if (part := demand.entries[index]) is not None and set(symbols(part)) <= known
    }
    tensor = {p: -n if p[0] != p[1] else n for p, n in entries.items()}
    for block in _blocks(tensor):
        own = {p: n for p, n in tensor.items() if set(p) <= set(block)}
        if len(block) > 1 and demand.relation == "not negative":
            yield from (own[i, i] for i in block)
            own = _eased(setting.tape, own, block)
        yield from _pivots(own, block)


def _number(setting: Setting, formula: Formula) -> Number:
    terms = setting.terms
    written = terms.vocabulary.expression(formula)
    return setting.parameter(value_of(terms.graph, written, terms.by_symbol()))


def _blocks(tensor: SparseMatrix) -> list[tuple[int, ...]]:
    """Return groups of axes whose moments and products are all known, none within another.

    Axes that no product couples to the rest are groups of their own.
    """
    found: list[tuple[int, ...]] = []
    for size in (3, 2, 1):
        for axes in combinations(range(3), size):
            places = [p for p in PLACES if set(p) <= set(axes)]
            whole = all(p in tensor for p in places)
            if whole and _coupled(tensor, axes) and not any(set(axes) <= set(b) for b in found):
                found.append(axes)
    return found


def _coupled(tensor: SparseMatrix, axes: Sequence[int]) -> bool:
    """Tell whether products join all these axes to one another, directly or not."""
    products = {p for p in combinations(axes, 2) if tensor[p].exact != 0}
    return len(apart([{k, *(p for p in products if k in p)} for k in axes])) == 1


def _eased(tape: Tape, tensor: SparseMatrix, axes: Sequence[int]) -> SparseMatrix:
    """Return a tensor with a slack on its diagonal, so that rounding refuses no rod."""
    trace = sum((tensor[i, i] for i in axes[1:]), tensor[axes[0], axes[0]])
    slack = SLACK * unit_roundoff(tape) * trace
    if trace.exact is None:
        slack = select(less(0, trace), slack, NOTHING)
    return {p: n + slack if p[0] == p[1] else n for p, n in tensor.items()}


def _pivots(tensor: SparseMatrix, axes: Sequence[int]) -> Iterator[Number]:
    """Yield the pivots of L D L^T; the tensor is positive definite if all are positive."""
    left = dict(tensor)
    for step, k in enumerate(axes):
        yield left[k, k]
        for place, i in enumerate(axes[step + 1 :], step + 1):
            for j in axes[place:]:
                left[i, j] = left[i, j] - left[k, i] / left[k, k] * left[k, j]
