"""C that lets the driver call our steppers, written from a scene's manifest and nothing else.

State is what a function takes and gives back as ``<name>_next``; it is overwritten in place. What a
``plan_<stepper>`` gives is worked out once a motion. A stepper that proposes its next step is also
run with the steps it proposes; ``flow_exact`` is called from the start each time.
"""

from collections.abc import Mapping, Sequence
from typing import Any

from bench.motion.runner import REAL

Manifest = Mapping[str, Any]
Function = Mapping[str, Any]
NEXT, ADAPTIVE = "_next", "_adaptive"
DERIVATIVES = ("_jacobian", "_tangent", "_sensitivity", "_dense")
CARRIED = "carried"
STEPS, PROPOSED = ("time_step", "time"), "step_proposed"

FILE = """\
#include "methods.h"
#include "{header}"
#include <math.h>

{constants}static real time_step, step_proposed;
static double left, tolerance;
{arrays}
static int prepare(const double *p)
{{
    (void)p;
    {prepare}
}}

static void place(const double *given, double step, double duration)
{{
    for (int i = 0; i < 4; i++) {{
        attitude[i] = (real)given[i];
    }}
    for (int i = 0; i < 3; i++) {{
        omega[i] = (real)given[4 + i];
    }}
    time_step = (real)step;
    tolerance = step;
    left = duration;
{zeros}}}

static void states(double *to)
{{
    for (int i = 0; i < 4; i++) {{
        to[i] = (double)attitude[i];
    }}
    for (int i = 0; i < 3; i++) {{
        to[4 + i] = (double)omega[i];
    }}
}}
{functions}
const method methods[] = {{
{table}
}};
"""

FIXED = """
static void start_{name}(const double *given, double step, double duration)
{{
    place(given, step, duration);{plan}
}}

static long go_{name}(long steps)
{{
    for (long n = 0; n < steps; n++) {{
        {call}
    }}
    return steps;
}}
"""

FLOW = """
static void state_{name}(double *to)
{{
    for (int i = 0; i < 4; i++) {{
        to[i] = (double)attitude_next[i];
    }}
    for (int i = 0; i < 3; i++) {{
        to[4 + i] = (double)omega_next[i];
    }}
}}
"""

BY_PROPOSAL = """
/* What is proposed is for an error of one unit roundoff: a tolerance e allows (e/u)^(1/order). */
static long go_{name}_adaptive(long unused)
{{
    const double factor = pow(tolerance / {roundoff}, {root});
    const double x = (double)omega[0], y = (double)omega[1], z = (double)omega[2];
    double next = 0.1 / sqrt(x * x + y * y + z * z);
    long passes = 0;
    (void)unused;
    while (left > 0 && passes < 100000000L) {{
        time_step = (real)(next < left ? next : left);
        {call}
        left = (double)time_step < left ? left - (double)time_step : 0;
        next = factor * (double)step_proposed;
        passes++;
    }}
    return passes;
}}
"""


def movers(manifest: Manifest) -> list[str]:
    """Return the functions that move attitude and omega, as the driver's methods in order."""
    found = []
    for function in manifest["functions"]:
        name = function["name"]
        if name.startswith(("step_", "flow_")) and not name.endswith(DERIVATIVES):
            found += [name, name + ADAPTIVE] if PROPOSED in _names(function, "out") else [name]
    return found


def glue(manifest: Manifest, precision: str) -> str:
    """Return the text of ``methods.c``: a table of all methods in the order of ``movers``."""
    moving = [_named(manifest, name) for name in movers(manifest) if not name.endswith(ADAPTIVE)]
    rows, texts = [], []
    for function in moving:
        name = function["name"]
        state = f"state_{name}" if name.startswith("flow_") else "states"
        rows.append(f"    {{prepare, start_{name}, go_{name}, {state}}},")
        texts.append(_method(manifest, function, precision))
        if PROPOSED in _names(function, "out"):
            rows.append(f"    {{prepare, start_{name}, go_{name}_adaptive, states}},")
    arrays = _arrays(moving)
    zeros = [name for name in arrays if name == CARRIED]
    return FILE.format(
        header=manifest["files"][precision]["header"],
        constants=_constants(manifest, precision),
        arrays="".join(f"static real {name}[{size}];\n" for name, size in arrays.items()),
        prepare=_prepare(manifest, precision),
        zeros="".join(_zeroed(name, arrays[name]) for name in zeros),
        functions="".join(texts),
        table="\n".join(rows),
    )


def _method(manifest: Manifest, function: Function, precision: str) -> str:
    name = function["name"]
    flow = name.startswith("flow_")
    call = _call(function, precision, aside=flow)
    text = FIXED.format(name=name, plan=_plan(manifest, function, precision), call=call)
    if flow:
        text += FLOW.format(name=name)
    if PROPOSED in _names(function, "out"):
        order = int(name.removeprefix("step_taylor") or 20)
        roundoff = "0x1p-24" if precision == "f32" else "0x1p-53"
        text += BY_PROPOSAL.format(name=name, roundoff=roundoff, root=f"1.0 / {order}", call=call)
    return text


def _call(function: Function, precision: str, *, aside: bool) -> str:
    """Return the statement that calls a function; ``aside``: its states are not overwritten."""
    inputs = _names(function, "in")
    passed = []
    for argument in function["arguments"]:
        name = argument["name"]
        base = name.removesuffix(NEXT)
        if argument["type"] == "struct":
            passed.append("&constants")
        elif argument["direction"] == "out":
            own = _variable(name if aside or base not in inputs else base)
            passed.append(own if argument["type"] == "array" else f"&{own}")
        else:
            passed.append("time_step" if name in STEPS else _variable(name))
    return f"{function['symbols'][precision]}({', '.join(passed)});"


def _plan(manifest: Manifest, function: Function, precision: str) -> str:
    """Return the call that works out a stepper's plan, nothing if it has none."""
    base = function["name"].removeprefix("step_")
    plans = [f for f in manifest["functions"] if f["name"] == f"plan_{base}"]
    return "".join(f"\n    {_call(plan, precision, aside=True)}" for plan in plans)


def _arrays(functions: Sequence[Function]) -> dict[str, int]:
    """Return the arrays that the calls need, with their lengths."""
    found = {"attitude": 4, "omega": 3, "attitude_next": 4, "omega_next": 3}
    for function in functions:
        for argument in function["arguments"]:
            if argument["type"] == "array":
                found.setdefault(_variable(argument["name"]), len(argument["components"]))
    return found


def _variable(name: str) -> str:
    """Return what a variable of the glue is called; math.h has a function called remainder."""
    return CARRIED if name == "remainder" else name


def _constants(manifest: Manifest, precision: str) -> str:
    if not manifest["constants"]:
        return ""
    return f"static {manifest['scene']}_constants_{precision} constants;\n"


def _prepare(manifest: Manifest, precision: str) -> str:
    if not manifest["constants"]:
        return "return 0;"
    setup = _named(manifest, "setup")
    parameters = [q["name"] for q in manifest["parameters"]]
    given = [f"({REAL[precision]})p[{parameters.index(name)}]" for name in _names(setup, "in")]
    return f"return {setup['symbols'][precision]}({', '.join([*given, '&constants'])});"


def _zeroed(name: str, size: int) -> str:
    return f"    for (int i = 0; i < {size}; i++) {{\n        {name}[i] = 0;\n    }}\n"


def _names(function: Function, direction: str) -> list[str]:
    return [a["name"] for a in function["arguments"] if a["direction"] == direction]


def _named(manifest: Manifest, name: str) -> Function:
    found: Function = next(f for f in manifest["functions"] if f["name"] == name)
    return found
