"""A scene as an optimal-control problem has it: its rate and its step over x and u, in numbers."""

import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from decimal import Decimal
from typing import Any

import casadi
import numpy as np
from numpy.typing import NDArray

from derive.library.library import Library, library
from derive.program.program import Quantity
from derive.scene import Scene, SceneError, read
from derive.solve.instrument import Instrument, instrument
from derive.solve.settings import NamedValues, settings

NDFloat = NDArray[np.float64]
RATE = "state_rate"
STEPS = ("step_rk4_unit", "step_rk4")
"""Of which the first that the scene admits is taken: one keeps the length of its quaternion."""


@dataclass(frozen=True)
class Plant:
    """What moves, by which inputs, and how.

    x, u   : the components of the states, in the scene's order, and of the inputs
    rate   : (x, u) -> dx/dt        step : (x, u, time_step) -> x after it, u held
    ranges : declared, by component
    given  : values of parameters, and of inputs that are held
    """

    scene: Scene
    given: Mapping[str, float]
    found: Instrument
    states: tuple[Quantity, ...]
    x: tuple[str, ...]
    u: tuple[str, ...]
    units: Mapping[str, str]
    ranges: Mapping[str, tuple[float, float]]
    rate: Any
    step: Any
    step_name: str

    def scales(self, names: Iterable[str]) -> NDFloat:
        """Return of each component the largest magnitude in its range, 1 of a quaternion."""
        return np.array([max(map(abs, self.ranges[n])) or 1.0 for n in names])

    def gain(self, x: NDFloat) -> NDFloat:
        """Return what each input adds to each rate (states, inputs), inputs being 0."""
        X, U = casadi.SX.sym("x", len(self.x)), casadi.SX.sym("u", len(self.u))
        slope = casadi.Function("slope", [X, U], [casadi.jacobian(self.rate(X, U), U)])
        found: NDFloat = np.array(slope(x, np.zeros(len(self.u))).full())
        return found

    @property
    def name(self) -> str:
        """Return the scene's name."""
        return self.scene.name

    @property
    def attitude(self) -> tuple[int, ...]:
        """Return where in x the quaternion lies, () where there is none."""
        return next((self._places(q) for q in self.states if q.is_quaternion), ())

    @property
    def turning(self) -> tuple[int, ...]:
        """Return where in x the speeds lie that turn the attitude, of a body at rest zero."""
        rests = np.array(casadi.DM(self.rate.sparsity_jac(0, 0), 1))[list(self.attitude)]
        return tuple(int(k) for k in np.flatnonzero(rests.any(axis=0)) if k not in self.attitude)

    def _places(self, q: Quantity) -> tuple[int, ...]:
        return tuple(map(self.x.index, q.components))


def plant(scene: Scene, values: NamedValues) -> tuple[Plant, dict[str, float]]:
    """Return a scene's rate and step with these values of parameters, and of inputs that are held.

    What else is given are values of states, which are returned beside it.

    Raises SceneError for a scene without a rate, without an input, and for what is not given.
    """
    wished, step_name = _wishing(scene)
    found = instrument(wished)
    given = settings(scene.name, wished.vocabulary.given(), values)
    states = tuple(wished.vocabulary.states)
    x = tuple(c for q in states for c in q.components)
    needed = [n for n in found.needed(RATE) if n not in x]
    parameters = {c for q in wished.vocabulary.parameters for c in q.components}
    u = tuple(n for n in needed if n not in parameters and n not in given)
    missing = [n for n in needed if n in parameters and n not in given]
    if strange := [n for n in given if n not in (*needed, *x, *parameters)]:
        rule = "a value is of a parameter, an input that is held, or a state at the start"
        raise SceneError(f"scene '{scene.name}': {rule}, not of '{strange[0]}'")
    if missing:
        raise SceneError(f"scene '{scene.name}': set values by --set: {', '.join(missing)}")
    if not u:
        raise SceneError(f"scene '{scene.name}': nothing steers it, for its rate has no input")
    X, U, h = casadi.SX.sym("x", len(x)), casadi.SX.sym("u", len(u)), casadi.SX.sym("h")
    own = dict[str, Any](given)
    own |= {n: X[k] for k, n in enumerate(x)} | {n: U[k] for k, n in enumerate(u)}
    rates = [*found.answer(RATE, own).values()]
    after = found.answer(step_name, own | {"time_step": h})
    following = [after.get(f"{n}_next", X[k]) for k, n in enumerate(x)]
    every = {c: q for q in wished.vocabulary.given() for c in q.components}
    made = Plant(
        scene,
        given,
        found,
        states,
        x,
        u,
        {n: every[n].unit for n in (*x, *u)},
        {n: (float(every[n].low or 0), float(every[n].high or 0)) for n in (*x, *u, *given)},
        casadi.Function("rate", [X, U], [casadi.vertcat(*rates)]),
        casadi.Function("step", [X, U, h], [casadi.vertcat(*following)]),
        step_name,
    )
    return made, {n: v for n, v in given.items() if n in x}


def _wishing(scene: Scene) -> tuple[Library, str]:
    """Return the programs of the rate and the first step that the scene admits."""
    document = tomllib.loads(scene.text, parse_float=Decimal)
    document.pop("form", None)
    document.setdefault("motion", {}).setdefault("time_step", {"range": [0, 1]})
    document["motion"].pop("column", None)
    refused = ""
    for name in STEPS:
        try:
            wishes = {**document, "wanted": [RATE, name]}
            return library(read(wishes, scene.name, scene.text)), name
        except SceneError as error:
            refused = str(error)
    says = refused if refused.startswith("scene '") else f"scene '{scene.name}': {refused}"
    raise SceneError(f"{says}; to be steered, a scene must admit state_rate and step_rk4")
