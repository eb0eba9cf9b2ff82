"""The scene's JSON: all that a program needs to call any of its functions without reading C."""

import hashlib
import json
from collections.abc import Sequence
from typing import Any

from derive import __version__
from derive.emit.c.comment import BOUND_OF_WHAT, SETUP_ERROR, holds, of_what
from derive.emit.c.fixed import fixed_symbol
from derive.emit.c.members_file import OVER_MEMBERS, batch_described
from derive.emit.c.signature import CNames, dense
from derive.emit.c.source import JACOBIAN_DENSE, command
from derive.emit.c.text import pair_functions
from derive.emit.notation import equation_text
from derive.emit.on_target import UNKNOWN, OnTarget, by_core
from derive.emit.packed import packed, scale_of
from derive.lecture.chapters import LECTURE
from derive.library.library import Library
from derive.program.precision import F32, F64, PRECISIONS
from derive.program.program import Measurement, Program, Quantity, Sparsity
from derive.program.status import possible
from derive.scene.wanted import JACOBIAN
from derive.verify.kept import UNDIGESTED, Digests


def manifest(
    library: Library,
    figures: Sequence[Measurement],
    digest: Digests = UNDIGESTED,
    costs: OnTarget = UNKNOWN,
    parts: Sequence[str] = (),
) -> str:
    """Return the text of ``<scene>.json``.

    digest : of what errors and bounds depend on      costs : what functions cost on cores
    parts  : with "batch" functions over members are listed too
    """
    scene = library.scene
    whole = {
        "scene": scene.name,
        "title": scene.title,
        "generator": f"derive {__version__}",
        "command": command(library, figures, [f"--{part}" for part in parts]),
        "source": {
            "file": f"{scene.name}.toml",
            "sha256": hashlib.sha256(scene.text.encode()).hexdigest(),
        },
        "files": _files(scene.name),
        "conventions": {
            "quaternion": "scalar first, Hamilton, body to inertial",
            "products_of_inertia": "I_xy = +sum x y dm",
            "jacobian": "nonzeros in compressed-column order; dense is column-major",
            "aliasing": "outputs but jacobian may lie over inputs",
            "units": "SI, angles in rad",
        },
        "parameters": [_quantity(q) for q in library.vocabulary.parameters],
        "packed": _packed(library),
        "constants": [{"name": c, "formula": f} for c, f in library.constants.items()],
        **_fixed(library),
        "functions": [f | _on_cores(f["name"], costs) for f in _functions(library, figures)],
        **({"batch": batch_described(library)} if OVER_MEMBERS in parts else {}),
        "taken": list(library.mechanism.signs),
        "warnings": list(library.mechanism.doubts()),
        "measured": {"digest": digest.errors, "bounds": digest.bounds},
    }
    return json.dumps(whole, indent=1, ensure_ascii=False) + "\n"


def _fixed(library: Library) -> dict[str, Any]:
    """Return the values of fixed parameters and what C calls their table; nothing if none are."""
    if not library.fixed:
        return {}
    tables = {p.name: fixed_symbol(library, p) for p in PRECISIONS}
    return {"fixed": {"parameters": dict(library.fixed), "symbols": tables}}


def _packed(library: Library) -> dict[str, Any] | None:
    """Return what x and u of the CasADi module hold, and which step moves x; None if neither is."""
    found = packed(library)
    if found is None:
        return None
    x, u = ([_quantity(q) | {"scale": scale_of(q)} for q in each]
            for each in (found.states, found.inputs))  # fmt: skip
    return {"x": x, "u": u, "step": found.step.name if found.step else None}


def _on_cores(function: str, costs: OnTarget) -> dict[str, Any]:
    """Return what a function costs on the cores that it was run on, nothing if on none."""
    own = costs.of(function)
    return {"targets": by_core(own)} if own else {}


def _files(name: str) -> dict[str, Any]:
    names = CNames(name)
    c = {p.name: {"header": names.file(p, "h"), "source": names.file(p, "c")} for p in PRECISIONS}
    return c | {"casadi": f"{name}_casadi.py", "page": f"{name}.html"}


def _quantity(q: Quantity) -> dict[str, Any]:
    bounds = None if q.low is None or q.high is None else [float(q.low), float(q.high)]
    return {
        "name": q.name,
        "shape": list(q.shape),
        "components": list(q.components),
        "unit": q.unit,
        "frame": q.frame,
        "range": bounds,
        "meaning": q.meaning,
    }


def _functions(library: Library, figures: Sequence[Measurement]) -> list[dict[str, Any]]:
    found = [_setup(library)] if library.constants else []
    for program in library.printed():
        found.append(_function(library, program, figures))
        if program.sparsity:
            found.append(_dense(library, program))
    return found


def _symbols(library: Library, function: str, casadi: str | None) -> dict[str, Any]:
    names = CNames(library.scene.name)
    symbols: dict[str, Any] = {p.name: names.symbol(function, p) for p in (F32, F64)}
    return symbols | {"casadi": casadi}


def _argument(q: Quantity, direction: str, alone: str) -> dict[str, Any]:
    """Return an argument; ``alone`` is the type of one that is a single number.

    No range is declared of what a function gives: only of what it is sampled on.
    """
    kind = "struct" if q.role == "constants" else "array" if q.shape else alone
    own = _quantity(q) | ({"range": None} if direction == "out" else {})
    return {"name": q.name, "direction": direction, "type": kind} | own


def _arguments(program: Program) -> list[dict[str, Any]]:
    given = [_argument(q, "in", "scalar") for q in program.inputs]
    return [*given, *(_argument(q, "out", "pointer") for q in program.outputs)]


def _setup(library: Library) -> dict[str, Any]:
    program = library.setup
    cost = {"flops_on_pairs": program.flops(), "pair_operations": pair_functions([program])}
    symbols = _symbols(library, "setup", "setup") | {"casadi_status": "setup_status"}
    if library.fixed:
        symbols |= {p.name: None for p in PRECISIONS}
    return {
        "name": "setup",
        "says": program.says,
        "symbols": symbols,
        "returns": "int: 0, or the first rule that the parameters break; see status",
        "status": {str(number): says for number, says in possible(program).items()},
        "arguments": _arguments(program),
        "cost": cost | program.count,
        "error": SETUP_ERROR,
    }


def _function(library: Library, program: Program, figures: Sequence[Measurement]) -> dict[str, Any]:
    bodies = len(library.scene.bodies)
    return {
        "name": program.name,
        "says": program.says,
        "symbols": _symbols(library, program.name, program.name),
        "returns": "void",
        "arguments": _arguments(program),
        "sparsity": {name: _sparsity(s) for name, s in (program.sparsity or {}).items()},
        "arithmetic": program.arithmetic,
        "cost": {"flops": program.flops()} | program.count,
        "error": _error(program, figures),
        "bounds": _bounds(program, figures),
        "singular": [{"where": s.where, "outputs": list(s.outputs)} for s in program.singular],
        "postconditions": [
            {"step": s, "equation": equation_text(LECTURE[s]), "holds": holds(program, s, bodies)}
            for s in program.steps
        ],
        "assumptions": list(program.assumptions),
    } | _choice(library, program)


def _choice(library: Library, program: Program) -> dict[str, Any]:
    """Return what a function of a machine depends on, and what it was found not to need."""
    base = program.name.removesuffix(JACOBIAN)
    if base not in library.problems:
        return {}
    mechanism = library.mechanism
    return {
        "depends_on": list(mechanism.depends_on(base)),
        "balances": [b.told(library.scene.spoken) for b in mechanism.whole(base).balances],
        "not_needed": {why: list(names) for why, names in mechanism.dropped(base).items()},
    }


def _dense(library: Library, program: Program) -> dict[str, Any]:
    whole = dense(program)
    return {
        "name": whole.name,
        "says": f"{program.says} {JACOBIAN_DENSE}",
        "symbols": _symbols(library, whole.name, None),
        "returns": "void",
        "arguments": _arguments(whole),
        "same_as": program.name,
    }


def _sparsity(s: Sparsity) -> dict[str, Any]:
    return {
        "shape": [len(s.rows), len(s.columns)],
        "rows": list(s.rows),
        "columns": list(s.columns),
        "colind": list(s.colind),
        "row": list(s.row),
    }


def _error(program: Program, figures: Sequence[Measurement]) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for m in figures:
        if m.function == program.name:
            found.setdefault(m.precision, {})[m.output] = {
                "median_ulp": m.median,
                "largest_within_ulp": m.within,
                "largest_ulp": m.worst,
                "worst_sample": m.sample,
                "worst_kind": m.kind,
                "samples": m.samples,
                "searched": m.searched,
                "hard_samples": m.hard,
            }
    return found | {
        "measure": f"ulps {of_what(program)}",
        "kind": "sampled",
    }


def _bounds(program: Program, figures: Sequence[Measurement]) -> dict[str, Any]:
    """Return what is proved of each output beside what was seen, or why it is not."""
    own = [m.bound for m in figures if m.function == program.name and m.bound is not None]
    found: dict[str, Any] = {}
    for b in own:
        row = {"why": b.why} if b.proved is None else {"proved": b.proved, "seen": b.seen}
        found.setdefault(b.precision, {})[b.output] = row
    assumed = dict.fromkeys(words for b in own for words in b.assumed)
    return {"measure": BOUND_OF_WHAT, **found, "assumed": list(assumed)} if own else {}
