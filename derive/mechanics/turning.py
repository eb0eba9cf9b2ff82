"""How a scene's axes and body turn: Omega, omega and the tensor along the axes, as the scene says.

All components are along the scene's axes xyz. Angular velocities of successive turns add (lecture
step "angular_velocities_add"); the tensor follows by "change_of_axes".
"""

from collections.abc import Iterable
from dataclasses import dataclass

from sympy import Expr, Integer, Matrix, Pow, cos, eye, sin, zeros

from derive.mechanics.vocabulary import Vocabulary, omega_is_given
from derive.scene import Input, Scene, Turning
from derive.scene.formula import Formula

PLACE = {"x": 0, "y": 1, "z": 2}


@dataclass(frozen=True)
class Motion:
    """The kinematics of a scene; every vector is a (3, 1) column along the axes."""

    Omega: Matrix  # angular velocity of the axes in N
    omega: Matrix  # angular velocity of the body in N
    relative: Matrix  # omega - Omega, angular velocity of the body seen from the axes
    omega_dot: Matrix  # rate of omega's components
    tensor: Matrix  # (3, 3) about the scene's point
    closure: Matrix | None  # zero when the free coordinates' rates agree with omega


def unit_vector(axis: str) -> Matrix:
    """Return the unit vector of an axis.

    >>> unit_vector("y").T
    Matrix([[0, 1, 0]])
    """
    return Matrix([Integer(axis == name) for name in PLACE])


def turn_matrix(axis: str, angle: Expr) -> Matrix:
    """Return R that takes components along turned axes to components along the old ones.

    >>> from sympy import Symbol
    >>> turn_matrix("z", Symbol("a"))[0, 1]
    -sin(a)
    """
    k = PLACE[axis]
    i, j = (k + 1) % 3, (k + 2) % 3
    R = eye(3)
    R[i, i] = R[j, j] = cos(angle)
    R[j, i], R[i, j] = sin(angle), -sin(angle)
    return R


def reduced(expression: Expr) -> Expr:
    """Return ``expression`` multiplied out, with sin^2 = 1 - cos^2.

    >>> from sympy import Symbol
    >>> a = Symbol("a")
    >>> reduced(sin(a) ** 3 + sin(a) * cos(a) ** 2)
    sin(a)
    """
    lowered = expression.expand().replace(
        lambda e: isinstance(e, Pow) and isinstance(e.base, sin) and e.exp.is_Integer and e.exp > 1,
        lambda e: (1 - cos(e.base.args[0]) ** 2) ** (e.exp // 2) * e.base ** (e.exp % 2),
    )
    return lowered.expand()


def rotation(words: Vocabulary, turns: Iterable[Turning]) -> Matrix:
    """Return the product of the turns' matrices: last axes' components to first axes'."""
    R = eye(3)
    for turn in turns:
        R = R * turn_matrix(turn.axis, words.symbols[turn.coordinate])
    return R


def turning_seen_after(
    words: Vocabulary, turns: Iterable[Turning], rates: dict[str, Expr]
) -> Matrix:
    """Return the angular velocity of the last axes in the first, along the last."""
    total = zeros(3, 1)
    for turn in turns:
        back = turn_matrix(turn.axis, words.symbols[turn.coordinate]).T
        total = back * total + unit_vector(turn.axis) * rates[turn.coordinate]
    return total


def turning_seen_before(
    words: Vocabulary, turns: Iterable[Turning], rates: dict[str, Expr]
) -> Matrix:
    """Return the angular velocity of the last axes in the first, along the first."""
    total, R = zeros(3, 1), eye(3)
    for turn in turns:
        total += R * unit_vector(turn.axis) * rates[turn.coordinate]
        R = R * turn_matrix(turn.axis, words.symbols[turn.coordinate])
    return total


def coordinate_rates(words: Vocabulary, scene: Scene) -> dict[str, Expr]:
    """Return the rate of each coordinate: an input, zero, or the unknown that omega fixes."""
    unknown = {
        name.removesuffix("_dot"): words.symbols[name]
        for name in (words["coordinate_rates"].components if "coordinate_rates" in words else ())
    }
    given = {c.name: _given(words, c.rate) for c in scene.coordinates if not c.free}
    return given | unknown


def _given(words: Vocabulary, rate: Input | Formula | None) -> Expr:
    """Return a rate that is given: an input, a formula, or zero."""
    if isinstance(rate, Input):
        return words.symbols[rate.name]
    return Integer(0) if rate is None else words.expression(rate)


def time_rates(words: Vocabulary, scene: Scene) -> dict[Expr, Expr]:
    """Return the rate of every prescribed symbol, for the chain rule."""
    rates: dict[Expr, Expr] = {}
    for s in scene.speeds:
        rates[words.symbols[s.name]] = _given(words, s.rate)
    for c in scene.coordinates:
        if not c.free:
            rates[words.symbols[c.name]] = _given(words, c.rate)
            if isinstance(c.rate, Input):
                rates[words.symbols[c.rate.name]] = _given(words, c.acceleration)
    return rates


def rate(column: Matrix, rates: dict[Expr, Expr]) -> Matrix:
    """Return the time derivative of ``column`` by the chain rule."""
    zero = zeros(*column.shape)
    return sum((column.diff(symbol) * dot for symbol, dot in rates.items()), zero)


def motion(scene: Scene, words: Vocabulary) -> Motion:
    """Return how the axes and the body of ``scene`` turn."""
    rates = coordinate_rates(words, scene)
    relative = turning_seen_before(words, scene.body.turned, rates)
    if scene.body.spin is not None:
        relative += unit_vector(scene.body.axis or "z") * words.expression(scene.body.spin)
    Omega = _axes_turning(scene, words, rates)
    closure = None
    if omega_is_given(scene):
        omega = words.column("omega")
        given = scene.known["angular_acceleration"].formulas
        if given is None:
            omega_dot = words.column("omega_dot")
        else:
            omega_dot = Matrix([words.expression(f) for f in given])
        if "coordinate_rates" in words:
            closure = (Omega + relative - omega).applyfunc(reduced)
        Omega = omega if scene.axes.fixed_in_body else Omega
    else:
        omega = Omega + relative
        omega_dot = rate(omega, time_rates(words, scene))
    return Motion(Omega, omega, relative, omega_dot, tensor(scene, words), closure)


def _axes_turning(scene: Scene, words: Vocabulary, rates: dict[str, Expr]) -> Matrix:
    if scene.axes.angular_velocity is not None:
        return Matrix([words.expression(f) for f in scene.axes.angular_velocity])
    if scene.axes.turned:
        return turning_seen_after(words, scene.axes.turned, rates)
    given = scene.known["angular_velocity"].formulas
    if given is not None:
        return Matrix([words.expression(f) for f in given])
    return words.column("omega") if "omega" in words else zeros(3, 1)


def tensor(scene: Scene, words: Vocabulary) -> Matrix:
    """Return the inertia tensor along the axes, (3, 3) kg m^2, about the scene's point."""
    own = own_tensor(scene, words)
    R = rotation(words, scene.body.turned)
    turned = (R * own * R.T).applyfunc(reduced)
    return own if turned == own.applyfunc(reduced) else turned


def own_tensor(scene: Scene, words: Vocabulary) -> Matrix:
    """Return the inertia tensor along the body's own axes, (3, 3) kg m^2, about the point."""
    xx, yy, zz, xy, xz, yz = (words.expression(f) for f in scene.body.inertia)
    return Matrix([[xx, -xy, -xz], [-xy, yy, -yz], [-xz, -yz, zz]])
