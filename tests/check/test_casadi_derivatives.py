"""CasADi's derivatives are those of the programs, or no numbers; a wrong one is noticed."""

from dataclasses import replace
from fractions import Fraction
from functools import cache
from pathlib import Path
from tempfile import mkdtemp
from types import ModuleType

import pytest

from derive.check.derivatives import compared, derivatives
from derive.emit.casadi_module import imported
from derive.emit.casadi_text import casadi_file
from derive.library.library import Library, library
from derive.program.precision import F64
from derive.program.program import Op
from derive.scene import load
from derive.verify.draw import with_motion
from derive.verify.sample import Sample, samples

SCENES = ("attitude", "t_handle_flip", "tumbling_disc")
"""`derive check` tries those of the whole catalogue."""


@cache
def made(scene: str) -> tuple[Library, ModuleType, Sample]:
    found = library(load(scene))
    module = imported(f"{scene}_casadi", casadi_file(found), Path(mkdtemp()))
    each = with_motion(found, samples(found.mechanism, F64, 2, 0).each, F64)
    return found, module, next(s for s in each if s.kind == "ordinary")


def wrong(scene: str) -> list[str]:
    found, module, sample = made(scene)
    verdicts = derivatives(found, module, (sample,))
    return [f"{v.function}: {v.says}" for v in verdicts if v.outcome != "holds"]


@pytest.mark.long
@pytest.mark.parametrize("scene", SCENES)
def test_no_derivative_is_a_wrong_number(scene: str) -> None:
    assert not wrong(scene)


def test_a_slope_that_is_lost_is_noticed() -> None:
    """A rotation vector near zero whose cosine is taken for 1 has no second derivative."""
    found, _, sample = made("attitude")
    program = found["quaternion_exp"]
    place, flat = next(
        (n, op)
        for n, op in enumerate(program.ops)
        if isinstance(op, Op) and op.operator == "select" and op.result == program.results[0]
    )
    spoilt = replace(flat, operands=(flat.operands[0], Fraction(1), flat.operands[2]))
    ops = (*program.ops[:place], spoilt, *program.ops[place + 1 :])
    motions = tuple(replace(p, ops=ops) if p.name == "quaternion_exp" else p for p in found.motions)
    text = casadi_file(replace(found, motions=motions))
    broken = imported("attitude_casadi", text, Path(mkdtemp())).quaternion_exp()
    faults, _ = compared(found, program, broken, (sample,))
    assert any("rotation_vector zero" in fault for fault in faults)
