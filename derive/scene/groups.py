"""What the quantities of a scene are called: a vector where it was declared so, else a scalar."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

from derive.scene.constraint import distances
from derive.scene.declaration import ANY, AXES, Input, Moving
from derive.scene.formula import ZERO, symbols
from derive.scene.machine import Force, Group, Groups, Place, Scene, Steady, Unknown
from derive.scene.results import DISTANCES, ENERGIES, MATRICES, unknown_vectors
from derive.scene.scalars import PER_SECOND
from derive.scene.steady import steady_parts


def grouped(scene: Scene) -> Scene:
    """Return a machine with what its functions are given and answer, in canonical order."""
    states = (*_with_rates(m for m in _moving(scene) if m.state), *_quaternions(scene))
    inputs = tuple(_with_rates(m for m in scene.moving if not m.state))
    rates = tuple(f"{g.name}_rate" for g in states)
    return replace(scene, groups=Groups(states, inputs, tuple(_outputs(scene, states)), rates))


def _moving(scene: Scene) -> tuple[Moving, ...]:
    return (*scene.coordinates, *scene.speeds)


def _quaternions(scene: Scene) -> Iterator[Group]:
    for frame in scene.frames:
        if name := frame.attitude:
            parts = tuple(f"{name}_{p}" for p in ("w", *AXES))
            says = f"quaternion of {frame.name}, scalar first, to {frame.parent}, of norm 1"
            yield Group(name, parts, "1", "", *ANY, says, quaternion=True)


def _with_rates(moving: Iterable[Moving]) -> Iterator[Group]:
    """Yield what moves, each with its rates that are inputs or states; components as one vector."""
    found: dict[str, list[Group]] = {}
    for m in moving:
        found.setdefault(m.vector or m.name, []).append(of_scalar(m))
        for rate in m.given:
            found.setdefault(m.of_vector(rate.name), []).append(of_scalar(rate))
    for name, parts in found.items():
        yield _joined(name, parts)


def of_scalar(entry: Input | Moving) -> Group:
    """Return the group of a scalar that is given alone."""
    return Group(entry.name, (entry.name,), entry.unit, "", entry.low, entry.high, entry.meaning)


def _joined(name: str, parts: Sequence[Group]) -> Group:
    """Return the vector of some scalars, or the scalar that is alone."""
    if len(parts) == 1:
        return parts[0]
    return replace(parts[0], name=name, components=tuple(g.name for g in parts))


def _answer(name: str, components: tuple[str, ...], unit: str, says: str) -> Group:
    return Group(name, components, unit, "", None, None, says)


def _outputs(scene: Scene, states: Iterable[Group]) -> Iterator[Group]:
    acting = {u.name: _acting(scene, u) for u in scene.unknowns}
    yield from acting.values()
    for name in unknown_vectors(scene.unknowns):
        yield _vector(name, [acting[f"{name}_{a}"] for a in AXES])
    yield from _accelerations(scene)
    results = {r.name for r in scene.results}
    rates = list(map(_rate_of, states))
    yield from (g for g in rates if g.name not in results)
    for name in ENERGIES:
        yield _answer(name, (name,), "J", name.replace("_", " "))
    yield _momentum(scene.momentum)
    for r in scene.results:
        yield _answer(r.name, (r.name,), r.unit, r.meaning)
    yield from (g for g in rates if g.name in results)  # by this name the result is meant
    yield from _matrices(scene)
    if scene.constraints:
        yield _distances(scene)
    for name, steady in (scene.steady or {"steady": Steady((), (), "")}).items():
        free_of = "" if steady.vanishes else ", without factors that never vanish, so in no unit"
        says = f"what vanishes in a steady motion{free_of}"
        yield _answer(name, steady_parts(name, len(steady.unknown)), steady.unit, says)


def _acting(scene: Scene, u: Unknown) -> Group:
    """Return an unknown with the load and the body that it acts on, along the axes of that load.

    An unknown that is no component, but stands in some, is told by the whole load.
    """
    load = next((f for f in scene.loads if isinstance(f, Force) and f.name == u.load), None)
    if load is None:
        return _answer(u.name, (u.name,), u.unit, f"generalized force of constraint {u.load}")
    kind, three = ("force", load.force) if u.unit == "N" else ("couple", load.couple)
    axes = [axis for axis, f in zip(AXES, three, strict=True) if u.name in symbols(f)]
    alone = [axis for axis, f in zip(AXES, three, strict=True) if str(f) == u.name]
    on = f"on {load.on}" + (f" against {load.against}" if load.against else "")
    says = f"unknown of the {kind} ({', '.join(map(str, three))}) of {load.name} {on}"
    if alone == axes and len(axes) == 1:
        says = f"{kind} of {load.name} {on} along {axes[0]}"
    return replace(_answer(u.name, (u.name,), u.unit, says), frame=load.along)


def _vector(name: str, parts: Sequence[Group]) -> Group:
    """Return three unknowns as one, by one sentence if they are the vector of a load."""
    whole, frames = _joined(name, parts), {g.frame for g in parts}
    said = {g.meaning.removesuffix(f" along {a}") for g, a in zip(parts, AXES, strict=True)}
    if len(said) == len(frames) == 1 and said.isdisjoint(g.meaning for g in parts):
        return replace(whole, meaning=said.pop())
    each = [g.meaning if len(frames) == 1 else f"{g.meaning} of {g.frame}" for g in parts]
    mixed = len({g.unit for g in parts}) > 1
    return replace(
        whole,
        unit="" if mixed else whole.unit,
        frame=whole.frame if len(frames) == 1 else "",
        meaning="; ".join(each) + (", each in its own unit" if mixed else ""),
    )


def _momentum(place: Place) -> Group:
    """Return the angular momentum of bodies about a point, along the axes of its frame."""
    at = f"({', '.join(map(str, place.at))})" if set(place.at) != {ZERO} else "the origin"
    says = f"angular momentum of {', '.join(place.of)} about {at} of {place.frame}"
    parts = tuple(f"angular_momentum_{a}" for a in AXES)
    return replace(_answer("angular_momentum", parts, "kg m^2/s", says), frame=place.frame)


def _rate_of(g: Group) -> Group:
    """Return the rate of a state."""
    parts = tuple(f"{c}_rate" for c in g.components)
    unit = PER_SECOND.get(g.unit, f"{g.unit}/s").replace("rad/s^2/s", "rad/s^3")
    return _answer(f"{g.name}_rate", parts, unit, f"rate of {g.name}")


def _accelerations(scene: Scene) -> Iterator[Group]:
    """Yield the highest rate of all that is free, each alone, then those that make up vectors."""
    vectors: dict[str, list[Group]] = {}
    for m in (m for m in _moving(scene) if m.free):
        unit = PER_SECOND[m.unit]
        unit = PER_SECOND[unit] if m.kind == "coordinate" else unit
        what = "acceleration" if m.kind == "coordinate" else "rate"
        one = _answer(m.unknown, (m.unknown,), unit, f"{what} of {m.vector or m.name}")
        yield one
        if m.vector:
            vectors.setdefault(m.answer, []).append(one)
    yield from (_joined(vector, each) for vector, each in vectors.items())


def _distances(scene: Scene) -> Group:
    """Return how far a state is from all that constraints ask."""
    each = dict(distances(scene.constraints))
    says = f"what is 0 where the constraints hold: {', '.join(each.values())}, each in its own unit"
    return _answer(DISTANCES, tuple(each), "", says)


def _matrices(scene: Scene) -> Iterator[Group]:
    names = [m.name for m in _moving(scene) if m.free and not m.dependent]
    places = range(1, len(names) + 1)
    for name, by in MATRICES.items():
        parts = tuple(f"{name}_{i}_{k}" for k in places for i in places)
        says = f"forces by {by}, column by column, for {', '.join(names)}, each in its own unit"
        yield _answer(name, parts, "", says)
