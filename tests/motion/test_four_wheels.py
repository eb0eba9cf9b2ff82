"""Four wheels have four speeds, and four numbers are not always an attitude."""

from pathlib import Path

import pytest
from flint import arb, ctx

from derive.library.library import Library, library
from derive.program.program import component_names
from derive.program.run import run
from derive.scene import parse_scene
from derive.verify.operators import LONG_FLOATS
from derive.verify.reference import BITS
from tests.made import library_of, thinned

QUADROTOR = Path(__file__).parents[1] / "data" / "trials" / "quadrotor.toml"
STEPS = ("step_rk4", "step_lie", "step_taylor12", "step_rk4_compensated")
TORQUES = {"u_1": "0.01", "u_2": "-0.02", "u_3": "0.04", "u_4": "-0.03"}


def stepped(made: Library, name: str, values: dict[str, arb]) -> dict[str, arb]:
    """Return what a step gives, from the scene's parameters on; what is not given is zero."""
    known = dict(values)
    for program in (made.setup, made[name]):
        names = [c for q in program.inputs for c in q.components]
        found = run(program, LONG_FLOATS, [known.get(c, arb(0)) for c in names])
        known |= dict(zip(component_names(program), found, strict=True))
    return known


@pytest.mark.long
@pytest.mark.parametrize("name", thinned(STEPS, 4))
def test_motors_that_cancel_speed_up_their_wheels_and_turn_nothing(name: str) -> None:
    text = QUADROTOR.read_text(encoding="utf-8").replace("step_rk4", name)
    as_it_is = name == "step_rk4"
    made = library_of(str(QUADROTOR)) if as_it_is else library(parse_scene(text, "quadrotor"))
    with ctx.workprec(BITS):
        given = {"Ix": "0.005", "Iy": "0.006", "Iz": "0.0085", "Jr": "2e-5", "time_step": "0.01"}
        values = {n: arb(x) for n, x in (given | TORQUES).items()} | {"attitude_w": arb(1)}
        values |= {f"s_{k}": arb(100 * k) for k in (1, 2, 3, 4)}
        after = stepped(made, name, values)
        for k in (1, 2, 3, 4):
            gained = arb(TORQUES[f"u_{k}"]) / arb("2e-5") * arb("0.01")
            assert abs(after[f"s_{k}_next"] - 100 * k - gained) < 1e-60
