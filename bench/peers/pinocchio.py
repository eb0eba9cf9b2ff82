"""Pinocchio's accelerations of a chain of rods, on CasADi's symbols, operations counted.

Its Python package has no functions of symbols, but its headers have: a program of ours is compiled
with them, which takes minutes, and saves each chain's function. Numbers stand for parameters, so
that what depends on these alone is folded; CasADi's ``cse`` shares the rest.
"""

import subprocess
from collections.abc import Callable
from importlib.resources import files
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

MASS, LENGTH, GRAVITY = 1.37, 0.73, 9.81  # kg, m, m/s^2
LIMITS = (
    "-DBOOST_MPL_LIMIT_LIST_SIZE=30",
    "-DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS",
    "-DBOOST_FUSION_INVOKE_MAX_ARITY=12",
)
"""Of Boost's lists, which its kinds of joints pass."""
Chain = Callable[[str], Any]
"""From the axes of a chain's joints its accelerations, CasADi's function of angles and rates."""


def chains(folder: Path) -> Chain:
    """Return Pinocchio's chains, by a program that is compiled in a folder.

    Raises ImportError where Pinocchio is not installed.
    """
    import casadi as ca

    spec = find_spec("pinocchio")
    if spec is None or spec.origin is None:
        raise ImportError("pinocchio is not installed; `pip install pin` brings it")
    own, their = Path(ca.__file__).parent, Path(spec.origin).parents[4] / "include"
    source, program = files("bench") / "peers" / "pinocchio.cpp", folder / "pinocchio"
    heads = [f"-I{place}" for place in (their, own / "include", own / "include" / "eigen3")]
    library = [f"-L{own}", "-lcasadi", f"-Wl,-rpath,{own}"]
    command = ("g++", "-std=c++17", "-w", *LIMITS, *heads, str(source), "-o", str(program))
    subprocess.run([*command, *library], check=True)

    def chain(axes: str) -> Any:
        with TemporaryDirectory() as place:
            file = str(Path(place) / "chain.casadi")
            numbers = [GRAVITY, *(x for k in range(len(axes)) for x in _rod(k))]
            subprocess.run([str(program), axes, *map(repr, numbers), file], check=True)
            found = ca.Function.load(file)
        given = [ca.SX.sym(name, len(axes)) for name in "qv"]
        return ca.Function("chain", given, [ca.cse(found(*given))])

    return chain


def _rod(k: int) -> tuple[float, ...]:
    about = MASS * LENGTH**2 / 12
    hinge = -LENGTH if k else 0.0
    return (0.0, 0.0, hinge, MASS, 0.0, 0.0, -LENGTH / 2, about, about, 0.0, 0.0, 0.0, 0.0)


def operations(function: Any) -> int:
    """Return the ``+ - * /`` of a function of CasADi; signs are free."""
    import casadi as ca

    counted = {ca.OP_ADD, ca.OP_SUB, ca.OP_MUL, ca.OP_DIV, ca.OP_INV, ca.OP_SQ, ca.OP_TWICE}
    return sum(function.instruction_id(k) in counted for k in range(function.n_instructions()))
