"""``python -m bench.on_target``: a step on a Cortex-M4F, ours and CasADi's C, in one run.

Both get the same constants, in float, and are called by the harness of `derive check --target`;
what it takes to fill CasADi's arrays of pointers is measured on an empty function and taken off.
That both are one step is shown by the ends of a thousand, in double.
"""

import tempfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

import derive
from derive.check.target import tried_on
from derive.check.target.core import CORES, require_tools
from derive.emit.c.source import c_files
from derive.emit.on_target import Cost
from derive.library.library import Library, library
from derive.scene import load

SCENE = "satellite"
CORE = replace(
    CORES["m4f"],
    flags=(*CORES["m4f"].flags, "-fsingle-precision-constant"),
)
"""With what keeps CasADi's constants and roots in float; ours has no other, and is not changed."""
QUIET = "#pragma GCC system_header\n#include <math.h>\n#define sqrt sqrtf\n"
END = "\n}\n"
STEPS = 1000
KINDS = {"step_rk4": "step", "step_rk4_jacobian": "both"}
INPUTS = {"k": 6, "q": 4, "w": 3, "moment": 3, "h": 1}
CONSTANTS = ("one_over_I_xx", "one_over_I_yy", "one_over_I_zz", "k1", "k2", "k3")
CALL = """\
{{
    const float k[6] = {{{constants}}};
    const float *arg[5] = {{k, attitude, omega, moment, &time_step}};
    float *res[3] = {{attitude_next, omega_next{more}}};
    (void){name}(arg, res, 0, 0, 0);
}}
"""


@dataclass(frozen=True)
class Row:
    """What one author's function takes on the core: instructions at most, bytes."""

    author: str
    function: str
    instructions: int
    code: int
    stack: int


def rate(k: Any, q: Any, w: Any, moment: Any) -> Any:
    """Return the rates of an attitude and of omega, columns of CasADi (7,)."""
    import casadi as ca

    spin = ca.vertcat(
        k[0] * moment[0] + k[3] * w[1] * w[2],
        k[1] * moment[1] - k[4] * w[0] * w[2],
        k[2] * moment[2] + k[5] * w[0] * w[1],
    )
    turn = ca.vertcat(-ca.dot(q[1:], w), q[0] * w + ca.cross(q[1:], w)) / 2
    return ca.vertcat(turn, spin)


def functions() -> dict[str, Any]:
    """Return CasADi's step, and the step with its Jacobian by attitude, omega and moment."""
    import casadi as ca

    k, q, w, moment, h = given = [ca.SX.sym(name, size) for name, size in INPUTS.items()]
    start, parts = ca.vertcat(q, w), []
    x = start
    for part in (h / 2, h / 2, h):
        parts.append(rate(k, x[:4], x[4:], moment))
        x = start + part * parts[-1]
    parts.append(rate(k, x[:4], x[4:], moment))
    x = start + h / 6 * (parts[0] + 2 * parts[1] + 2 * parts[2] + parts[3])
    ends = [x[:4] / ca.norm_2(x[:4]), x[4:]]
    whole = ca.jacobian(ca.vertcat(*ends), ca.vertcat(q, w, moment))
    return {
        "step": ca.Function("step", given, ca.cse(ends)),
        "both": ca.Function("both", given, ca.cse([*ends, whole])),
    }


def text_of(function: Any) -> str:
    """Return CasADi's C of a function, in float."""
    import casadi as ca

    with tempfile.TemporaryDirectory() as folder:
        options = {"casadi_real": "float", "casadi_int": "int"}
        generator = ca.CodeGenerator("own.c", options)
        generator.add(function)
        generator.generate(f"{folder}/")
        return Path(folder, "own.c").read_text(encoding="utf-8")


def with_casadis(texts: Mapping[str, str], kind: str, theirs: str) -> dict[str, str]:
    """Return a scene's C with the body of one function replaced by a call of CasADi's."""
    name, short = f"{SCENE}_f32.c", KINDS[kind]
    body = CALL.format(
        name=short,
        constants=", ".join(f"constants->{c}" for c in CONSTANTS),
        more=", jacobian" if short == "both" else "",
    )
    head, told, rest = texts[name].partition(f"\nvoid {SCENE}_{kind}_f32(")
    arguments, _, left = rest.partition("\n{\n")
    text = f"{head}{told}{arguments}\n{body}{left.partition(f'{END}')[2]}"
    return {**texts, name: f'#include "own.inc"\n{text}', "own.inc": f"{QUIET}{theirs}"}


def emptied(theirs: str) -> str:
    """Return CasADi's C of which the function looks at its arrays and does nothing."""
    head, told, rest = theirs.partition("int* iw, casadi_real* w, int mem) {\n")
    looks = '  __asm__ volatile("" : : "r"(arg), "r"(res) : "memory");\n  return 0;'
    return f"{head}{told}{looks}{END}{rest.partition(END)[2]}"


def rows() -> Iterator[Row]:
    """Yield what ours and CasADi's take of the core, function by function."""
    made, ours = library(load(SCENE)), functions()
    own, texts = _costs(made, None), c_files(made, ())
    for kind, short in KINDS.items():
        theirs = text_of(ours[short])
        full = _costs(made, with_casadis(texts, kind, theirs))[kind]
        none = _costs(made, with_casadis(texts, kind, emptied(theirs)))[kind]
        yield Row("ours", kind, own[kind].instructions[1], own[kind].code, own[kind].stack)
        taken = full.instructions[1] - none.instructions[1]
        yield Row("CasADi", kind, taken, full.code - none.code, full.stack)


def _costs(made: Library, sources: Mapping[str, str] | None) -> dict[str, Cost]:
    return {row.function: row.cost for row in tried_on(made, CORE, sources) if row.cost}


def apart(steps: int) -> float:
    """Return by how much the ends of CasADi's step differ from ours at most, in double."""
    step, ours = functions()["step"], derive.load(SCENE).function("step_rk4")
    dice = np.random.Generator(np.random.Philox(1))
    found = 0.0
    for _ in range(steps):
        moments, w, moment = (
            dice.uniform(low, high, 3) for low, high in ((1.5, 1.6), (-9, 9), (-9, 9))
        )
        q = dice.normal(size=4)
        q /= np.linalg.norm(q)
        x, y, z = moments
        k = [*(1 / moments), (y - z) / x, (x - z) / y, (x - y) / z]
        theirs = np.concatenate([np.array(part).ravel() for part in step(k, q, w, moment, 0.01)])
        named = dict(zip(("I_xx", "I_yy", "I_zz"), moments, strict=True))
        mine = ours(**named, attitude=q, omega=w, moment=moment, time_step=0.01)
        found = max(found, float(np.abs(np.concatenate(list(mine)) - theirs).max()))
    return found


def main() -> None:
    """Print the table."""
    require_tools([CORE])
    print("| function, float, Cortex-M4F, -O2 | by | instructions | code | stack | of CasADi's |")
    print("|---|---|---|---|---|---|")
    found = list(rows())
    for row, other in zip(found, (found[n // 2 * 2 + 1] for n in range(len(found))), strict=True):
        taken, part = row.instructions, row.instructions / other.instructions
        told = f"{row.author} | {taken} | {row.code} | {row.stack} | {part:.2f}"
        print(f"| `{row.function}` | {told} |")
    print(f"\nthe ends of {STEPS} steps in double differ by {apart(STEPS):.1e} at most")


if __name__ == "__main__":
    main()
