"""Sums of squares that are a multiple of the squared length of a quaternion that is given.

What turns a quaternion q makes q p of it, whose squared length is |q|^2 times that of p: however q
lies, and which ranges of its components alone do not tell. That it is so is tried in a field of
integers modulo a prime, at numbers drawn for q and for all that does not rest on it.
"""

from collections.abc import Mapping, Sequence
from random import Random

from derive.verify.proved.unfolded import Operation

PRIME = 2**61 - 1
TRIED = 3
"""Times that it is tried: a polynomial that is not zero is zero at one in 10^16 of all numbers."""
UNIT_QUATERNION = (1, 0, 0, 0)
FOLLOWED = ("add", "sub", "mul", "neg")
"""What q may go through."""


def squares_in(steps: Sequence[Operation], index: int) -> list[int]:
    """Return what a sum adds the squares of, nothing if it is no such sum."""
    step = steps[index]
    if step.operator == "mul" and step.operands[0] == step.operands[1]:
        return [step.operands[0]]
    if step.operator != "add":
        return []
    each = [squares_in(steps, o) for o in step.operands]
    return [n for part in each for n in part] if all(each) else []


def cone(steps: Sequence[Operation], index: int, names: Sequence[str]) -> tuple[int, ...]:
    """Return places between q and a sum of squares of what is linear in it, in order, itself last.

    What a linear value is multiplied by may rest on q too, and is taken as any number.
    """
    linear = list[bool]()
    for step in steps[: index + 1]:
        each = [linear[o] for o in step.operands]
        whole = step.operator in ("add", "sub", "neg") and all(each)
        once = step.operator == "mul" and each.count(True) == 1
        linear.append(step.name in names or whole or once)
    needed = {index}
    for n in range(index, -1, -1):
        if n in needed and steps[n].operands:
            own = [o for o in steps[n].operands if linear[o]]
            needed.update(own if linear[n] or own else steps[n].operands)
    return tuple(sorted(needed))


def is_multiple(steps: Sequence[Operation], within: Sequence[int], names: Sequence[str]) -> bool:
    """Tell whether the last place of a cone is |q|^2 times what does not rest on q."""
    own = [n for n in within if steps[n].operator != "given"]
    if len(within) - len(own) != len(names) or any(steps[n].operator not in FOLLOWED for n in own):
        return False
    dice = Random(PRIME)  # noqa: S311 - numbers to try, no secret
    for _ in range(TRIED):
        beside = {o: dice.randrange(PRIME) for n in own for o in steps[n].operands}
        q = [dice.randrange(PRIME) for _ in names]
        of_q, of_one = (
            _modulo(steps, within, beside | _placed(steps, within, names, at))
            for at in (q, UNIT_QUATERNION)
        )
        if (of_q - of_one * (q[0] ** 2 + q[1] ** 2 + q[2] ** 2 + q[3] ** 2)) % PRIME:
            return False
    return True


def _placed(
    steps: Sequence[Operation], within: Sequence[int], names: Sequence[str], at: Sequence[int]
) -> dict[int, int]:
    """Return the components of a quaternion by their places."""
    by_name = dict(zip(names, at, strict=True))
    return {n: by_name[steps[n].name] for n in within if steps[n].operator == "given"}


def _modulo(steps: Sequence[Operation], within: Sequence[int], known: Mapping[int, int]) -> int:
    """Return the value of the last place of a cone modulo the prime."""
    values = dict(known)
    for n in within:
        step = steps[n]
        if step.operator == "given":
            continue
        each = [values[o] for o in step.operands]
        match step.operator:
            case "add":
                values[n] = each[0] + each[1]
            case "sub":
                values[n] = each[0] - each[1]
            case "mul":
                values[n] = each[0] * each[1] % PRIME
            case _:
                values[n] = -each[0]
    return values[within[-1]] % PRIME
