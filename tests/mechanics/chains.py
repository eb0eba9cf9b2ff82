"""Machines of links that branch, slide, and are pushed and driven, as scenes."""

from bench.chains import COUPLES, HEAD, WEIGHT, angle, chain, joint, rod

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

PUSHED = "\n".join(
    [
        chain("yyy").replace('["?u_2", "0", "?w_2"]', '["?u_2", "P*l", "?w_2"]'),
        'side = { on = "rod2", frame = "link2", at = ["l/7", "0", "-l"], force = ["P", "0", "0"] }',
        "[inputs]",
        'P = { unit = "N", range = [-1, 1], meaning = "push on the middle rod, and motor" }',
    ]
)
"""Three rods in line, the one in the middle pushed aside of that line and driven."""


def driven(axes: str) -> str:
    """Return the scene of a chain whose angles are given, and the moments at its joints sought."""
    moves = 'rate = { range = [-1, 1] }, acceleration = { range = [-1, 1] }, meaning = "joint"'
    found = chain(axes).replace('meaning = "joint"', moves)
    for k, axis in enumerate(axes, 1):
        couple = COUPLES[axis]
        found = found.replace(couple.format("0", k=k), couple.format(f"?T_{k}", k=k))
    return found.replace('"accelerations"', ", ".join(f'"T_{k}"' for k in range(1, len(axes) + 1)))
