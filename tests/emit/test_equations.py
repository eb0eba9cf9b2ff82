"""Equations to take away: Python with the programs' values, LaTeX that compiles, safe text."""

import ast
import re
import runpy
import shutil
import subprocess
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest
import sympy
from flint import arb, ctx
from mpmath import mp

from derive.emit.equations import FORMS, equations
from derive.emit.equations.account import account
from derive.emit.equations.dimensions import dimension_made
from derive.emit.equations.naming import RESERVED, python_name
from derive.emit.equations.section import Section
from derive.emit.notation.latex import tex_name
from derive.emit.page.lecture import lecture_page
from derive.library.library import Library, library
from derive.program.precision import F64
from derive.program.run import results_by_name
from derive.scene import SceneError, catalogue, parse_scene
from derive.verify.reference import BALLS
from derive.verify.sample import samples
from tests.made import library_of

TRIALS = sorted((Path(__file__).parents[1] / "data" / "trials").glob("*.toml"))
MACHINES = sorted((Path(__file__).parents[1] / "mechanics" / "scenes").glob("*.toml"))
QUICK = ("heavy_top", "skewed_disc", "chandler_rigid_earth")
EVERY = [*QUICK, *(pytest.param(n, marks=pytest.mark.long) for n in
         (*sorted({*catalogue()} - {*QUICK}), *map(str, (*TRIALS, *MACHINES))))]  # fmt: skip
DIGITS, BITS = 60, 400
SEEN = 2  # points that a line may stick out by: less than a millimetre in a margin of twenty
NEAR = 1e-30  # of the larger: what is left of 60 digits where sums of a scene cancel
COMMANDS = r"""
\dot \ddot \mathrm \mathbf \boldsymbol \mathsf \sum \times \cdot \ne \in \frac \sqrt \left \right
\sin \cos \tan \operatorname \pi \textbackslash \textasciicircum \textasciitilde \textless
\textgreater \textbar \texttt \emph \section \item \par \begin \end \hline \endhead
\documentclass \usepackage \setlength \parindent \parskip \allowdisplaybreaks \sloppy \title \author
\date \maketitle \allowbreak \quad \Delta \Omega \Phi \Psi \Theta \Gamma \Lambda \Sigma \alpha \beta
\gamma \delta \epsilon \zeta \eta \theta \kappa \lambda \mu \nu \xi \rho \sigma \tau \phi \chi \psi
\omega \, \\ \_ \% \& \# \{ \} \$ \` \"
"""
KNOWN = {*COMMANDS.split(), "\\ "}
HOSTILE = "$x$ % & # _ ^ ~ {} à µ ☃ `` < | > {x} }{ os.remove('x') # $$"


def opened(source: str) -> Library:
    """Return a library, or skip what the reader refuses on purpose."""
    try:
        return library_of(source)
    except SceneError as error:
        pytest.skip(f"refused: {error}")


def module(told: str, folder: Path) -> dict[str, Any]:
    """Return what a printed module of Python defines, which may import SymPy and nothing else."""
    imports = [node for node in ast.walk(ast.parse(told)) if isinstance(node, ast.Import)]
    froms = [n.module for n in ast.walk(ast.parse(told)) if isinstance(n, ast.ImportFrom)]
    assert (imports, froms) == ([], ["sympy"])
    file = folder / "equations.py"
    file.write_text(told, encoding="utf-8")
    return runpy.run_path(str(file))


def differences(lib: Library, made: Mapping[str, Any]) -> list[str]:
    """Return the answers whose value is not the program's, at a point within the ranges."""
    found, programs = [], {p.name: p for p in (*lib.functions, *lib.rates)}
    given = samples(lib.mechanism, F64, 1, 0).each[0].values
    names = {c: name for section in account(lib).sections
             for c, name in component_names(section).items()}  # fmt: skip
    with ctx.workprec(BITS):
        known = {c: arb(x) for c, x in given.items()}
        known |= results_by_name(lib.setup, BALLS, known)
        exact = {made[names[c]]: sympy.Rational(*x.as_integer_ratio())
                 for c, x in given.items() if c in names} | made["CONSTANTS"]  # fmt: skip
        for function, answers in made["ANSWERS"].items():
            program = programs.get(function) or programs[f"{function}_jacobian"]
            results = results_by_name(program, BALLS, known)
            for component, value in made["answers"](function).items():
                assert component in answers
                ours = sympy.sympify(value).xreplace(exact).evalf(DIGITS)
                theirs = sympy.Float(
                    str(results[component].mid().str(DIGITS, radius=False)), DIGITS
                )
                if abs(ours - theirs) > NEAR * max(1, abs(theirs)):
                    found.append(f"{function}: {component} = {ours}, not {theirs}")
    return found


def residuals(lib: Library, made: Mapping[str, Any]) -> list[str]:
    """Return the balances that the programs' answers do not satisfy, at a point of the ranges."""
    found, programs = [], {p.name: p for p in (*lib.functions, *lib.rates)}
    given = samples(lib.mechanism, F64, 1, 0).each[0].values
    names = {c: name for section in account(lib).sections
             for c, name in component_names(section).items()}  # fmt: skip
    with ctx.workprec(BITS):
        balls = {c: arb(x) for c, x in given.items()}
        balls |= results_by_name(lib.setup, BALLS, balls)
        start = {made[names[c]]: sympy.Rational(*x.as_integer_ratio())
                 for c, x in given.items() if c in names} | made["CONSTANTS"]  # fmt: skip
        for section in account(lib).sections:
            balances, function = made["BALANCES"][section.name], section.name
            assert len(balances) >= len(lib.problems[function].rows)
            program = programs.get(function) or programs[f"{function}_jacobian"]
            results = results_by_name(program, BALLS, balls)
            ours = {symbol: sympy.Float(str(results[c].mid().str(DIGITS, radius=False)), DIGITS)
                    for c, symbol in made["ANSWERS"][function].items()}  # fmt: skip
            values = start | ours
            for symbol, value in made["VALUES"][function].items():
                values.setdefault(symbol, value.xreplace(values).evalf(DIGITS))
            sides = ([sympy.sympify(e).xreplace(values) for e in b.args] for b in balances)
            rows = [sympy.Add(left, -right) for left, right in sides]
            found += [f"{function}: {left}" for left in unsatisfied(rows)]
    return found


def unsatisfied(rows: list[sympy.Expr]) -> list[str]:
    """Return what is left over of equations, linear in unknowns that no answer needs."""
    unknowns = sorted({s for row in rows for s in row.free_symbols}, key=str)
    A, b = (
        (m.evalf(DIGITS) for m in sympy.linear_eq_to_matrix(rows, unknowns))
        if unknowns
        else (sympy.zeros(len(rows), 0), sympy.Matrix([-row for row in rows]).evalf(DIGITS))
    )
    assert len(unknowns) < len(rows) or not rows
    with mp.workdps(DIGITS):
        found = mp.lu_solve(mp.matrix(A.tolist()), mp.matrix(b.tolist())) if unknowns else []
        left = [abs(sum((mp.mpf(A[n, k]) * x for k, x in enumerate(found)), -mp.mpf(b[n])))
                for n in range(len(rows))]  # fmt: skip
    return [f"balance {n + 1}: {x}" for n, x in enumerate(left) if x > NEAR * max(1, *map(abs, b))]


def component_names(section: Section) -> dict[str, str]:
    """Return the identifiers in a printed module of what a section is given, by component."""
    names = section.names
    return {c: python_name(names[s]) for c, s in section.given.items() if s in names}


@pytest.mark.parametrize("source", EVERY)
def test_the_module_of_sympy_gives_the_values_of_the_programs(source: str, tmp_path: Path) -> None:
    lib = opened(source)
    made = module(equations(lib, "sympy"), tmp_path)
    assert differences(lib, made) == []
    assert residuals(lib, made) == []


def test_a_module_with_a_wrong_sign_gives_other_values(tmp_path: Path) -> None:
    lib = library_of("heavy_top")
    told = equations(lib, "sympy")
    wrong = told.replace("+ C*omega_z/A))", "- C*omega_z/A))")
    assert wrong != told
    assert [d for d in differences(lib, module(wrong, tmp_path)) if "omega_dot_y" in d]
    wrong = told.replace("Eq(A*omega_dot_y, omega_x*", "Eq(A*omega_dot_y, -omega_x*")
    assert wrong != told
    assert residuals(lib, module(wrong, tmp_path)) != []


@pytest.mark.parametrize("source", EVERY)
def test_the_document_is_balanced_and_calls_known_commands_only(source: str) -> None:
    told = equations(opened(source), "latex")
    assert faults(told) == []


def faults(told: str) -> list[str]:
    """Return what is wrong with a LaTeX document, as far as can be told without TeX."""
    found = [f"unknown {c}" for c in re.findall(r"\\(?:[A-Za-z]+|.)", told.replace("\\\n", "\\ "))
             if c not in KNOWN]  # fmt: skip
    depth, opened_ = 0, list[str]()
    bare = re.sub(r"\\[\\{}]", "", told)
    for mark in bare:
        depth += {"{": 1, "}": -1}.get(mark, 0)
        found += ["a brace closes nothing"] if depth < 0 else []
    for kind, name in re.findall(r"\\(begin|end)\{(\w+\*?)\}", told):
        opened_ = [*opened_, name] if kind == "begin" else opened_[:-1]
        found += [] if kind == "begin" or name not in opened_ else [f"{name} ends twice"]
    signs = len(re.findall(r"(?<!\\)\$", told))
    return [*found, *(["a brace is open"] if depth else []), *opened_, *["$"] * (signs % 2)]


@pytest.mark.parametrize("wrong", [r"\input{x}", "{", "}", "$", r"\begin{align*}"])
def test_what_is_wrong_with_a_document_is_found(wrong: str) -> None:
    assert faults(f"{equations(library_of('heavy_top'), 'latex')}{wrong}") != []


@pytest.mark.parametrize("source", EVERY)
def test_the_document_compiles_and_no_line_leaves_the_page(source: str, tmp_path: Path) -> None:
    latex = shutil.which("pdflatex")
    if latex is None:
        pytest.skip("no pdflatex on this machine")
    (tmp_path / "equations.tex").write_text(equations(opened(source), "latex"), encoding="utf-8")
    command = [latex, "-interaction=nonstopmode", "-halt-on-error", "equations.tex"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, check=False)
    log = done.stdout.decode("utf-8", "replace")
    assert done.returncode == 0, log[-1500:]
    assert (tmp_path / "equations.pdf").stat().st_size > 10_000
    assert [
        float(x) for x in re.findall(r"Overfull \\hbox \(([\d.]+)pt", log) if float(x) > SEEN
    ] == []


def test_no_text_of_a_scene_reaches_latex_or_python_as_a_command(tmp_path: Path) -> None:
    text = f"""
    title = '''{HOSTILE}'''
    wanted = ["moment"]
    body = {{ kind = "spherical", moment = "crowbar" }}
    [parameters]
    crowbar = {{ unit = "kg m^2", range = [1, 2], meaning = '''{HOSTILE}''' }}
    """
    lib = library(parse_scene(text, "hostile"))
    assert faults(equations(lib, "latex")) == []
    assert "moment_x" in module(equations(lib, "sympy"), tmp_path)["ANSWERS"]["moment"]
    assert "crowbar⋅" in equations(lib, "text")
    assert equations(lib, "ascii").isascii()


@pytest.mark.parametrize("source", EVERY)
def test_every_symbol_of_an_equation_is_listed_once_with_its_unit_and_meaning(source: str) -> None:
    lib = opened(source)
    told = account(lib)
    listed = [name for row in told.symbols for name in row.names]
    assert len({*map(python_name, listed)}) == len(listed)
    assert all(row.unit and row.meaning for row in told.symbols)
    for section in told.sections:
        names = [python_name(name) for name in section.names.values()]
        assert len(set(names)) == len(names)
        assert section.symbols() <= section.names.keys()
    tree = ast.parse(equations(lib, "sympy"))
    read = {n.id for n in ast.walk(tree) if isinstance(n, ast.Name)} - RESERVED - OF_PYTHON
    assert read == {*map(python_name, listed)}
    written = [shown for row in told.symbols for shown in row.shown]
    assert len({*map(tex_name, written)}) == len(written)
    assert not re.findall(r"\\d?dot\{\\mathrm", equations(lib, "latex"))


OF_PYTHON = {"found", "symbol", "value", "function", "name"}


@pytest.mark.parametrize("source", EVERY)
def test_the_terms_of_an_equation_agree_in_their_units(source: str) -> None:
    for section in account(opened(source)).sections:
        if any("Left out of the equations" in note for note in section.notes):
            continue  # what is left out may have had a unit
        for left, right in section.equations:
            terms = (*sympy.Add.make_args(left), *sympy.Add.make_args(right))
            found = {dimension_made(term, section.units) for term in terms} - {None}
            assert len(found) <= 1, (section.name, left, right)


def test_a_law_is_told_with_the_number_that_it_has_on_the_page_of_the_lecture() -> None:
    at = (page := lecture_page()).index('id="general_form"')
    number = re.findall(r'class="count">(\d+)<', page[at:])[0]
    for form in FORMS:
        told = equations(library_of("heavy_top"), form)
        assert re.search(rf"step {number}, \S*general", told)


def test_a_form_that_does_not_exist_is_refused() -> None:
    with pytest.raises(SceneError, match="form must be one of text, ascii, latex, sympy, not"):
        equations(library_of("heavy_top"), "tex")


@pytest.mark.long
def test_a_document_names_the_command_that_makes_it() -> None:
    text = library_of("heavy_top").scene.text
    for name, means in (("heavy_top", "heavy_top"), ("brick", "brick.toml")):
        told = equations(library(parse_scene(text, name)), "latex")
        assert f"`derive equations {means} --latex`" in told.splitlines()[0]
