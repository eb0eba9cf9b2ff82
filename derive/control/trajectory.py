"""A trajectory that was found: what it costs, how surely, its times, states and inputs."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from derive.control.arcs import GAUSS, Refined, lagrange
from derive.control.conditions import Conditions
from derive.control.direct import Grid
from derive.control.plant import NDFloat, Plant
from derive.solve.simulation import Simulation, plot_of

DRAWN = 601  # points of a line
OVER = 1e-6  # of a range's width, that is not told
SAME = 1e-4  # of a cost: what differs by less is one local minimum


@dataclass(frozen=True)
class Trajectory:
    """The cheapest trajectory of those that were found from several starts.

    until, cost : of the refined trajectory, or of that on the grid where there is none
    missed      : the largest component of what should vanish at the end, its inputs flown
    grid        : the trajectory by equal steps, inputs held
    refined     : the trajectory on arcs; None where there is none, and why not in `unrefined`
    found       : the cost from each start, None where the solver did not converge
    """

    scene: str
    x: tuple[str, ...]
    u: tuple[str, ...]
    units: Mapping[str, str]
    until: float
    cost: float
    missed: float
    grid: Grid
    refined: Refined | None
    unrefined: str
    conditions: Conditions | None
    found: tuple[float | None, ...]
    doubts: tuple[str, ...]

    @property
    def minima(self) -> tuple[tuple[float, int], ...]:
        """Return the costs that starts led to, cheapest first, and how many starts led there."""
        return minima(self.found)

    @property
    def times(self) -> NDFloat:
        """Return the times of the columns of ``states``, s."""
        if self.refined is None:
            return np.linspace(0, self.until, self.grid.x.shape[1])
        return np.concatenate([[0.0], np.cumsum(self.refined.lasts)])

    @property
    def states(self) -> Mapping[str, NDFloat]:
        """Return each state at these times."""
        each = self.grid.x if self.refined is None else self.refined.x
        return dict(zip(self.x, each, strict=True))

    @property
    def inputs(self) -> tuple[NDFloat, Mapping[str, NDFloat]]:
        """Return times, s, and each input at them: in the middle of steps, or at Gauss's points."""
        if self.refined is None:
            count = self.grid.u.shape[1]
            times = (np.arange(count) + 0.5) * self.until / count
            return times, dict(zip(self.u, self.grid.u, strict=True))
        begins = self.times[:-1]
        times = (begins[:, None] + self.refined.lasts[:, None] * GAUSS).ravel()
        flat = self.refined.u.transpose(0, 2, 1).reshape(len(self.u), -1)
        return times, dict(zip(self.u, flat, strict=True))

    @property
    def switches(self) -> tuple[tuple[float, str, str], ...]:
        """Return when an input leaves a limit or comes to one: time, input, where it is then."""
        return tuple(self._switches())

    def _switches(self) -> Iterator[tuple[float, str, str]]:
        if self.refined is None:
            return
        says = {-1: "lower limit", 0: "between", 1: "upper limit"}
        stays: tuple[int, ...] = (2,) * len(self.u)
        at = 0.0
        for arc in self.refined.arcs:
            for name, before, now in zip(self.u, stays, arc.stays, strict=True):
                if before != now:
                    yield at, name, says[now]
            stays, at = arc.stays, at + arc.lasts

    def files(self) -> dict[str, str]:
        """Return the table and the plot, by the names of their files."""
        name = f"{self.scene}_trajectory"
        return {f"{name}.csv": self.table(), f"{name}.svg": self.plot()}

    def table(self) -> str:
        """Return the trajectory as CSV: a row a time, and the inputs that are held to the next.

        It is that on arcs where all inputs stay at limits, and else that by equal steps.
        """
        held = replace(self, refined=None, until=self.grid.until)
        if self.refined is not None and all(0 not in arc.stays for arc in self.refined.arcs):
            held = self
        rows = [",".join(["time", *self.x, *self.u])]
        for time, x in zip(held.times, np.array([*held.states.values()]).T, strict=True):
            rows.append(",".join(f"{v:z.17g}" for v in (time, *x, *held._inputs_at(time))))
        return "\n".join(rows) + "\n"

    def plot(self) -> str:
        """Return an SVG with a line for every state, every input, and the slope of H by each."""
        times = np.linspace(0, self.until, DRAWN)
        inputs = np.array([self._inputs_at(t) for t in times]).T
        lines = {n: np.interp(times, self.times, own) for n, own in self.states.items()}
        lines |= dict(zip(self.u, inputs, strict=True))
        if self.conditions is not None:
            each = zip(self.u, self.conditions.switching, strict=True)
            lines |= {
                f"dH/d {n}": np.interp(times, self.times, _from_start(self.times, own))
                for n, own in each
            }
        units = dict.fromkeys(lines, "") | dict(self.units)
        return plot_of(Simulation(times, lines, units))

    def _inputs_at(self, time: float) -> NDFloat:
        """Return the inputs from a time on; those of the last step at the end."""
        k = min(int(np.searchsorted(self.times, time, side="right")) - 1, len(self.times) - 2)
        if self.refined is None:
            held: NDFloat = self.grid.u[:, k]
            return held
        part = (time - self.times[k]) / (self.refined.lasts[k] or 1.0)
        own: NDFloat = self.refined.u[:, :, k] @ lagrange(part)
        return own


def minima(found: Iterable[float | None]) -> tuple[tuple[float, int], ...]:
    """Return costs that are not one local minimum's, cheapest first, and how often each is there.

    >>> minima((3.5, 2.0, None, 3.5001))
    ((2.0, 1), (3.5, 2))
    """
    rows = list[tuple[float, int]]()
    for cost in sorted(c for c in found if c is not None):
        if rows and cost - rows[-1][0] <= SAME * abs(rows[-1][0]):
            rows[-1] = (rows[-1][0], rows[-1][1] + 1)
        else:
            rows.append((cost, 1))
    return tuple(rows)


def _from_start(times: NDFloat, values: NDFloat) -> NDFloat:
    """Return values at all nodes, of those behind the first: it is reached by a straight line."""
    slope = (values[1] - values[0]) / (times[2] - times[1])
    return np.concatenate([[values[0] - slope * (times[1] - times[0])], values])


def beyond_ranges(
    own: Plant, states: Mapping[str, NDFloat], inputs: Mapping[str, NDFloat]
) -> tuple[str, ...]:
    """Return a warning for each component that is outside of its declared range on the way."""
    found = []
    given = {n: np.array([v]) for n, v in own.given.items() if n not in states}
    for name, values in (*states.items(), *inputs.items(), *given.items()):
        low, high = own.ranges[name]
        if name in [own.x[k] for k in own.attitude]:
            continue
        worst = max(values, key=lambda v: max(low - v, v - high))
        if low < high and max(low - worst, worst - high) > OVER * (high - low):
            rule = f"outside of its range, {low:g} to {high:g}, for which its errors are stated"
            found.append(f"{name} {'is' if name in given else 'comes to'} {worst:.6g}, {rule}")
    return tuple(found)
