"""A constant tensor inverted in set-up, from scaled cofactors.

Where all accelerations of a block have coefficients that rest on parameters only, its inverse is
made once and a call multiplies by it: omega_dot = I^-1 (M - omega x (I omega)). Scaling by a power
of two is exact and keeps the determinant in range at any unit of inertia.
"""

import re
from collections.abc import Callable, Sequence
from itertools import permutations

from sympy import Add, Expr, Function, Integer, Matrix, zeros

from derive.lower.apart import apart
from derive.lower.arrange.block import LinearSystem, Solution, Solve

COMPONENT = re.compile("(.*)_([xyz])(_[a-z]+)?")
SMALL = 3  # rows that cofactors are worth it for

power_of_two = Function("power_of_two")
Namer = Callable[[str, str, Expr], Expr]


def constant_tensor(found: Solution, block: LinearSystem, rest: Solve) -> bool:  # noqa: ARG001
    """Solve a block of few balances whose coefficients rest on parameters only."""
    matrix = block.matrix
    if matrix.rows > SMALL or not found.is_fixed(matrix):
        return False
    if matrix.rows == 1:
        found.solved(block.unknowns[0], _quotient(block.right[0], matrix[0, 0]))
        return True
    orders = permutations(range(matrix.rows))
    order = next((o for o in orders if _is_tensor(found, matrix[list(o), :])), None)
    if order is None:
        return False
    b = found.column("b", block.right[list(order), :])
    J = inverse(
        found.named, matrix[list(order), :], _axes(list(map(found.pivots.label, block.unknowns)))
    )
    for k, u in enumerate(block.unknowns):
        found.solved(u, (J[k, :] * b)[0])
    return True


def _quotient(e: Expr, divisor: Expr) -> Expr:
    """Return a sum over a divisor, term by term if that is the shorter."""
    split = Add(*(term / divisor for term in Add.make_args(e)))
    return min(e / divisor, split, key=lambda form: form.count_ops())


def _is_tensor(found: Solution, matrix: Matrix) -> bool:
    """Tell whether a matrix is symmetric and its trace vanishes nowhere."""
    trace = Matrix([[matrix.trace()]])
    symmetric = (matrix - matrix.T).expand() == zeros(*matrix.shape)
    return symmetric and not found.pivots.vanish(trace, [(0, 0)])


def _axes(unknowns: Sequence[str]) -> Sequence[str]:
    """Return the axes that unknowns are components along, their numbers if of no one vector.

    >>> _axes(["omega_dot_x", "omega_dot_z"]), _axes(["w_x_dot", "w_y_dot"]), _axes(["p_x", "q_y"])
    (('x', 'z'), ('x', 'y'), ('1', '2'))
    """
    found = [COMPONENT.fullmatch(u) for u in unknowns]
    vectors = {m.group(1, 3) if m else u for m, u in zip(found, unknowns, strict=True)}
    axes = tuple(m[2] for m in found if m)
    alike = len(vectors) == 1 and len({*axes}) == len(unknowns)
    return axes if alike else tuple("123"[: len(unknowns)])


def inverse(named: Namer, tensor: Matrix, axes: Sequence[str]) -> Matrix:
    """Return the inverse of a symmetric tensor of at most three rows, block by block."""
    J = zeros(*tensor.shape)
    for block in _blocks(tensor):
        part = tensor.extract(block, block)
        if len(block) == 1:
            J[block[0], block[0]] = 1 / part[0]
            continue
        for (i, k), value in _block_inverse(named, part).items():
            name = f"J_{axes[block[i]]}{axes[block[k]]}"
            J[block[i], block[k]] = J[block[k], block[i]] = named("let", name, value)
    return J


def _blocks(tensor: Matrix) -> list[tuple[int, ...]]:
    """Return the groups of axes that products of inertia couple."""
    axes = range(tensor.rows)
    return apart([{n, *(k for k in axes if tensor[n, k] != 0)} for n in axes])


def _block_inverse(named: Namer, part: Matrix) -> dict[tuple[int, int], Expr]:
    n = part.shape[0]
    scale = named("let", "scale", power_of_two(part.trace()))
    unit = Matrix(n, n, lambda i, k: part[min(i, k), max(i, k)])
    own = {
        (i, k): named("cut", f"I{i}{k}", unit[i, k] / scale) for i in range(n) for k in range(i, n)
    }
    unit = Matrix(n, n, lambda i, k: own[min(i, k), max(i, k)])
    cofactor = {
        (i, k): named("cut", f"c{i}{k}", unit.cofactor(i, k)) for i in range(n) for k in range(i, n)
    }
    determinant = sum((unit[0, k] * cofactor[0, k] for k in range(n)), Integer(0))
    volume = named("cut", "det", scale * determinant)
    return {place: value / volume for place, value in cofactor.items()}
