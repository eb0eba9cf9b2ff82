"""Scenes of machines of links: chains of rods, and what else hangs and slides."""

HEAD = [
    'wanted = ["accelerations"]', "[parameters]",
    'm = { unit = "kg", range = [1, 2], meaning = "mass" }',
    'l = { unit = "m", range = [0.5, 1], meaning = "length" }',
    'g = { unit = "m/s^2", range = [9.7, 9.9], meaning = "gravity" }', "[coordinates]",
]  # fmt: skip
WEIGHT = 'weight = { gravity = ["0", "0", "-g"] }'
COUPLES = {"y": '["?u_{k}", "{0}", "?w_{k}"]', "x": '["{0}", "?u_{k}", "?w_{k}"]'}


def chain(axes: str) -> str:
    """Return the scene of a chain of equal rods that hang from a fixed hinge, angles relative.

    axes : of the joints, one after another
    """
    coordinates = [angle(f"q_{k}") for k in range(1, len(axes) + 1)]
    frames, bodies, loads = ["[frames]"], ["[bodies]"], ["[loads]", WEIGHT]
    for k, axis in enumerate(axes, 1):
        parent = f', parent = "link{k - 1}", origin = ["0", "0", "-l"]' if k > 1 else ""
        frames.append(f'link{k} = {{ turned = ["{axis} q_{k}"]{parent} }}')
        bodies.append(rod(k))
        against = f', against = "rod{k - 1}"' if k > 1 else ""
        loads.append(joint(k, axis, against, "0"))
    return "\n".join([*HEAD, *coordinates, *frames, *bodies, *loads])


def angle(name: str) -> str:
    """Return the line of a free angle."""
    return f'{name} = {{ unit = "rad", range = [-1, 1], meaning = "joint" }}'


def rod(k: int) -> str:
    """Return the line of a rod."""
    return (
        f'rod{k} = {{ frame = "link{k}", shape = "rod", axis = "z", mass = "m", length = "l", '
        'centre = ["0", "0", "-l/2"] }'
    )


def joint(k: int, axis: str, against: str, moment: str) -> str:
    """Return the line of a hinge, with a moment about its axis."""
    couple = COUPLES[axis].format(moment, k=k)
    return f'joint{k} = {{ on = "rod{k}"{against}, force = "?j{k}", couple = {couple} }}'


TIP = 'frame = "link1", at = ["0", "0", "-l"]'
ON_A_CART = "\n".join(
    [
        *HEAD,
        'x = { unit = "m", range = [-1, 1], meaning = "place of the cart" }',
        *map(angle, ("q_1", "q_2", "q_3")),
        "[inputs]",
        'F = { unit = "N", range = [-1, 1], meaning = "push on the cart" }',
        'T = { unit = "N m", range = [-1, 1], meaning = "motor between the first two links" }',
        'P = { unit = "N", range = [-1, 1], meaning = "push on the last link, across it" }',
        "[frames]",
        'cart = { origin = ["x", "0", "l/3"] }',
        'link1 = { parent = "cart", origin = ["l/5", "0", "0"], turned = ["y q_1"] }',
        'tip1 = { parent = "link1", origin = ["l/4", "0", "-l"] }',
        'link2 = { parent = "tip1", turned = ["y q_2"] }',
        'link3 = { parent = "cart", turned = ["y q_3"] }',
        "[bodies]",
        'cart = { frame = "cart", shape = "box", mass = "3*m", lengths = ["l", "l", "l"] }',
        rod(1),
        rod(2),
        rod(3),
        "[loads]",
        WEIGHT,
        'rail = { on = "cart", force = ["F", "?r_1", "?r_2"], couple = "?hold" }',
        joint(1, "y", ', against = "cart"', "-T/2"),
        joint(2, "y", ', against = "rod1"', "T"),
        joint(3, "y", ', against = "cart"', "0"),
        'across = { on = "rod2", frame = "link2", at = ["0", "0", "-l"], force = ["P", "0", "0"] }',
        f'wind = {{ on = "rod1", {TIP}, along = "inertial", force = ["P", "0", "0"] }}',
    ]
)
"""Two links and one on a cart, pushed and driven, the second hinge aside of the first link."""
