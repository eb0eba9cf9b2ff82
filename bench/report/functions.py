"""What every emitted function costs and how wrong it is, by the manifests in ``generated/``.

Operations and errors stand in the JSON of a scene; instructions are counted here, by callgrind, on
one call with inputs from the middle of their ranges.
"""

import json
import re
import shutil
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from bench.build import BuildError, run
from bench.callgrind import total
from bench.motion.runner import FLAGS, REAL

CALLS = 8
MARK = re.compile(r"^desc: Trigger: Client Request: (\w+)$", re.MULTILINE)
Manifest = Mapping[str, Any]

MAIN = """\
#include <stdio.h>
#include <valgrind/callgrind.h>
#include "{header}"

typedef {real} real;
{variables}

int main(void)
{{
{calls}
    return 0;
}}
"""


@dataclass(frozen=True)
class Function:
    """One emitted function.

    instructions : of a call, by precision     median, largest : errors in u, by precision; the
        largest over outputs
    """

    scene: str
    name: str
    flops: int
    divisions: int
    instructions: Mapping[str, float]
    median: Mapping[str, float]
    largest: Mapping[str, float]


def functions(generated: Path, folder: Path) -> list[Function]:
    """Return every function of every scene below ``generated``."""
    return [f for path in sorted(generated.glob("*/*.json")) for f in _scene(path, folder)]


def _scene(path: Path, folder: Path) -> list[Function]:
    manifest = json.loads(path.read_text(encoding="utf-8"))
    counts = {p: _counts(manifest, path.parent, p, folder) for p in REAL}
    return [
        _function(manifest["scene"], f, {p: c[f["name"]] for p, c in counts.items() if c})
        for f in manifest["functions"]
        if _stands_for_itself(f)
    ]


def _stands_for_itself(function: Mapping[str, Any]) -> bool:
    return function["name"] != "setup" and "same_as" not in function


def _function(scene: str, f: Mapping[str, Any], counts: Mapping[str, float]) -> Function:
    errors = {p: list(f["error"][p].values()) for p in REAL if p in f["error"]}
    cost = f["cost"]
    return Function(
        scene,
        f["name"],
        cost["flops"],
        cost.get("div", 0),
        counts,
        {p: max(e["median_ulp"] for e in own) for p, own in errors.items()},
        {p: max(e["largest_ulp"] for e in own) for p, own in errors.items()},
    )


def _counts(manifest: Manifest, scene: Path, precision: str, folder: Path) -> dict[str, float]:
    """Return the instructions of one call of each function, nothing without valgrind."""
    if not shutil.which("valgrind"):
        return {}
    place = folder / f"{manifest['scene']}_{precision}_calls"
    place.mkdir(parents=True, exist_ok=True)
    source = place / "main.c"
    source.write_text(_main(manifest, precision), encoding="utf-8")
    own = scene / manifest["files"][precision]["source"]
    program, out = place / "main", place / "callgrind"
    try:
        run(("gcc", *FLAGS, f"-I{scene}", str(source), str(own), "-o", str(program), "-lm"))
        tool = ("valgrind", "--tool=callgrind", "-q", f"--callgrind-out-file={out}")
        run((*tool, str(program)))
    except (BuildError, FileNotFoundError):
        return {}
    texts = [p.read_text(encoding="utf-8") for p in place.glob("callgrind.*")]
    found = {MARK.findall(text)[-1]: total(text) / CALLS for text in texts if MARK.search(text)}
    return {name: round(count, 1) for name, count in found.items()}


def _main(manifest: Manifest, precision: str) -> str:
    """Return a program that calls each function, with marks around the calls."""
    variables, calls = list(_variables(manifest, precision)), []
    for f in manifest["functions"]:
        if f["name"] == "setup":
            calls.append(f"    {_call(f, precision)}")
        elif _stands_for_itself(f):
            calls += [
                f"    {_call(f, precision)}",  # the first call also looks up libm
                "    CALLGRIND_ZERO_STATS;",
                f"    for (int i = 0; i < {CALLS}; i++) {{ {_call(f, precision)} }}",
                f'    CALLGRIND_DUMP_STATS_AT("{f["name"]}");',
            ]
    return MAIN.format(
        header=manifest["files"][precision]["header"],
        real=REAL[precision],
        variables="\n".join(variables),
        calls="\n".join(calls),
    )


def _variables(manifest: Manifest, precision: str) -> Iterator[str]:
    """Yield a variable for each argument of each function, filled if it is an input."""
    for f in manifest["functions"]:
        for a in f["arguments"]:
            name = _variable(f, a)
            if a["type"] == "struct":
                continue
            values = _values(a)
            filled = ", ".join(repr(v) for v in values)
            yield f"static real {name}[{len(values)}] = {{{filled}}};"
    if manifest["constants"]:
        yield f"static {manifest['scene']}_constants_{precision} constants;"


def _values(argument: Mapping[str, Any]) -> list[float]:
    count = len(argument["components"]) or 1
    if argument["direction"] == "out":
        return [0.0] * max(count, _size(argument["shape"]))
    if argument["name"].startswith("attitude") and count == len(UNIT):
        return list(UNIT)
    low, high = argument["range"] or (-1.0, 1.0)
    return [low + (high - low) * (0.55 + 0.3 * n / count) for n in range(count)]


UNIT = (0.5, -0.5, 0.5, 0.5)


def _size(shape: Sequence[int]) -> int:
    size = 1
    for n in shape:
        size *= n
    return size


def _variable(function: Mapping[str, Any], argument: Mapping[str, Any]) -> str:
    if argument["type"] == "struct":
        return "constants"
    return f"{function['name']}_{argument['direction']}_{argument['name']}"


def _call(function: Mapping[str, Any], precision: str) -> str:
    passed = []
    for a in function["arguments"]:
        name = _variable(function, a)
        scalar, struct = a["type"] == "scalar", a["type"] == "struct"
        passed.append(f"&{name}" if struct else f"{name}[0]" if scalar else name)
    return f"{function['symbols'][precision]}({', '.join(passed)});"
