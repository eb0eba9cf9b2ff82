"""The equations of a machine with constraints: their second rates, and virtual power.

The forces and moments that all bodies need, less those that act, have no power on velocities that
the frames allow, but for what enforces the constraints: a row for every rate that motion is made
of. Reactions that do no work drop out of it, whatever else is asked.
"""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from mpmath import mp
from sympy import Expr, Integer, Matrix

from derive.lecture.stated import by_law
from derive.mechanics.balance import Balance, ValuedBalance
from derive.mechanics.bodies import centre
from derive.mechanics.constraints import Partials, Tie
from derive.mechanics.frames import ZERO, Frames
from derive.mechanics.loads import Wrench
from derive.mechanics.probe import DIGITS, NOTHING, PROBES, Probe
from derive.mechanics.valued import Sides

EnforcedRow = tuple[ValuedBalance, Expr]


def enforced(sides: Sides, held: Sequence[Tie], probes: Sequence[Probe]) -> tuple[EnforcedRow, ...]:
    """Return the rows of constraints and of virtual power, each as an expression that is zero."""
    found = [_row(sides, Balance((), "constraint", None, c.name, "", ""), c.second, probes)
             for c in held]  # fmt: skip
    for name, value in _virtual_powers(sides, held):
        balance = Balance(tuple(sides.efforts), "virtual power", None, name, "", "")
        found.append(_row(sides, balance, value, probes))
    return tuple(own for own in found if not own[0].empty)


def row_valued(sides: Sides, value: Expr, probe: Probe) -> Any:
    """Return the value of a row without unknowns, and of each unknown's coefficient."""
    sheet = sides.frames.sheet
    rest, slopes = sheet.split(value)
    parts = [rest, *(slopes.get(u, Integer(0)) for u in sides.unknowns)]
    with mp.workdps(DIGITS):
        probe.define({s: e for s, e in sheet.needed(parts).items() if s not in probe.values})
        return np.array([probe.value(part) for part in parts])


def _row(sides: Sides, balance: Balance, value: Expr, probes: Sequence[Probe]) -> EnforcedRow:
    sheet = sides.frames.sheet
    each = [row_valued(sides, value, probe) for probe in probes]
    whole = max(max(map(abs, own)) for own in each[:PROBES])
    nothing = [all(abs(own[k]) <= NOTHING * whole for own in each[:PROBES])
               for k in range(len(each[0]))]  # fmt: skip
    each = [np.array([0 * x if off else x for x, off in zip(own, nothing, strict=True)])
            for own in each]  # fmt: skip
    rest, slopes = sheet.split(value)
    kept = [(u, slopes[u]) for k, u in enumerate(sides.unknowns) if u in slopes
            and not nothing[1 + k]]  # fmt: skip
    total = (Integer(0) if nothing[0] else rest) + sum((c * u for u, c in kept), Integer(0))
    label = balance.kind.replace(" ", ".")
    return ValuedBalance(balance, tuple(each)), sheet.linear(label, total)


def _virtual_powers(sides: Sides, held: Sequence[Tie]) -> Iterator[tuple[str, Expr]]:
    """Yield for each rate, by what moves with it, the power that is nothing."""
    frames, by = sides.frames, Partials(sides.frames)
    bodies = [_Driven(sides, name) for name in sides.efforts]
    for name, rate in by.rates.items():
        total: Expr = Integer(0)
        for body in bodies:
            v, omega = (by.of_column(part, rate) for part in (body.v, body.omega))
            if v != ZERO:
                total += (v.T * body.force)[0]
            if omega != ZERO:
                total += (omega.T * body.moment)[0]
        for c in held:
            if c.generalized and c.factor is not None:
                total -= c.factor * by.by(c.first, rate)
        if total != 0:
            yield name, frames.sheet.linear("virtual.power", total)


class _Driven:
    """A body: its velocities along its own axes, and what force and moment is left of its loads."""

    def __init__(self, sides: Sides, name: str) -> None:
        frames, own = sides.frames, sides.efforts[name]
        along = own.frame
        self.omega = frames.sheet.column(f"{name}.omega", frames.turning_of_body(name))
        self.v = _centre_velocity(frames, name)
        force = sum((frames.carried(part, frame, along) for frame, part in own.force.items()), ZERO)
        moment = own.moment
        for w in sides.wrenches:
            if w.body == name:
                acting, couple = _at_centre(frames, name, w, along)
                force, moment = force - acting, moment - couple
        self.force = frames.sheet.column(f"{name}.left.F", force)
        self.moment = frames.sheet.column(f"{name}.left.M", moment)


def _centre_velocity(frames: Frames, body: str) -> Matrix:
    own, at = centre(frames, body)
    known = {"rho_i": at, "rho_i_dot": frames.sheet.rate_of_column(at), "Omega": frames.Omega[own]}
    v = frames.velocity(own) + by_law("velocity_seen_from_axes", known)
    return frames.sheet.column(f"{body}.v_G", v)


def _at_centre(frames: Frames, body: str, w: Wrench, along: str) -> tuple[Matrix, Matrix]:
    """Return the force of a load, and its moment about the mass centre, along a body's axes."""
    force, couple = (frames.carried(x, w.along, along) for x in (w.force, w.couple))
    if force == ZERO:
        return force, couple
    arm = frames.apart(centre(frames, body), w.point, along)
    known = {"M_G": ZERO, "rho_G": frames.sheet.column("arm", arm), "F": force}
    return force, couple + by_law("moment_about_any_point", known)
