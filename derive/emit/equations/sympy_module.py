"""An account of equations as a Python module that needs SymPy only.

Expressions are written by SymPy's own printer for Python, in names that are identifiers; all other
text of a scene stands in comments.
"""

from collections.abc import Iterator
from textwrap import wrap

from sympy import Expr, Symbol
from sympy.printing.python import PythonPrinter

from derive import __version__
from derive.emit.equations.account import STEP_NUMBERS, Account
from derive.emit.equations.naming import python_name
from derive.emit.equations.section import Section
from derive.emit.notation import equation_text
from derive.scene.escape import in_docstring, visible

WIDTH = 92
_HEAD = '''\
"""{title}

The equations of scene '{scene}' in SI units, by derive {version}.

CONSTANTS what parameters are that the scene gives a value
BALANCES  equations that hold, by function
VALUES    what each function computes, in order: later values are made of earlier ones
ANSWERS   the components that a function returns, each by its symbol
"""

from sympy import Eq, Integer, Rational, Symbol, cos, pi, sin, sqrt, tan
'''
_READ = '''\
def answers(function):
    """Return the answers of a function by component, each in given symbols and CONSTANTS."""
    found = {}
    for symbol, value in VALUES[function].items():
        found[symbol] = value.xreplace(found)
    return {name: found.get(symbol, symbol) for name, symbol in ANSWERS[function].items()}
'''


def sympy_module(told: Account) -> str:
    """Return the text of the module."""
    title, scene = in_docstring(told.scene.title), told.scene.name
    blocks = [
        _HEAD.format(title=title, scene=scene, version=__version__),
        "\n".join(_symbols(told)),
        "\n".join(["", "CONSTANTS = {", *_constants(told), "}"]),
        "\nBALANCES, VALUES, ANSWERS = {}, {}, {}\n",
        *("\n".join(_section(section)) for section in told.sections),
        "",
        _READ,
    ]
    return "\n".join(blocks)


def _symbols(told: Account) -> Iterator[str]:
    """Yield a line for every symbol, with its unit and meaning."""
    used = {python_name(each.names[s]): s for each in told.sections for s in each.symbols()}
    for row in told.symbols:
        for name in map(python_name, row.names):
            sign = "positive" if used[name].is_positive else "real"
            yield f'{name} = Symbol("{name}", {sign}=True)  # {row.unit}: {visible(row.meaning)}'


def _constants(told: Account) -> Iterator[str]:
    for name, value in told.constants.items():
        yield f'    {name}: Rational("{value}"),'


def _section(section: Section) -> Iterator[str]:
    yield f"# {section.name}: {visible(section.says)}"
    yield from (f"# {visible(note)}" for note in section.notes)
    for part in section.parts:
        for step in part.steps:
            yield f"# Lecture, step {STEP_NUMBERS[step.name]}, {step.name}: {equation_text(step)}"
    at = f'["{section.name}"]'
    yield f"BALANCES{at} = ["
    for left, right in section.balances:
        sides = f"{_python(section, left)}, {_python(section, right)}, evaluate=False"
        yield from _folded("    Eq(", sides)
    yield "]"
    yield f"VALUES{at} = {{"
    for left, right in filter(section.assigns, section.equations):
        value = _python(section, right)
        yield from _folded(
            f"    {_python(section, left)}: (", f"Integer({value})" if right.is_Integer else value
        )
    yield "}"
    yield f"ANSWERS{at} = {{"
    yield from (f'    "{c}": {python_name(section.names[s])},' for c, s in section.answers.items())
    yield "}\n"


def _folded(before: str, inside: str) -> list[str]:
    """Return what stands between parentheses, on lines of its own if it is long."""
    if len(before + inside) <= WIDTH:
        return [f"{before}{inside}),"]
    lines = wrap(inside, WIDTH - 8, break_long_words=False, break_on_hyphens=False)
    return [before, *(f"        {line}" for line in lines), "    ),"]


def _python(section: Section, expression: Expr) -> str:
    names = {s: Symbol(python_name(name)) for s, name in section.names.items()}
    return str(PythonPrinter().doprint(expression.xreplace(names)))
