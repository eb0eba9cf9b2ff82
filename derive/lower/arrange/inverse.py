"""The inverse of the inertia tensor, made once in set-up from scaled cofactors."""

from sympy import Expr, Function, Integer, Matrix, zeros

from derive.lower.arrange.draft import Draft

power_of_two = Function("power_of_two")


def inverse(draft: Draft, tensor: Matrix) -> Matrix:
    """Return the inverse of a symmetric tensor, block by block, through scaled cofactors.

    Scaling by a power of two is exact and keeps the determinant in range at any unit of inertia.
    """
    J = zeros(3, 3)
    for block in _blocks(tensor):
        part = tensor.extract(block, block)
        if len(block) == 1:
            J[block[0], block[0]] = 1 / part[0]
            continue
        for (i, k), value in _block_inverse(draft, part).items():
            name = f"J_{'xyz'[block[i]]}{'xyz'[block[k]]}"
            J[block[i], block[k]] = J[block[k], block[i]] = draft.named("let", name, value)
    return J


def _blocks(tensor: Matrix) -> list[list[int]]:
    """Return the groups of axes that products of inertia couple."""
    groups: list[list[int]] = []
    for axis in range(3):
        touching = [g for g in groups if any(tensor[axis, other] != 0 for other in g)]
        groups = [g for g in groups if g not in touching]
        groups.append(sorted([axis, *(other for g in touching for other in g)]))
    return sorted(groups)


def _block_inverse(draft: Draft, part: Matrix) -> dict[tuple[int, int], Expr]:
    n = part.shape[0]
    scale = draft.named("let", "scale", power_of_two(part.trace()))
    unit = Matrix(n, n, lambda i, k: part[min(i, k), max(i, k)])
    named = {
        (i, k): draft.named("cut", f"I{i}{k}", unit[i, k] / scale)
        for i in range(n)
        for k in range(i, n)
    }
    unit = Matrix(n, n, lambda i, k: named[min(i, k), max(i, k)])
    cofactor = {
        (i, k): draft.named("cut", f"c{i}{k}", unit.cofactor(i, k))
        for i in range(n)
        for k in range(i, n)
    }
    determinant = sum((unit[0, k] * cofactor[0, k] for k in range(n)), Integer(0))
    volume = draft.named("cut", "det", scale * determinant)
    return {place: value / volume for place, value in cofactor.items()}
