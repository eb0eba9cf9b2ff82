"""Compiled steps that CasADi calls: its own derivatives and patterns."""

import re
import shutil
from contextlib import suppress
from pathlib import Path
from types import ModuleType
from typing import Any

import casadi as ca
import numpy as np
import pytest

from derive.check.compiler import CompilerError, find_compiler
from derive.check.emitted import Files
from derive.check.external import built, compiled_steps, of_module
from derive.emit.c.external import OPTION
from derive.emit.c.source import c_files
from derive.emit.casadi_module import imported
from derive.emit.casadi_text import casadi_file
from derive.emit.files import scene_files
from derive.library.external import derivatives_of_step
from derive.library.library import Library, library
from derive.program.precision import F64
from derive.scene import SceneError, parse_scene
from derive.verify.draw import with_motion
from derive.verify.sample import samples
from tests.check.craft import LINES, OPERATIONS, drawn, made, text_of, texts
from tests.made import text_of as scene_text
from tests.made import thinned


def judged(kind: str, module: ModuleType, workshop: Path, found: dict[str, str]) -> str:
    at = (workshop, find_compiler())
    return compiled_steps(made(kind), Files(found, "memory"), module, drawn(kind), at).outcome


@pytest.mark.long
def test_values_derivatives_and_patterns_are_those_of_casadi(
    module: ModuleType, workshop: Path
) -> None:
    assert judged("principal", module, workshop, texts("principal")) == "holds"


@pytest.mark.long
def test_so_are_those_of_a_full_tensor(workshop: Path) -> None:
    own = imported("craft_casadi", texts("general")["craft_casadi.py"], workshop)
    assert judged("general", own, workshop, texts("general")) == "holds"


@pytest.mark.long
@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("hessian[44] = ", "hessian[44] = 1e-9 + "),
        ("put(res[1], entries, &x_u", "put(res[1], entries, &u_x"),
        ("pattern(made, &xn_u)", "pattern(made, &u_adj)"),
        ("put_below(res[2], entries, &xn_time_step", "put_below(res[2], entries, &x_adj"),
        ("put_sum(res[14], ", "put_below(res[14], "),
        ("put_sum(res[21], ", "put_below(res[21], "),
        ("change[c] = 0.0;", ""),
        ("res[0] + NX * k", "res[0] + NX * (STEPS - 1 - k)"),
    ],
)
def test_mutants_of_the_c_are_found(module: ModuleType, workshop: Path, old: str, new: str) -> None:
    found = dict(texts("principal"))
    assert old in found["craft_external.c"]
    found["craft_external.c"] = found["craft_external.c"].replace(old, new)
    with suppress(RuntimeError):  # CasADi refuses a pattern of another size
        assert judged("principal", module, workshop, found) == "FAILS"


@pytest.mark.long
def test_names_and_their_order_are_those_that_casadi_gives(
    module: ModuleType, cache_of_three: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(cache_of_three))
    own = module.external(3)
    given = [ca.SX.sym(own.name_in(k), own.sparsity_in(k)) for k in range(4)]
    results = of_module(module, 3).call(given)
    twin = ca.Function("twin", given, results, own.name_in(), ["xn"])
    pairs = [(own, twin), (own.jacobian(), twin.jacobian())]
    pairs += [(own.reverse(1), twin.reverse(1))]
    pairs += [(own.reverse(1).jacobian(), twin.reverse(1).jacobian())]
    for ours, theirs in pairs:
        assert ours.name_in() == theirs.name_in()
        assert ours.name_out() == theirs.name_out()
        assert [ours.size_in(k) for k in range(ours.n_in())] == [
            theirs.size_in(k) for k in range(theirs.n_in())
        ]


@pytest.mark.long
def test_the_wrapper_is_short_and_the_second_derivatives_cost_little() -> None:
    for kind in ("principal", "general"):
        assert len(texts(kind)["craft_external.c"].splitlines()) < LINES
        lower = derivatives_of_step(made(kind)).lower
        assert lower is not None
        assert lower.flops() < OPERATIONS


@pytest.mark.long
def test_without_the_option_files_are_what_they_were() -> None:
    given = made("principal")
    usual = scene_files(given, ())
    wider = scene_files(given, (), of=derivatives_of_step(given))
    differ = {name for name in wider if wider[name] != usual.get(name)}
    assert differ == {"craft/craft_external.c", "craft/craft_casadi.py"}
    assert OPTION in wider["craft/craft_casadi.py"].splitlines()[0]
    assert usual["craft/craft_casadi.py"] == casadi_file(given)
    assert usual["craft/craft_f64.c"] == c_files(given, ())["craft_f64.c"]


@pytest.mark.long
def test_a_compiler_that_fuses_products_with_sums_is_told_not_to(
    module: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if shutil.which("clang") is None:
        pytest.skip("clang, which fuses where the machine can, is not here")
    found = list[Any]()
    for compiler in ("gcc", "clang -march=native"):
        monkeypatch.setenv("CC", compiler)
        monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
        bent = module.external(1).reverse(1).jacobian()
        dice = np.random.default_rng(1)
        given: list[Any] = [dice.normal(size=bent.size_in(k)) for k in range(bent.n_in())]
        given[3] = [1.4, 1.6, 1.8]
        found.append([np.array(ca.DM(one)) for one in bent(*given)])
    assert all(np.array_equal(a, b) for a, b in zip(*found, strict=True))


@pytest.mark.long
def test_many_threads_share_nothing(
    module: ModuleType, cache_of_three: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(cache_of_three))
    own, count = module.external(3), 64
    dice = np.random.default_rng(1)
    given = (dice.normal(size=(7, 3 * count)), dice.normal(size=(3, 3 * count)))
    rest = (np.full((1, count), 0.01), np.tile([[1.4], [1.6], [1.8]], count))
    jacobian = own.jacobian()
    for function, more in ((own, ()), (jacobian, (ca.DM(7, 3 * count),))):
        alone, threads = (
            function.map(count, *how)(*given, *rest, *more) for how in ((), ("thread", 4))
        )
        first = (x if isinstance(x, tuple) else (x,) for x in (alone, threads))
        for a, b in zip(*first, strict=True):
            same = np.array_equal(np.array(ca.DM(a)), np.array(ca.DM(b)), equal_nan=True)
            assert same


@pytest.mark.long
def test_parameters_that_no_body_has_give_nan_everywhere(
    module: ModuleType, cache_of_three: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(cache_of_three))
    own, given = module.external(3), (np.ones((7, 3)), 0, 0.1, [-1, 1, 1])
    assert np.isnan(np.array(own(*given))[4:]).all()
    *_, by_step, by_parameters = own.jacobian()(*given, 0)
    assert np.isnan(np.array(by_step)).any()
    assert np.isnan(np.array(by_parameters)).any()


@pytest.mark.long
def test_derivatives_that_nobody_asks_for_are_not_computed(
    module: ModuleType, workshop: Path
) -> None:
    found = dict(texts("principal"))
    for spoilt in ("by_length", "by_parameters"):
        found["craft_external.c"] = found["craft_external.c"].replace(
            f"    if ({spoilt}) {{", f"    if ({spoilt}) {{ entries[0] = NAN;"
        )
    steps = ca.external("craft_steps", str(built("craft", found, 2, (workshop, find_compiler()))))
    x, u, h = ca.MX.sym("x", 7, 2), ca.MX.sym("u", 3, 2), ca.MX.sym("h")
    xn = steps(x, u, h, [1.4, 1.6, 1.8])
    for by, finite in ((ca.veccat(x, u), True), (ca.veccat(x, u, h), False)):
        first, second = ca.jacobian(ca.vec(xn), by), ca.hessian(ca.sumsqr(xn), by)[0]
        function = ca.Function("both", [x, u, h], [first, second])
        results = function(np.full((7, 2), 0.4), 0.1, 0.1)
        assert all(np.isfinite(np.array(r)).all() == finite for r in map(ca.DM, results))


@pytest.mark.long
def test_integers_of_32_bits_do_not_compile(workshop: Path) -> None:
    found, old = dict(texts("principal")), "typedef long long int casadi_int"
    assert old in found["craft_external.c"]
    found["craft_external.c"] = found["craft_external.c"].replace(old, "typedef int casadi_int")
    with pytest.raises(CompilerError, match="craft_steps_needs_long_integers"):
        built("craft", found, 2, (workshop, find_compiler()))


@pytest.mark.long
def test_neither_does_the_float_build_nor_a_double_that_is_none(workshop: Path) -> None:
    found = dict(texts("principal"))
    floats = found | {f"craft_f64.{end}": found[f"craft_f32.{end}"] for end in "ch"}
    with pytest.raises(CompilerError, match="craft_constants_f64"):
        built("craft", floats, 2, (workshop, find_compiler()))
    found["craft_external.c"] = f"#define double float\n{found['craft_external.c']}"
    with pytest.raises(CompilerError, match=r"float|craft_steps_needs_doubles"):
        built("craft", found, 2, (workshop, find_compiler()))


@pytest.mark.parametrize(
    ("wanted", "more", "says"),
    [
        ('["step_lie"]', "", "needs 'step_rk4_unit' or 'step_rk4' in wanted, and neither is there"),
        ('["step_rk4_unit"]', "", "needs 'step_rk4_unit_jacobian' in wanted"),
        ('["step_rk4", "step_rk4_jacobian"]', 'form = "accurate"', "needs form = 'fast'"),
        ('["step_rk4", "step_rk4_jacobian"]', 'emission = "compact"', "needs emission = 'fast'"),
    ],
)
def test_a_scene_without_the_step_is_refused_by_a_sentence(
    wanted: str, more: str, says: str
) -> None:
    text = f"{more}\n{text_of('principal', wanted)}"
    with pytest.raises(SceneError, match=says):
        derivatives_of_step(library(parse_scene(text, "craft")))


OTHERS = {
    "heavy_body": "attitude",
    "reaction_wheel_satellite": "wheels",
    "cart_pendulum": "machine",
}
OTHERS |= {"heavy_top": "Euler angles", "gyrostat": "wheels and moments", "rigid_body": "position"}


@pytest.mark.long
@pytest.mark.parametrize("name", thinned(OTHERS, 4))
def test_steps_of_any_rates_have_casadis_derivatives(name: str, workshop: Path) -> None:
    """Where no structure helps, second derivatives are carried along one change after another."""
    wanted = 'wanted = ["step_rk4", "step_rk4_jacobian"]'
    text = re.sub(r"wanted = \[.*?\]", wanted, scene_text(name), count=1, flags=re.DOTALL)
    own = library(parse_scene(text, name))
    every = scene_files(own, (), of=derivatives_of_step(own))
    found = {path.partition("/")[2]: text for path, text in every.items()}
    module = imported(f"{name}_casadi", found[f"{name}_casadi.py"], workshop)
    each = with_motion(own, samples(own.mechanism, F64, 3, 0).each, F64)
    at = (workshop, find_compiler())
    told = compiled_steps(own, Files(found, "memory"), module, each, at)
    assert told.outcome == "holds", told
    spoilt = found | {f"{name}_external.c": re.sub(
        r"entries\[1\] = ", "entries[1] = 1e-6 + ", found[f"{name}_external.c"]
    )}  # fmt: skip
    told = compiled_steps(own, Files(spoilt, "memory"), module, each, at)
    assert told.outcome == "FAILS"


FREE = """
wanted = ["step_rk4_unit", "step_rk4_unit_jacobian"]
axes   = { attitude = "quaternion" }
body   = { kind = "axisymmetric", axis = "z", axial = 1.5, transverse = 1 }
[known]
angular_velocity = { range = [-1, 1] }
moment           = { range = [-3, 3] }
"""


@pytest.mark.long
def test_a_scene_without_parameters_is_compiled_too(workshop: Path) -> None:
    assert judged_alone(library(parse_scene(FREE, "free")), workshop) == "holds"


def judged_alone(own: Library, workshop: Path) -> str:
    name = own.scene.name
    every = scene_files(own, (), of=derivatives_of_step(own))
    found = {path.partition("/")[2]: text for path, text in every.items()}
    module = imported(f"{name}_casadi", found[f"{name}_casadi.py"], workshop)
    each = with_motion(own, samples(own.mechanism, F64, 3, 0).each, F64)
    at = (workshop, find_compiler())
    return compiled_steps(own, Files(found, "memory"), module, each, at).outcome
