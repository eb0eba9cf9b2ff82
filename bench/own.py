"""Our own candidate: the committed C of a scene, called as its JSON file says.

Arguments are matched by the names of their components, so neither the order of arguments nor the
order of states matters here.
"""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from bench.candidate import Candidate, Source, sizes
from bench.problem import Problem

AUTHOR = "ours"
GLUE = """\
#include <string.h>
#include "{header}"
{sizes}
typedef struct {{ {constants}double x[{width}]; }} arguments;
typedef struct {{ double y[{height}]; }} results;

static void load(const double *p, const double *x, arguments *given)
{{
    static const int from[] = {{{takes}}};
    (void)p;
    {setup}
    for (int i = 0; i < {width}; i++) {{
        given->x[i] = x[from[i]];
    }}
}}

static void store(const results *r, double *y)
{{
    static const int from[] = {{{gives}}};
    for (int i = 0; i < OUTPUTS; i++) {{
        y[i] = r->y[from[i]];
    }}
}}

static inline void call(const arguments *given, results *r)
{{
    {symbol}({passed});
}}
"""


def candidate(generated: Path, problem: Problem) -> Candidate:
    """Return the function of ours that solves a problem, from the folder ``generated``.

    Raises LookupError if the scene's files hold no such function, argument or component.
    """
    folder = generated / problem.scene
    file = folder / f"{problem.scene}.json"
    if not file.is_file():
        raise LookupError(f"no {file.name}; make it with `derive generate {problem.scene}`")
    manifest = json.loads(file.read_text(encoding="utf-8"))
    function = _named(manifest["functions"], problem.function)
    names = [manifest["files"]["f64"][kind] for kind in ("source", "header")]
    sources = tuple(Source(n, (folder / n).read_text(encoding="utf-8")) for n in names)
    counted = (names[0], (function["symbols"]["f64"],))
    glue = _glue(problem, manifest, function)
    return Candidate(AUTHOR, problem, sources, glue, counted, rotation(function))


def rotation(function: Mapping[str, Any]) -> str:
    """Return how R depends on q in a function: as its JSON says, else as the lecture writes it."""
    return str(function.get("rotation", "unit"))


def _named(entries: Sequence[Mapping[str, Any]], name: str) -> Mapping[str, Any]:
    for entry in entries:
        if entry["name"] == name:
            return entry
    raise LookupError(f"no function '{name}' among {', '.join(e['name'] for e in entries)}")


def _glue(problem: Problem, manifest: Mapping[str, Any], function: Mapping[str, Any]) -> str:
    inputs = [a for a in function["arguments"] if a["direction"] == "in" and a["type"] != "struct"]
    outputs = [a for a in function["arguments"] if a["direction"] == "out"]
    has_constants = any(a["type"] == "struct" for a in function["arguments"])
    takes = [problem.inputs.index(name) for a in inputs for name in a["components"]]
    made = [name for a in outputs for name in _components(manifest, function, a)]
    wanted = [*problem.outputs, *(f"d({row})/d({column})" for row, column in problem.pattern)]
    return GLUE.format(
        header=manifest["files"]["f64"]["header"],
        sizes=sizes(problem),
        constants=f"{manifest['scene']}_constants_f64 k; " if has_constants else "",
        setup=_setup(problem, manifest) if has_constants else "",
        width=len(takes),
        height=len(made),
        takes=", ".join(map(str, takes)),
        gives=", ".join(str(_place(made, name)) for name in wanted),
        symbol=function["symbols"]["f64"],
        passed=", ".join(_passed(function["arguments"])),
    )


def _components(
    manifest: Mapping[str, Any], function: Mapping[str, Any], argument: Mapping[str, Any]
) -> Sequence[str]:
    """Return the names of an output's components; a whole Jacobian is told by its sparse one."""
    of = function.get("same_as")
    if of is None or argument["name"] != "jacobian":
        return tuple(argument["components"])
    pattern = _named(manifest["functions"], of)["sparsity"]["jacobian"]
    return [f"d({row})/d({column})" for column in pattern["columns"] for row in pattern["rows"]]


def _place(made: Sequence[str], name: str) -> int:
    if name not in made:
        raise LookupError(f"no output '{name}' among {', '.join(made)}")
    return made.index(name)


def _setup(problem: Problem, manifest: Mapping[str, Any]) -> str:
    """Return the C statement that makes the constants of a row's parameters."""
    setup = _named(manifest["functions"], "setup")
    given = [a["name"] for a in setup["arguments"] if a["direction"] == "in"]
    passed = ", ".join(f"p[{problem.parameters.index(name)}]" for name in given)
    return f"(void){setup['symbols']['f64']}({passed}, &given->k);"


def _passed(arguments: Sequence[Mapping[str, Any]]) -> list[str]:
    """Return the C arguments of the hot call, in its order."""
    texts, read, written = [], 0, 0
    for argument in arguments:
        if argument["type"] == "struct":
            texts.append("&given->k")
        elif argument["direction"] == "out":
            texts.append(f"r->y + {written}")
            written += len(argument["components"])
        else:
            array = argument["type"] == "array"
            texts.append(f"given->x + {read}" if array else f"given->x[{read}]")
            read += len(argument["components"])
    return texts
