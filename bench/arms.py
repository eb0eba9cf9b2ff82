"""Arms whose joints are driven, in a row, as scenes: links of any inertia, at any place."""

AXES = "xyz"
OFFSET, CENTRE, MOMENT, PRODUCT = (0.1, 0.4), (0.05, 0.1), (0.1, 0.12), (-0.01, 0.01)
"""Ranges of the data of a link."""


def arm(axes: str) -> str:
    """Return the scene of an arm whose motion is given, and the moments at its joints sought.

    axes : of the joints, one after another
    """
    data = ['g = { unit = "m/s^2", range = [9.7, 9.9], meaning = "gravity" }']
    coordinates, frames, bodies, loads = [], [], [], ['weight = { gravity = ["0", "0", "-g"] }']
    for k, axis in enumerate(axes, 1):
        data += _data(k)
        moves = "rate = { range = [-1, 1] }, acceleration = { range = [-1, 1] }"
        coordinates.append(
            f'q_{k} = {{ unit = "rad", range = [-1, 1], {moves}, meaning = "joint" }}'
        )
        at = f', parent = "link{k - 1}", origin = {_three(f"d_{k}")}' if k > 1 else ""
        frames.append(f'link{k} = {{ turned = ["{axis} q_{k}"]{at} }}')
        bodies.append(
            f'body{k} = {{ frame = "link{k}", kind = "general", mass = "m_{k}", '
            f'moments = ["A_{k}", "B_{k}", "C_{k}"], products = ["D_{k}", "E_{k}", "F_{k}"], '
            f"centre = {_three(f'c_{k}')} }}"
        )
        couple = [f'"?T_{k}"' if a == axis else f'"?u_{k}{a}"' for a in AXES]
        against = f', against = "body{k - 1}"' if k > 1 else ""
        loads.append(
            f'joint{k} = {{ on = "body{k}"{against}, frame = "link{k}", force = "?j{k}", '
            f"couple = [{', '.join(couple)}] }}"
        )
    tables = {"parameters": data, "coordinates": coordinates, "frames": frames,
              "bodies": bodies, "loads": loads}  # fmt: skip
    drives = ", ".join(f"T_{k}" for k in range(1, len(axes) + 1))
    lines = [f'wanted = ["drives: {drives}"]']
    for name, own in tables.items():
        lines += [f"[{name}]", *own]
    return "\n".join(lines)


def _data(k: int) -> list[str]:
    """Return the lines of a link's parameters."""
    found = [_datum(f"m_{k}", "kg", (1, 2))]
    found += [_datum(f"c_{k}{a}", "m", CENTRE) for a in AXES]
    found += [_datum(f"d_{k}{a}", "m", OFFSET) for a in AXES] if k > 1 else []
    found += [_datum(f"{name}_{k}", "kg m^2", MOMENT) for name in "ABC"]
    return found + [_datum(f"{name}_{k}", "kg m^2", PRODUCT) for name in "DEF"]


def _datum(name: str, unit: str, ends: tuple[float, float]) -> str:
    return f'{name} = {{ unit = "{unit}", range = {[*ends]}, meaning = "datum of a link" }}'


def _three(name: str) -> str:
    return "[" + ", ".join(f'"{name}{a}"' for a in AXES) + "]"
