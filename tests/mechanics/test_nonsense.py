"""What no machine can be is refused by a sentence; what is hardly meant is said as a warning."""

from dataclasses import replace
from pathlib import Path

import pytest

from derive.emit.casadi_module import imported
from derive.emit.casadi_text import casadi_file
from derive.library.library import library
from derive.mechanics.balances import Balances
from derive.mechanics.choice import closed_loop
from derive.mechanics.mechanism import mechanism
from derive.scene import CATALOGUE, SceneError, parse_scene

TRIALS = Path(__file__).parent.parent / "data" / "trials"
EDGE = (CATALOGUE / "edge_runner_flat.toml").read_text(encoding="utf-8")
PLAIN = """
wanted = ["q_ddot", "linearised"]
[parameters]
m = { unit = "kg", range = [1, 2] }
a = { unit = "m", range = [0.1, 0.3] }
b = { unit = "m", range = [0.2, 0.4] }
k = { unit = "N/m", range = [-1, 2] }
[coordinates]
q = { unit = "rad", range = [-1, 1] }
[frames.arm]
turned = ["y q"]
[bodies.bob]
frame = "arm"
shape = "tube"
inner = "a"
outer = "a + b"
length = "b"
axis = "y"
mass = "m"
centre = ["0", "0", "-b"]
[loads]
weight = { gravity = ["0", "0", "-9.81"] }
pin = { on = "bob", force = "?pin", couple = ["?cx", "0", "?cz"] }
"""
SPRING = 'spring = {{ on = "bob", at = ["0", "0", "-b"], to = ["b", "0", "0"], {} }}\n'
PUSH = 'push = { on = "bob", force = ["0", "0", "k*b/(q - pi/4)"] }\n'
TUBE = 'shape = "tube"\ninner = "a"\nouter = "a + b"\nlength = "b"'


IDLE = "load 's': its two ends coincide always, so it has no force"
RAD = "rad; are degrees meant?"
DEGREES = f"in {RAD}"
ANGLE = 't = { unit = "rad"'


def refused(text: str) -> str:
    """Return the sentence that refuses a machine or its programs, "" if nothing does."""
    try:
        library(parse_scene(text, "odd"))
    except SceneError as error:
        return str(error).removeprefix("scene 'odd': ")
    return ""


def test_the_plain_machine_is_accepted_without_a_warning() -> None:
    assert refused(PLAIN) == ""
    assert parse_scene(PLAIN.replace("k = ", "# k = "), "odd").warnings == ()


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ('"a + b"', '"a"', "body 'bob': outer must be more than inner, but is the same"),
        ('"a + b"', '"b"', "body 'bob': outer - inner must not be negative, but 'b - a' is at"),
        (TUBE, 'shape = "plate"\nlengths = ["a", "-b"]', "body 'bob'.lengths.z must be positive"),
        ("weight =", PUSH + "weight =", "load 'push': the divisor 'q - pi/4' must not vanish"),
        ("weight =", SPRING.format('spring = "k"') + "weight =", "load 'spring': spring must not"),
        ("weight =", SPRING.format('damper = "-m/1"') + "weight =", "load 'spring'.damper = '-m"),
        ('-9.81"]', '-9.81"], on = []', "load 'weight'.on is an empty list"),
        ('-9.81"]', "-9.81\"], on = ['bob', 'bob']", "load 'weight'.on has 'bob' twice"),
    ],
)
def test_a_size_or_a_list_that_cannot_be_is_refused(old: str, new: str, says: str) -> None:
    assert old in PLAIN
    assert refused(PLAIN.replace(old, new)).startswith(says)


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("[-1, 1]", "[-180, 180]", "the range of 'q' goes to -180 rad; are degrees meant?"),
        ("y q", "y q - 30", f"frame 'arm' turns about y through 'q - 30', and 30 is {DEGREES}"),
        ("m = {", f"{ANGLE}, value = 60 }}\n#t\nm = {{", "'t' is 60 rad; are degrees meant?"),
        ("m = {", f"{ANGLE}, range = [0, 90] }}\n#t\nm = {{", f"the range of 't' goes to 90 {RAD}"),
        ("[bodies.bob]", "[frames.idle]\n[bodies.bob]", "frame 'idle' carries nothing"),
        ("[-1, 1]", "[0.5, 1]", "linearised.q is 0, outside the range of 'q', [0.5, 1]"),
        (
            "[coordinates]",
            "[linearised]\nq = '4*pi/3'\n[coordinates]",
            "linearised.q is 4.18879, outside the range of 'q', [-1, 1]",
        ),
    ],
)
def test_what_is_hardly_meant_is_a_warning(old: str, new: str, says: str) -> None:
    text = PLAIN.replace("k = ", "# k = ").replace(old, new)
    assert parse_scene(text, "odd").warnings == (says,)


@pytest.mark.parametrize("name", ["k", "q", "thrust"])
def test_a_name_beside_a_vector_of_unknowns_that_is_wanted_is_refused(name: str) -> None:
    text = PLAIN.replace("?pin", f"?{name}")
    text += '[inputs]\nthrust = { unit = "N", range = [0, 1] }\n'
    assert refused(text) == ""
    says = f"and the vector of the unknowns '{name}_x' to '{name}_z'"
    assert refused(text.replace('"q_ddot"', f'"{name}"')).endswith(says)


@pytest.mark.parametrize(("q", "size"), [("0", ""), ("0.5", "-6 rad/s^2")])
def test_small_motion_about_no_equilibrium_is_warned_about(q: str, size: str) -> None:
    # -g b sin(q)/(b^2 + (a^2 + (a + b)^2)/2) with a = 0.2 and b = 0.3 is -6.004
    machine = parse_scene(f"{PLAIN.replace('k = ', '# k = ')}\n[linearised]\nq = {q}\n", "odd")
    found = mechanism(machine).doubts()
    start = "'linearised' is about a state that is no equilibrium: the acceleration of 'q' is"
    assert [says.startswith(f"{start} {size} there") for says in found] == [True] * bool(size)


@pytest.mark.parametrize(
    "wanted",
    ["accelerations", "state_rate", "step_rk4", "linearised", "accelerations_jacobian"],
)
def test_motion_of_a_machine_with_nothing_free_is_refused(wanted: str) -> None:
    start, end = EDGE.index("wanted"), EDGE.index("[parameters]")
    text = f'{EDGE[:start]}wanted = ["{wanted}"]\n{EDGE[end:]}'
    assert "needs" in refused(text)


@pytest.mark.parametrize("name", ["spring_of_no_length", "spring_of_no_length_2"])
def test_a_spring_whose_ends_coincide_is_refused(name: str) -> None:
    says = "load 's': its two ends coincide"
    assert refused((TRIALS / f"{name}.toml").read_text(encoding="utf-8")).startswith(says)


@pytest.mark.parametrize(("at", "says"), [("0", (IDLE,)), ("-b", ())])
def test_a_spring_without_a_length_whose_ends_coincide_always_is_warned_about(
    at: str, says: tuple[str, ...]
) -> None:
    plain = PLAIN.replace('k = { unit = "N/m", range = [-1, 2] }\n', "")
    spring = f's = {{ on = "bob", spring = 1, at = ["0", "0", "{at}"], to = ["0", "0", "{at}"] }}\n'
    assert mechanism(parse_scene(plain + spring, "odd")).doubts() == says


@pytest.mark.parametrize("name", ["four_bar", "slider_crank"])
def test_a_ring_of_bodies_is_found_and_a_tree_has_none(name: str) -> None:
    machine = parse_scene((TRIALS / f"{name}.toml").read_text(encoding="utf-8"), name)
    assert "bodies form a closed loop" in closed_loop(machine, set())
    assert closed_loop(replace(machine, loads=machine.loads[:-1]), set()) == ""


def test_a_closed_loop_of_bodies_is_refused_before_any_search(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(Balances, "rows", property(lambda _: pytest.fail("a search begins")))
    says = refused((TRIALS / "four_bar.toml").read_text(encoding="utf-8"))
    assert says.startswith("bodies form a closed loop (left, bar, right, the ground)")
    assert "joined by the loads b, d, c, a" in says


def test_the_root_of_a_square_is_refused_where_a_machine_changes() -> None:
    turned = PLAIN.replace("k = ", "# k = ").replace('"y q"', '"y sqrt(q^2)"')
    assert "sqrt" in turned
    assert refused(turned)


FLOATING = """
wanted = ["accelerations"]
parameters.m = { unit = "kg", range = [10, 20] }
coordinates.x = { unit = "m", range = [-1, 1], rate = { range = [-1, 1] } }
coordinates.y = { unit = "m", range = [-1, 1], rate = { range = [-1, 1] } }
coordinates.z = { unit = "m", range = [-1, 1], rate = { range = [-1, 1] } }
speeds.p = { unit = "rad/s", range = [-2, 2] }
speeds.q = { unit = "rad/s", range = [-2, 2] }
speeds.r = { unit = "rad/s", range = [-2, 2] }
frames.base.angular_velocity = ["p", "q", "r"]
frames.base.attitude = "quaternion"
frames.base.origin = ["x", "y", "z"]
bodies.b = { frame = "base", mass = "m", shape = "box", lengths = [1, 2, 3], centre = ["1", 0, 0] }
"""


@pytest.mark.long
def test_a_body_that_floats_freely_with_its_centre_aside_has_accelerations() -> None:
    made = library(parse_scene(FLOATING, "floating"))
    (program,) = made.functions
    assert {"attitude_base_w", "p"} <= {c for q in program.inputs for c in q.components}


def test_an_answer_that_nothing_moves_is_zero_in_casadi_too(tmp_path: Path) -> None:
    text = """
wanted = ["accelerations"]
parameters.m = { unit = "kg", range = [10, 20] }
coordinates.x = { unit = "m", range = [-1, 1] }
frames.base.origin = ["x", "0", "0"]
bodies.b = { frame = "base", shape = "point", mass = "m" }
loads.rail = { on = "b", force = ["0", "?Y", "?Z"] }
"""
    made = library(parse_scene(text, "rail"))
    module = imported("rail_casadi", casadi_file(made), tmp_path)
    assert float(module.accelerations()()["x_ddot"]) == 0


def test_a_spring_of_a_body_against_itself_is_refused() -> None:
    text = FLOATING + 'loads.s = { on = "b", against = "b", spring = "m*1" , to = ["1", "0", "0"] }'
    with pytest.raises(SceneError, match="load 's' acts on 'b' against itself"):
        parse_scene(text, "floating")
