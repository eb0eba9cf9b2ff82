"""Cases of motion: a body, how it starts, for how long, and where it must be then.

``cases.json`` holds the shared reference cases and those of the hard-case table, end states to 40
digits. The latter are made by ``python -m bench.motion.reference``.
"""

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from importlib.resources import files
from typing import Any

Exact = tuple[Fraction, ...]
NO_VECTOR: Exact = (Fraction(0),) * 3


@dataclass(frozen=True)
class Case:
    """One motion; quaternions scalar first, body to inertial, everything else along body axes.

    inertia : (xx, yy, zz, xy, xz, yz), tensor entries in kg m^2      time : s
    moment  : constant, N m      wheel : constant momentum of wheels, kg m^2/s
    weight  : m g times the place of the mass centre from the fixed point, N m; gravity is -z
    omega_T, q_T : at the end, None where the data give no reference
    kappa_omega, kappa_attitude : relative error of omega, angle in rad, for each relative error of
        the inputs; None where the data give none
    """

    name: str
    says: str
    kind: str
    inertia: Exact
    omega0: Exact
    q0: Exact
    time: Fraction
    moment: Exact
    wheel: Exact
    weight: Exact
    omega_T: Exact
    q_T: Exact
    kappa_omega: float | None
    kappa_attitude: float | None

    @property
    def torqued(self) -> bool:
        """Tell whether anything but the body's own rotation changes omega."""
        return any((*self.moment, *self.wheel, *self.weight))

    @property
    def principal(self) -> bool:
        """Tell whether the tensor has no products."""
        return not any(self.inertia[3:])

    @property
    def rate(self) -> float:
        """Return the length of omega at the start in rad/s."""
        return math.sqrt(sum(x * x for x in self.omega0))

    @property
    def kappa(self) -> float | None:
        """Return the larger of the two condition numbers."""
        known = [k for k in (self.kappa_omega, self.kappa_attitude) if k is not None]
        return max(known) if known else None


@cache
def cases() -> dict[str, Case]:
    """Return all cases by name: the shared ones first, in their order."""
    text = (files("bench.motion") / "cases.json").read_text(encoding="utf-8")
    return {entry["id"]: case(entry) for entry in json.loads(text)["cases"]}


def case(entry: Mapping[str, Any]) -> Case:
    """Return the case of one entry of the data."""
    rows = [[_exact(x) for x in row] for row in entry["inertia"]]
    info = entry.get("info", {})
    return Case(
        name=entry["id"],
        says=entry["note"],
        kind=info.get("kind", ""),
        inertia=(rows[0][0], rows[1][1], rows[2][2], rows[0][1], rows[0][2], rows[1][2]),
        omega0=_vector(entry["omega0"]),
        q0=_vector(entry["q0"]),
        time=_exact(entry["T"]),
        moment=_vector(entry.get("M", NO_VECTOR)),
        wheel=_vector(entry.get("h", NO_VECTOR)),
        weight=_vector(entry.get("weight", NO_VECTOR)),
        omega_T=_vector(entry.get("omega_T", ())),
        q_T=_vector(entry.get("q_T", ())),
        kappa_omega=_number(entry, "cond_omega_rel_per_unit_rel_input"),
        kappa_attitude=_number(entry, "cond_angle_rad_per_unit_rel_input"),
    )


def _vector(values: Any) -> Exact:
    return tuple(_exact(x) for x in values)


def _number(entry: Mapping[str, Any], name: str) -> float | None:
    return float(entry[name]) if name in entry else None


def _exact(x: Any) -> Fraction:
    """Return what a decimal of the data is; those of inputs are the shortest of their doubles.

    >>> _exact("2.000000014901161") == Fraction(2.000000014901161)
    True
    >>> _exact("0.1234567890123456789012345") == Fraction("0.1234567890123456789012345")
    True
    """
    digits = sum(c.isdigit() for c in str(x).partition("e")[0])
    long = digits > 17
    return Fraction(x) if isinstance(x, Fraction) or long else Fraction(float(x))
