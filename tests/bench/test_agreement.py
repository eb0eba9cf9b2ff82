"""Every tool solves the same problem: its code agrees with ball arithmetic of the vector equations.

The tools share no algebra with each other or with the reference, so a wrong sign in a hand-written
minimum, in a peer's set-up or in the reference shows here.
"""

import shutil
from dataclasses import replace

import pytest

from bench import handwritten
from bench.accuracy import accuracy
from bench.build import O2, answers, build
from bench.candidate import Candidate, Source
from bench.contest import Author, authors, entry
from bench.peers import casadi, kane, symforce
from bench.problem import FREE_BODY, HEAVY_TOP, PROBLEMS, RIGID_JACOBIAN
from bench.sample import SETS, samples
from bench.truth import truth
from tests.made import thinned

# Ordinary bodies: condition numbers below 100, so 1000 units tell rounding from a wrong equation.
ROUNDING = 1000
# The best form: a median of 2 units and 16 of the largest term; the largest term may be 20 times
# the result where terms cancel.
BEST_MEDIAN = 2
PEERS = {"PyDy": kane.candidate, "SymForce": symforce.candidate, "CasADi": casadi.candidate}

pytestmark = pytest.mark.skipif(not shutil.which("gcc"), reason="needs gcc")


def errors(candidate: Candidate, folder, kind: str = SETS[0]):
    """Return the accuracy of a candidate on forty samples."""
    problem = candidate.problem
    rows = samples(problem, kind, 40)
    found = answers(build(candidate, O2, folder), rows, problem.width)
    true = [truth(problem, row, candidate.rotation) for row in rows]
    return accuracy(problem, found, true)


@pytest.mark.parametrize("problem", PROBLEMS, ids=lambda p: p.name)
def test_the_handwritten_minimum_solves_its_problem(problem, tmp_path) -> None:
    found = errors(handwritten.candidate(problem), tmp_path)
    assert found.middle <= BEST_MEDIAN
    assert found.largest <= ROUNDING


@pytest.mark.parametrize("problem", thinned(PROBLEMS, 3), ids=lambda p: p.name)
@pytest.mark.parametrize("peer", PEERS)
def test_a_peer_solves_the_same_problem(peer, problem, tmp_path) -> None:
    try:
        candidate = PEERS[peer](problem)
    except ImportError as absent:
        pytest.skip(f"{peer} is not installed: {absent}")
    if candidate.sources[-1].name.endswith(".cc") and not shutil.which("g++"):
        pytest.skip("needs g++")
    assert errors(candidate, tmp_path).largest <= ROUNDING


def test_a_wrong_sign_is_seen(tmp_path) -> None:
    right = handwritten.candidate(FREE_BODY)
    text = right.sources[0].text.replace("- (y * l_z - z * l_y)", "+ (y * l_z - z * l_y)")
    wrong = replace(right, sources=(Source("free_body.c", text), *right.sources[1:]))
    assert errors(wrong, tmp_path).largest > 1e9


def test_a_wrong_entry_of_the_jacobian_is_seen(tmp_path) -> None:
    right = handwritten.candidate(RIGID_JACOBIAN)
    text = right.sources[0].text.replace("J(10) = -a_z", "J(10) = a_z")
    wrong = replace(right, sources=(Source("rigid_body_jacobian.c", text), *right.sources[1:]))
    assert errors(wrong, tmp_path).largest > 1e9


def test_a_tensor_inverted_in_double_is_seen_on_a_thin_rod(tmp_path) -> None:
    right = handwritten.candidate(FREE_BODY)
    text = right.sources[2].text.replace("typedef __float128 real", "typedef double real")
    wrong = replace(right, sources=(*right.sources[:2], Source("inverse.h", text)))
    good = errors(right, tmp_path / "quadruple", "rod 1e-6")
    bad = errors(wrong, tmp_path / "double", "rod 1e-6")
    assert bad.middle > 100 * good.middle


def test_a_tool_that_is_not_installed_is_listed_as_not_run(tmp_path) -> None:
    def absent(problem):
        raise ImportError("No module named 'nowhere'")

    found = entry(Author("nowhere", absent), HEAVY_TOP, 1, tmp_path)
    assert found.missing == "not run: No module named 'nowhere'"
    assert found.flops is None


def test_a_scene_that_was_not_generated_is_listed_as_not_run(tmp_path) -> None:
    ours = authors(tmp_path / "generated")[0]
    found = entry(ours, FREE_BODY, 1, tmp_path)
    assert found.missing.startswith("not run: no free_body.json; make it with `derive generate")
