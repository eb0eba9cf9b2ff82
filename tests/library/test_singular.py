"""A function's comment warns of the states at which it has no value, and of no others."""

import json
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from itertools import product
from random import Random

import numpy as np
import pytest

from derive.emit.c.comment import comment, singular_clause
from derive.emit.casadi_text import casadi_file
from derive.emit.manifest import manifest
from derive.library.library import Library, library
from derive.library.singular import with_singular
from derive.program.arithmetic import extended, paired, working
from derive.program.program import Op, Operand, Program, Quantity, component_names
from derive.program.run import run
from derive.scene import catalogue, parse_scene
from tests.made import library_of, thinned

Divisor = Callable[[list[str]], tuple[list[Op], Operand]]


def only(lib: Library, program: Program) -> list[str]:
    (found,) = with_singular([replace(program, singular=())], lib.setup)
    return [s.where for s in found.singular]


def times(a: Operand, b: Operand, name: str) -> Op:
    return Op(name, "mul", (a, b))


MADE_UP: dict[str, tuple[str, Divisor, str]] = {
    "an input": ("kinetic_energy", lambda c: ([], c[0]), "omega_x = 0"),
    "a square": ("kinetic_energy", lambda c: ([times(c[1], c[1], "zz")], "zz"), "omega_y = 0"),
    "a norm": (
        "kinetic_energy",
        lambda c: ([*(times(x, x, f"zz{x}") for x in c),
                    Op("zza", "add", (f"zz{c[0]}", f"zz{c[1]}")),
                    Op("zz", "add", ("zza", f"zz{c[2]}"))], "zz"),
        "omega = 0",
    ),
    "a sine": ("state_rate", lambda c: ([Op("zz", "sin", (c[0],))], "zz"), "theta = k pi"),
    "a cosine": ("state_rate", lambda c: ([Op("zz", "cos", (c[0],))], "zz"), "theta = k pi/2"),
    "a difference": (
        "kinetic_energy",
        lambda c: ([Op("zz", "sub", (c[0], Fraction(1, 3)))], "zz"),
        "where a divisor vanishes, as at omega_x = 0.3333",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", MADE_UP)
def test_a_divisor_that_is_put_in_is_told(name: str) -> None:
    function, divisor, where = MADE_UP[name]
    lib = library_of("heavy_top")
    program = lib[function]
    inputs = [c for q in program.inputs if q.role != "constants" for c in q.components]
    more, by = divisor(inputs)
    ops = (*program.ops, *more, Op("zzz", "div", (program.results[0], by)))
    mutant = replace(program, ops=ops, results=("zzz", *program.results[1:]))
    assert only(lib, mutant) == [where]
    assert where not in only(lib, program) or where == "theta = k pi"


def test_what_divides_by_no_input_has_no_line() -> None:
    lib = library_of("heavy_top")
    assert only(lib, lib["kinetic_energy"]) == only(lib, lib["angular_momentum"]) == []
    assert "Singular" not in comment(lib["kinetic_energy"], (), 1)


def test_header_json_and_casadi_say_the_same() -> None:
    lib = library_of("heavy_top")
    bad = "psi_dot, phi_dot, omega_dot_x, omega_dot_y"  # theta_dot and omega_dot_z stay as they are
    says = f"at theta = k pi, {bad} infinite, no number or beyond all measure"
    assert [singular_clause(s) for s in lib["state_rate"].singular] == [says]
    block = comment(lib["state_rate"], (), 1).replace(" * ", "")
    assert f"Singular: {says}." in " ".join(block.split())
    described = {f["name"]: f for f in json.loads(manifest(lib, ()))["functions"]}
    assert described["state_rate"]["singular"] == [
        {"where": "theta = k pi", "outputs": bad.split(", ")}
    ]
    assert described["kinetic_energy"]["singular"] == []
    assert says in casadi_file(lib)


@pytest.mark.long
def test_a_quaternion_of_no_norm_is_told() -> None:
    step = library_of("rigid_body_steps")["step_rk4"]
    assert [s.where for s in step.singular] == ["attitude = 0"]


@pytest.mark.parametrize("name", thinned(catalogue(), 6))
def test_no_function_is_without_a_value_where_its_comment_is_silent(name: str) -> None:
    lib = library_of(name)
    assert [says for program in lib.printed() for says in unsaid(lib, program)] == []


def test_a_comment_that_is_silent_is_found() -> None:
    lib = library_of("heavy_top")
    assert unsaid(lib, replace(lib["state_rate"], singular=())) != []
    told_elsewhere = replace(lib["state_rate"].singular[0], where="psi = 0")
    assert unsaid(lib, replace(lib["state_rate"], singular=(told_elsewhere,))) != []


def unsaid(lib: Library, program: Program) -> list[str]:
    """Return the states at which a function has no value although its comment does not say so."""
    if any(q.role == "plan" for q in program.inputs):
        return []
    constants, found = constants_of(lib), []
    said = " ".join(s.where for s in program.singular)
    named = {o for s in program.singular for o in s.outputs}
    outputs = {c for q in program.outputs for c in q.components if {q.name, c} & named}
    for values, changed in special(program):
        bad = without_value(program, constants | values)
        if not bad <= outputs or (bad and not any(c in said for c in changed)):
            found.append(f"{program.name}: {changed}: {bad}")
    return found


def constants_of(lib: Library) -> dict[str, float]:
    middle = [[float((q.low or 0) + (q.high or 0)) / 2] for q in lib.setup.inputs]
    given = np.array(middle, np.float32)
    made = run(lib.setup, extended(np.float32), paired(given)) if lib.setup.outputs else []
    values = [float(np.ravel(r[0])[0]) for r in made]
    return dict(zip(component_names(lib.setup), values, strict=True))


def special(program: Program) -> list[tuple[dict[str, float], list[str]]]:
    """Return states with one quantity, or two of one component, at 0: found by their own loop."""
    dice = Random(program.name[::-1])
    free = [q for q in program.inputs if q.is_value or q.role == "plan"]
    found = []
    single = [[q] for q in free]
    scalars = [q for q in free if not q.shape]
    both = [list(p) for p in product(scalars, scalars) if p[0] is not p[1]]
    for chosen in [*single, *both]:
        values = {c: drawn(q, dice) for q in free for c in q.components}
        values |= {c: 0.0 for q in chosen for c in q.components}
        found.append((values, [c for q in chosen for c in (q.name, *q.components)]))
    return found


def drawn(q: Quantity, dice: Random) -> float:
    low, high = (float(x) if x is not None else d for x, d in ((q.low, -0.5), (q.high, 0.5)))
    return low + (high - low) * dice.random()


def without_value(program: Program, values: dict[str, float]) -> set[str]:
    given = [np.float32(values.get(c, 0.0)) for q in program.inputs for c in q.components]
    with np.errstate(all="ignore"):
        results = run(program, working(np.float32), [np.array([x]) for x in given])
    names = component_names(program)
    return {c for c, r in zip(names, results, strict=True) if not np.all(np.isfinite(r))}


PULLED = """
title  = "A push along an inertial axis, turned into the body by the attitude"
wanted = ["state_rate", "state_rate_jacobian"]
axes   = { attitude = "quaternion" }
[parameters]
m = { unit = "kg", range = [5, 20], meaning = "mass" }
[inputs]
push = { unit = "N", range = [-1, 1], meaning = "push" }
[body]
kind    = "principal"
mass    = "m"
moments = [1, 2, 3]
[known]
moment = [0, 0, 0]
force  = [
    "push*(1 - 2*(attitude_y^2 + attitude_z^2))",
    "2*push*(attitude_x*attitude_y - attitude_w*attitude_z)",
    "2*push*(attitude_x*attitude_z + attitude_w*attitude_y)",
]
[position]
position = { range = [-100, 100] }
velocity = { range = [-50, 50] }
"""


def test_a_quaternion_keeps_its_norm_where_a_component_is_nothing() -> None:
    """Two rates are nothing but rounding, as long as the norm is 1."""
    lib = library(parse_scene(PULLED, "pulled"))
    assert [only(lib, program) for program in lib.functions] == [[], []]
