"""How long the next Taylor step may be, from the last two terms of this one.

Jorba and Zou, Experimental Mathematics 14 (2005), section 3.2: terms fall like (h / radius)^k, so
the step for which the last is as small as one wants follows from a root of order ``order``. The
root is made of square roots: the same bits everywhere, and no call of pow. It is of a number that
is near 1 where steps change little, so a rough root will do.
"""

from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction

from derive.motion.taylor.series import OVER_AIM, REACH, TINY
from derive.program.program import Op, Quantity

Do = Callable[..., str]

PROPOSED = Quantity(
    "step_proposed",
    ("step_proposed",),
    (),
    "s",
    "",
    None,
    None,
    "length at which a step's last terms are within rounding, a quarter to four times "
    "time_step; for an error of e instead of u, (e/u)^(1/order) times it",
)
LARGEST = 4  # the next step is within a factor of this one
BITS = 9  # of 1/order, of which the root is made


def next_length(order: int, groups: Sequence[Sequence[str]]) -> tuple[list[Op], str]:
    """Return the operations, and the name, of the step proposed.

    groups : the components of each state that varies; each state is judged by its own size
    """
    ops: list[Op] = []

    def do(result: str, operator: str, *operands: str | Fraction) -> str:
        ops.append(Op(result, operator, operands))
        return result

    def norm(kind: str, components: Sequence[str]) -> str:
        """Record the sum of absolute values: of the states themselves, or of one of their terms."""
        total = ""
        for x in components:
            part = do(f"{x}_{kind}_abs", "abs", f"{x}_{kind}" if kind != "here" else x)
            total = do(f"{x}_{kind}_norm", "add", total, part) if total else part
        return total

    worst = ""
    for components in filter(None, groups):
        x = components[0]
        tail = do(f"{x}_reached", "mul", norm("before", components), REACH)
        tail = do(f"{x}_tail", "add", norm("last", components), tail)
        size = do(f"{x}_size", "add", norm("here", components), norm("first", components))
        ratio = do(f"{x}_ratio", "div", tail, do(f"{x}_above_zero", "add", size, TINY))
        worst = _larger(do, f"{x}_worst", worst, ratio) if worst else ratio
    if not worst:
        return [], "time_step"
    bound = Fraction(LARGEST) ** order
    tail = _larger(do, "tail_from_below", do("tail_over_aim", "mul", worst, OVER_AIM), 1 / bound)
    bounded = do("tail", "select", do("tail_is_large", "less", bound, tail), bound, tail)
    factor = do("step_factor", "div", Fraction(1), _root(do, order, bounded))
    return ops, do("step_next", "mul", "time_step", factor)


def _larger(do: Do, result: str, a: str, b: str | Fraction) -> str:
    return do(result, "select", do(f"{result}_is_less", "less", a, b), b, a)


def _root(do: Do, order: int, power: str) -> str:
    """Record the root of that order."""
    root, taken = "", 0
    for place in binary_places(order):
        for k in range(taken, place):
            power = do(f"tail_root{k + 1}", "sqrt", power)
        taken = place
        root = do(f"tail_power{place}", "mul", root, power) if root else power
    return root


def binary_places(order: int) -> Iterator[int]:
    """Yield the places of the ones of 1/order in binary.

    >>> list(binary_places(20))
    [5, 6, 9]
    """
    rest = Fraction(1, order)
    for place in range(1, BITS + 1):
        if Fraction(1, 2**place) <= rest:
            rest -= Fraction(1, 2**place)
            yield place
