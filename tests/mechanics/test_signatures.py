"""A function takes what its answer depends on, by the data file, and nothing else."""

import pytest

from derive.mechanics.matter import OTHERS
from derive.mechanics.mechanism import Mechanism, mechanism
from derive.mechanics.probe import PROBES, random_probe
from derive.scene import load

# What the data file lists under answer_depends_on, in the names of the catalogue's parameters; a
# moment of inertia is written out in masses and lengths, of which some then cancel.
DEPENDS = (
    ("edge_runner_flat", "N", {"m", "g", "r", "W"}),
    ("edge_runner_flat", "gyro_gain", {"g", "r", "W"}),
    ("eulers_disk", "steady", {"g", "r", "tilt", "W"}),
    ("ship_turbine_turn_port", "reactions", {"m", "g", "k", "p", "v", "R", "a", "b"}),
    ("ship_turbine_turn_port", "gyro_moment", {"m", "k", "p", "v", "R"}),
    ("ship_turbine_three_motions", "turn_case", {"m", "g", "kz", "ws", "turn", "a", "b"}),
    ("ship_turbine_three_motions", "roll_case", {"m", "g", "a", "b"}),
    ("disc_two_bearings", "couple", {"m", "r", "w", "W"}),
    ("propeller_3_blade", "M", {"blade_mass", "blade_length", "p", "W"}),
    ("skewed_disc", "M", {"m", "r", "w", "skew"}),
    ("top_steady_precession", "steady", {"r", "l", "n", "theta", "g", "W"}),
    ("gyrocompass", "period_s", {"w3", "we", "lat"}),
    ("reaction_wheel_satellite", "body",
     {"J_xx", "J_yy", "J_zz", "J_xy", "J_xz", "J_yz", "I_w", "w_x", "w_y", "w_z", "s_1", "s_2",
      "s_3", "u_1", "u_2", "u_3"}),
)  # fmt: skip


def known(name: str) -> Mechanism:
    scene = load(name)
    return mechanism(scene)


@pytest.mark.long
@pytest.mark.parametrize(("name", "function", "expected"), DEPENDS,
                         ids=[f"{row[0]}-{row[1]}" for row in DEPENDS])  # fmt: skip
def test_an_answer_depends_on_what_the_data_file_says(
    name: str, function: str, expected: set[str]
) -> None:
    found = known(name)
    found.problem(function)
    assert set(found.depends_on(function)) == expected


def test_the_hinge_force_stays_outside_when_only_the_press_is_asked() -> None:
    found = known("edge_runner_flat")
    problem = found.whole("N")
    assert [str(b) for b in problem.balances] == [
        "moment on roller about the origin of axle along y of axle"
    ]
    assert len(problem.unknowns) == 1


def test_trial_values_lie_within_the_ranges_and_no_two_are_alike() -> None:
    words = known("sleeping_top").words
    book, numbers = words.vocabulary, (*range(PROBES), OTHERS)
    points = [random_probe(words, n).values for n in numbers]
    for q in (*book.parameters, *book.states, *book.inputs):
        for symbol in (book.symbols[c] for c in q.components):
            values = [float(each[symbol]) for each in points]
            assert len({*values}) == PROBES + 1
            assert all(float(q.ends[0]) < x < float(q.ends[1]) for x in values)
