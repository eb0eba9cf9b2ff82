"""Chains of rods as scenes, alone and on a cart."""

HEAD = [
    'wanted = ["accelerations"]', "[parameters]",
    'm = { unit = "kg", range = [1, 2], meaning = "mass" }',
    'l = { unit = "m", range = [0.5, 1], meaning = "length" }',
    'g = { unit = "m/s^2", range = [9.7, 9.9], meaning = "gravity" }', "[coordinates]",
]  # fmt: skip
WEIGHT = 'weight = { gravity = ["0", "0", "-g"] }'
COUPLES = {"y": '["?u_{k}", "{0}", "?w_{k}"]', "x": '["{0}", "?u_{k}", "?w_{k}"]'}
CART = (
    'cart = { frame = "cart", shape = "box", mass = "3*m", lengths = ["l", "l", "l"] }',
    'rail = { on = "cart", force = ["0", "?r_1", "?r_2"], couple = "?hold" }',
)


def chain(axes: str, *, on_a_cart: bool = False) -> str:
    """Return the scene of a chain of equal rods that hang from a hinge, angles relative.

    axes      : of the joints, one after another
    on_a_cart : whether the hinge slides, along x, or is fixed
    """
    coordinates = [angle(f"q_{k}") for k in range(1, len(axes) + 1)]
    frames, bodies, loads = ["[frames]"], ["[bodies]"], ["[loads]", WEIGHT]
    if on_a_cart:
        coordinates.append('x = { unit = "m", range = [-1, 1], meaning = "place of the cart" }')
        frames.append('cart = { origin = ["x", "0", "0"] }')
        bodies.append(CART[0])
        loads.append(CART[1])
    for k, axis in enumerate(axes, 1):
        parent = f', parent = "link{k - 1}", origin = ["0", "0", "-l"]' if k > 1 else ""
        parent = ', parent = "cart"' if k == 1 and on_a_cart else parent
        frames.append(f'link{k} = {{ turned = ["{axis} q_{k}"]{parent} }}')
        bodies.append(rod(k))
        against = f', against = "rod{k - 1}"' if k > 1 else ""
        against = ', against = "cart"' if k == 1 and on_a_cart else against
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
