"""PyDy: Kane's method of SymPy, LU solution of the mass matrix, C by PyDy's own generator.

The mass matrix is solved symbolically, common subexpressions are taken by the generator. Angles,
speeds and frames are chosen as the problem names them, quaternion rates are given as kinematics.
"""

from collections.abc import Callable, Sequence
from typing import Any

from bench.candidate import Argument, Candidate, Source, pointer_glue
from bench.problem import Problem

AUTHOR = "PyDy"
SIMPLIFIED = "PyDy, simplified"
Expressions = list[Any]


def candidate(problem: Problem) -> Candidate:
    """Return PyDy's answer to a problem. Raises ImportError where PyDy is not installed."""
    parameters, inputs, rates = EQUATIONS[problem.scene]()
    return _emitted(AUTHOR, problem, parameters, inputs, rates)


def simplified(problem: Problem) -> Candidate:
    """Return the same after SymPy's ``simplify``, which helps small equations only."""
    from sympy import simplify

    parameters, inputs, rates = EQUATIONS[problem.scene]()
    return _emitted(SIMPLIFIED, problem, parameters, inputs, [simplify(r) for r in rates])


def _emitted(
    author: str,
    problem: Problem,
    parameters: Expressions,
    inputs: Expressions,
    rates: Expressions,
) -> Candidate:
    from pydy.codegen.c_code import CMatrixGenerator
    from sympy import Matrix

    results = [Matrix(rates)]
    if problem.pattern:
        results.append(_jacobian(problem, inputs, rates))
    header, text = CMatrixGenerator([parameters, inputs], results).doprint()
    outputs = [Argument("outputs", 0), Argument("outputs", len(rates))][: len(results)]
    takes = [Argument("parameters", 0), Argument("inputs", 0), *outputs]
    glue = pointer_glue(problem, '#include "kane.h"\n', "evaluate", takes)
    sources = (Source("kane.c", text), Source("kane.h", header))
    return Candidate(author, problem, sources, glue, ("kane.c", ("evaluate",)))


def _jacobian(problem: Problem, inputs: Expressions, rates: Expressions) -> Any:
    """Return the nonzeros of the Jacobian as a column."""
    from sympy import Matrix

    rows = dict(zip(problem.outputs, rates, strict=True))
    columns = dict(zip(problem.inputs, inputs, strict=True))
    return Matrix([rows[row].diff(columns[column]) for row, column in problem.pattern])


def _spinning(moments: Expressions, products: Expressions) -> tuple[Any, Any, Any, Any]:
    """Return N, B, the speeds and a body without translation that turns at them."""
    from sympy import Symbol
    from sympy.physics.mechanics import (
        Point,
        ReferenceFrame,
        RigidBody,
        dynamicsymbols,
        inertia,
    )

    N, B = ReferenceFrame("N"), ReferenceFrame("B")
    speeds = dynamicsymbols("u1:4")
    B.set_ang_vel(N, _along(B, speeds))
    G = Point("G")
    G.set_vel(N, 0)
    xy, xz, yz = products
    tensor = inertia(B, *moments, -xy, -yz, -xz)
    return N, B, speeds, RigidBody("body", G, B, Symbol("m"), (tensor, G))


def _along(frame: Any, entries: Sequence[Any]) -> Any:
    return entries[0] * frame.x + entries[1] * frame.y + entries[2] * frame.z


def _solved(N: Any, q: Any, u: Any, kinematics: Any, bodies: Any, loads: Any) -> Any:
    """Return the rates of the speeds, by Kane's method and LU decomposition."""
    from sympy.physics.mechanics import KanesMethod

    method = KanesMethod(N, q, u, kinematics)
    method.kanes_equations(bodies, loads)
    return method.mass_matrix.LUsolve(method.forcing)


def _quasi(count: int, speeds: Expressions) -> tuple[Any, Any]:
    """Return coordinates that only stand for the integrals of speeds, and their equations."""
    from sympy.physics.mechanics import dynamicsymbols

    q, rates = dynamicsymbols(f"a1:{count + 1}"), dynamicsymbols(f"a1:{count + 1}", 1)
    return q, [rate - speed for rate, speed in zip(rates, speeds, strict=True)]


def _rotor(moments: Expressions, products: Expressions) -> tuple[Any, Any, Any]:
    from sympy import symbols

    moment = list(symbols("M1:4"))
    N, B, u, body = _spinning(moments, products)
    q, kinematics = _quasi(3, u)
    rates = _solved(N, q, u, kinematics, [body], [(B, _along(B, moment))])
    return u, moment, list(rates)


def _free_body() -> tuple[Expressions, Expressions, Expressions]:
    from sympy import symbols

    tensor = list(symbols("I_xx I_yy I_zz I_xy I_xz I_yz"))
    u, moment, rates = _rotor(tensor[:3], tensor[3:])
    return tensor, u + moment, rates


def _principal() -> tuple[Expressions, Expressions, Expressions]:
    from sympy import symbols

    moments = list(symbols("I_xx I_yy I_zz"))
    u, moment, rates = _rotor(moments, [0, 0, 0])
    return moments, u + moment, rates


def _heavy_top() -> tuple[Expressions, Expressions, Expressions]:
    from sympy import symbols
    from sympy.physics.mechanics import (
        KanesMethod,
        Point,
        ReferenceFrame,
        RigidBody,
        dynamicsymbols,
        inertia,
    )

    A, C, m, g, length = parameters = list(symbols("A C m g l"))
    angles, u = dynamicsymbols("psi theta phi"), dynamicsymbols("u1:4")
    N = ReferenceFrame("N")
    P = N.orientnew("P", "Axis", (angles[0], N.z))
    T = P.orientnew("T", "Axis", (angles[1], P.x))
    B = T.orientnew("B", "Axis", (angles[2], T.z))
    missing = B.ang_vel_in(N) - _along(T, u)
    kinematics = [missing.dot(axis).simplify() for axis in (T.x, T.y, T.z)]
    B.set_ang_vel(N, _along(T, u))
    O = Point("O")  # noqa: E741
    O.set_vel(N, 0)
    G = O.locatenew("G", length * T.z)
    G.v2pt_theory(O, N, B)
    tensor = inertia(T, A - m * length**2, A - m * length**2, C)
    body = RigidBody("top", G, B, m, (tensor, G))
    method = KanesMethod(N, angles, u, kinematics)
    method.kanes_equations([body], [(G, -m * g * N.z)])
    rates = method.mass_matrix_full.LUsolve(method.forcing_full)
    return parameters, [*angles, *u], list(rates)


def _gyrostat() -> tuple[Expressions, Expressions, Expressions]:
    from sympy import cos, sin, symbols
    from sympy.physics.mechanics import dynamicsymbols

    tensor = list(symbols("I_xx I_yy I_zz I_xy I_xz I_yz"))
    axial = list(symbols("C1:4"))
    carrier = [moment - c for moment, c in zip(tensor[:3], axial, strict=True)]
    N, B, w, body = _spinning(carrier, tensor[3:])
    s = dynamicsymbols("s1:4")
    moment, torque = list(symbols("M1:4")), list(symbols("T1:4"))
    wheels, loads = _wheels(N, B, body.masscenter, s, axial, torque)
    loads.append((B, _along(B, [a - b for a, b in zip(moment, torque, strict=True)])))
    q, kinematics = _quasi(6, [*w, *s])
    rates = list(_solved(N, q, [*w, *s], kinematics, [body, *wheels], loads))
    phi, theta, psi = dynamicsymbols("phi theta psi")
    across = w[1] * sin(phi) + w[2] * cos(phi)
    turning = [
        w[0] + across * sin(theta) / cos(theta),
        w[1] * cos(phi) - w[2] * sin(phi),
        across / cos(theta),
    ]
    inputs = [phi, theta, psi, *w, *s, *moment, *torque]
    return tensor + axial, inputs, turning + rates


def _wheels(
    N: Any, B: Any, G: Any, s: Expressions, axial: Expressions, torque: Expressions
) -> tuple[Any, Any]:
    """Return three wheels on the axes of B, each with its axial moment only, and their torques."""
    from sympy import Symbol
    from sympy.physics.mechanics import ReferenceFrame, RigidBody, outer

    wheels, loads = [], []
    for n, axis in enumerate((B.x, B.y, B.z)):
        W = ReferenceFrame(f"W{n + 1}")
        W.set_ang_vel(B, s[n] * axis)
        W.set_ang_vel(N, B.ang_vel_in(N) + s[n] * axis)
        tensor = axial[n] * outer(axis, axis)
        wheels.append(RigidBody(f"wheel{n + 1}", G, W, Symbol(f"m{n + 1}"), (tensor, G)))
        loads.append((W, torque[n] * axis))
    return wheels, loads


def _rigid_body() -> tuple[Expressions, Expressions, Expressions]:
    from sympy import symbols
    from sympy.physics.mechanics import dynamicsymbols

    tensor = list(symbols("I_xx I_yy I_zz I_xy I_xz I_yz"))
    N, B, w, body = _spinning(tensor[:3], tensor[3:])
    quaternion = dynamicsymbols("q0:4")
    force, moment = list(symbols("F1:4")), list(symbols("M1:4"))
    position, v = dynamicsymbols("p1:4"), dynamicsymbols("v1:4")
    B.orient(N, "Quaternion", quaternion)
    B.set_ang_vel(N, _along(B, w))
    body.masscenter.set_vel(N, _along(N, v))
    q, kinematics = _quasi(6, [*v, *w])
    loads = [(body.masscenter, _along(B, force)), (B, _along(B, moment))]
    rates = list(_solved(N, q, [*v, *w], kinematics, [body], loads))
    inputs = [*position, *quaternion, *v, *w, *force, *moment]
    return [body.mass, *tensor], inputs, [*v, *_quaternion_rates(quaternion, w), *rates]


def _quaternion_rates(q: Expressions, w: Expressions) -> Expressions:
    return [
        (-q[1] * w[0] - q[2] * w[1] - q[3] * w[2]) / 2,
        (q[0] * w[0] + q[2] * w[2] - q[3] * w[1]) / 2,
        (q[0] * w[1] + q[3] * w[0] - q[1] * w[2]) / 2,
        (q[0] * w[2] + q[1] * w[1] - q[2] * w[0]) / 2,
    ]


EQUATIONS: dict[str, Callable[[], tuple[Expressions, Expressions, Expressions]]] = {
    "free_body": _free_body,
    "free_body_principal": _principal,
    "heavy_top": _heavy_top,
    "gyrostat": _gyrostat,
    "rigid_body": _rigid_body,
}
