"""A name that means something where code is printed is refused, with whose word it is.

The words come from compilers, from Python and from what we print, not from a list made here.
"""

import ast
import builtins
import keyword
import re
import shutil
import subprocess
from pathlib import Path

import pytest

import derive.scene.results
from derive.check.compiler import CompilerError, compiled, find_compiler
from derive.emit.c.source import c_files
from derive.emit.casadi_module import imported
from derive.emit.casadi_text import casadi_file
from derive.library.library import library
from derive.scene import CATALOGUE, SceneError, parse_scene
from derive.scene.names import HELPERS, LONGEST_NAME
from derive.scene.reserved import owner
from tests.made import thinned

TEMPLATES = CATALOGUE.parent.parent.parent / "templates"
GENERATED = CATALOGUE.parent.parent.parent / "generated"
LARGEST_READ = 100_000  # bytes of a module: larger ones repeat the same templates
HEADERS = (
    *("assert", "complex", "ctype", "errno", "fenv", "float", "inttypes", "iso646", "limits"),
    *("locale", "math", "setjmp", "signal", "stdalign", "stdarg", "stdatomic", "stdbool"),
    *("stddef", "stdint", "stdio", "stdlib", "stdnoreturn", "string", "threads", "time", "uchar"),
    *("wchar", "wctype"),
)
NAME = re.compile(r"[A-Za-z][A-Za-z0-9]*(_[A-Za-z0-9]+)*")
MACHINE = """
wanted = ["{result}", "{result}_jacobian", "step_rk4", "{unknown}"]
[parameters]
{parameter} = {{ unit = "kg", range = [1, 2] }}
g = {{ unit = "m/s^2", range = [9, 10] }}
[inputs]
{input} = {{ unit = "N m", range = [1, 2] }}
[coordinates]
{coordinate} = {{ unit = "rad", range = [-1, 1] }}
[frames.arm]
turned = ["y {coordinate}"]
[bodies.bob]
frame = "arm"
shape = "point"
mass = "{parameter}"
centre = ["0", "0", "-1"]
[loads]
weight = {{ gravity = ["0", "0", "-g"] }}
pin = {{ on = "bob", force = "?{unknown}", couple = ["?cx", "{input}", "?cz"] }}
[results]
{result} = "{parameter}*g*sin({coordinate})*2 + {unknown}_x"
"""
PLAIN = {k: f"{k}_" + "q" for k in ("parameter", "input", "coordinate", "result", "unknown")}
ROLES = tuple(PLAIN)


def machine(**names: str) -> str:
    return MACHINE.format(**PLAIN | names)


def refusal(text: str, name: str = "odd") -> str:
    """Return the sentence that refuses a scene or its code, "" if nothing does."""
    try:
        made = library(parse_scene(text, name))
        c_files(made, ())
        casadi_file(made)
    except SceneError as error:
        return str(error)
    return ""


def macros(text: str, *options: str) -> set[str]:
    """Return the macros without arguments that gcc knows after a text, and that are names here."""
    command = ["gcc", *options, "-dM", "-E", "-x", "c", "-"]
    done = subprocess.run(command, input=text, capture_output=True, text=True, check=True)
    found = re.findall(r"^#define (\w+) ", done.stdout, re.MULTILINE)
    return {name for name in found if NAME.fullmatch(name) and len(name) <= LONGEST_NAME}


@pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc's headers")
def test_every_macro_of_c_s_headers_and_of_the_compiler_is_refused_but_i() -> None:
    text = "\n".join(f"#include <{name}.h>" for name in HEADERS)
    found = macros(text, "-std=gnu11") | macros("#include <math.h>\n", "-D_GNU_SOURCE")
    assert len(found) > 500
    assert {name for name in found if not owner(name)} == {"I"}


def test_every_word_and_function_of_python_is_refused() -> None:
    own = {name for name in dir(builtins) if name.islower() and not name.startswith("_")}
    assert {name for name in own | set(keyword.kwlist) if not owner(name)} == set()


@pytest.mark.long
def test_every_name_that_a_module_takes_from_outside_is_refused() -> None:
    outside: set[str] = set()
    for path in sorted(GENERATED.glob("*/*_casadi.py")):
        if path.stat().st_size < LARGEST_READ:
            outside |= taken_from_outside(ast.parse(path.read_text(encoding="utf-8")))
    assert outside >= {"ca", "len"}
    assert {n for n in outside if not owner(n)} == set()


def taken_from_outside(tree: ast.Module) -> set[str]:
    names = [node for node in ast.walk(tree) if isinstance(node, ast.Name)]
    made = {n.id for n in names if not isinstance(n.ctx, ast.Load)}
    made |= {n.name for n in ast.walk(tree) if isinstance(n, ast.FunctionDef)}
    made |= {n.arg for n in ast.walk(tree) if isinstance(n, ast.arg)}
    return {n.id for n in names} - made


def test_every_helper_of_the_templates_is_refused_as_a_function() -> None:
    texts = [path.read_text(encoding="utf-8") for path in TEMPLATES.glob("**/*.c.jinja")]
    found = {n for text in texts for n in re.findall(r"\{\{ scene \}\}_(\w+?)_\{\{ suffix", text)}
    assert len(found) > 10
    assert found <= set(HELPERS)


@pytest.mark.parametrize("name", sorted(HELPERS))
def test_a_result_called_as_a_helper_is_refused(name: str) -> None:
    assert refusal(machine(result=name)).startswith("scene 'odd': ")


@pytest.mark.parametrize("name", ["add", "pair", "setup"])
def test_without_the_check_of_functions_such_a_result_does_not_compile(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(derive.scene.results, "refuse_taken_functions", lambda *_: None)
    texts = c_files(library(parse_scene(machine(result=name), "odd")), ())
    with pytest.raises(CompilerError):
        compiled(texts, "odd_f64.c", tmp_path, find_compiler())


@pytest.mark.parametrize(
    ("name", "whose"),
    [
        *(("HUGE_VAL", "a macro of C's math.h"), ("NAN", "a macro of C's math.h")),
        *(("INFINITY", "a macro of C's math.h"), ("M_PI", "a macro of C's math.h")),
        *(("linux", "a macro that compilers define"), ("typeof", "a word of C")),
        *(("static_assert", "a word of C"), ("thread_local", "a word of C")),
        *(("B1", "a macro of Arduino.h"), ("PI", "a macro of Arduino.h")),
        *(("y1", "a function of POSIX's math.h"), ("lambda", "a word of Python")),
        *(("len", "a function of Python"), ("co_await", "a word of C++")),
        ("ca", "the name of CasADi in the emitted module"),
    ],
)
def test_a_word_is_refused_in_every_role_with_whose_it_is(name: str, whose: str) -> None:
    for role in ROLES:
        assert refusal(machine(**{role: name})).endswith(f"the name '{name}', which is {whose}")


def test_a_function_called_as_a_variant_of_another_is_refused() -> None:
    for ending in ("jacobian_dense", "jacobian_hot", "hot"):
        more = f'wanted = ["gain_{ending}: pin_x", '
        text = machine(result="gain", unknown="pin").replace("wanted = [", more)
        assert "is how a variant of" in refusal(text)


@pytest.mark.parametrize("name", ["con", "aux", "NUL", "com1", "int", "lambda"])
def test_a_file_is_not_called_as_a_device_or_a_word(name: str) -> None:
    assert refusal(machine(), name).startswith(f"scene '{name}': the file has the name '{name}'")


@pytest.mark.parametrize("names", [("I", "F", "low", "now", "jac"), ("size_t", "i", "k", "m", "t")])
def test_names_that_look_like_words_and_harm_nothing_compile_after_every_header(
    names: tuple[str, ...], tmp_path: Path
) -> None:
    made = library(parse_scene(machine(**dict(zip(ROLES, names, strict=True))), "odd"))
    texts = c_files(made, ())
    arduino = "#define F(text) ((void *)(text))\n#define bit(b) (1UL << (b))\n"
    before = "".join(f"#include <{h}.h>\n" for h in HEADERS if h not in ("iso646", "threads"))
    texts["use.c"] = f'{before}{arduino}#include "odd_f64.h"\nstatic double complex z(void)\n'
    texts["use.c"] += "{ return (double complex)I; }\ndouble use(void);\n"
    texts["use.c"] += "double use(void) { return creal(z()); }\n"
    for source in ("odd_f64.c", "use.c"):
        assert compiled(texts, source, tmp_path, find_compiler()).exists()
    imported("odd_casadi", casadi_file(made), tmp_path).step_rk4()


@pytest.mark.parametrize("name", ["now", "rates", "stage"])
def test_a_name_that_a_function_has_for_a_value_of_its_own_is_refused(name: str) -> None:
    says = "calls a value of its own; give it another name"
    assert refusal(f'emission = "compact"\n{machine(coordinate=name)}').endswith(says)


def stepped(text: str, folder: Path) -> str:
    """Return what a step of the machine comes to, by the emitted module."""
    module = imported("odd_casadi", casadi_file(library(parse_scene(text, "odd"))), folder)
    return str(module.step_rk4()([1.5, 9.8], 0.4, 0.2, 1.3, 0.1))


@pytest.mark.parametrize("letter", thinned(["t", "s", "p", "w"], 2))
def test_names_like_those_of_our_own_values_change_no_number(letter: str, tmp_path: Path) -> None:
    names = (f"{letter}0", f"{letter}2", f"{letter}4", f"{letter}1", f"{letter}3")
    text = machine(**dict(zip(ROLES, names, strict=True)))
    assert stepped(text, tmp_path) == stepped(machine(), tmp_path)
