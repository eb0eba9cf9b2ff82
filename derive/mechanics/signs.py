"""Whose sign a scene's equations rest on: roots of squares that are taken as what is squared.

What is above 0 on its declared range is so everywhere in the equations, and so |x| is x in them.
"""

from collections.abc import Iterator
from dataclasses import fields, is_dataclass

from sympy import Abs, Dummy, Expr, Symbol, sqrt

from derive.mechanics.frames import Frames
from derive.mechanics.loads import along_one_line, stretched
from derive.scene.formula import ZERO, Formula, symbols
from derive.scene.machine import Spring


def signs_taken(frames: Frames) -> Iterator[str]:
    """Yield a sentence for every root of a square that is written without it, and while what."""
    machine, words = frames.machine, frames.words
    for load in machine.loads:
        if isinstance(load, Spring) and (load.length != ZERO or load.damping != ZERO):
            d, _ = stretched(frames, load)
            if says := _line(frames, along_one_line(frames, d), f"the length of {load.name}"):
                yield says
            else:
                yield from _sentence(frames, (d.T * d)[0], f"the length of {load.name}")
    known = {*words.vocabulary.symbols, *words.vocabulary.numbers, "pi"}
    for formula in dict.fromkeys(f for f in _roots(machine) if {*symbols(f)} <= known):
        yield from _sentence(frames, words.expression(formula.operands[0]), str(formula))


def _line(frames: Frames, length: Expr | None, what: str) -> str:
    """Return a sentence on a length that is no symbol, "" for others."""
    named = frames.sheet.definitions
    while length is not None and length.free_symbols & named.keys():
        length = length.xreplace(named)
    if length is None or length.is_Symbol:
        return ""
    made = length.xreplace({s: Symbol(frames.words.sheet.label(s)) for s in length.free_symbols})
    text = str(made).replace("**", "^")
    return f"Taken: {what} is {text}, which is above 0 in the declared ranges."


def _sentence(frames: Frames, square: Expr, what: str) -> Iterator[str]:
    above = [s for s in sorted(square.free_symbols, key=str) if s.is_positive]
    used = [s for s in above if sqrt(square.xreplace({s: Dummy(real=True)})).has(Abs)]
    if used:
        sheet = frames.words.sheet
        names = [sheet.label(s) for s in used]
        root = sqrt(square)
        root = root.xreplace({s: Symbol(sheet.label(s)) for s in root.free_symbols})
        each = " and ".join(f"{name} > 0" for name in names)
        ranges = "range" if len(names) == 1 else "ranges"
        made = str(root).replace("**", "^")
        yield f"Taken: {what} is {made}, while {each} as in the declared {ranges}."


def _roots(held: object) -> Iterator[Formula]:
    """Yield every square root in the formulas of a scene, outer ones first."""
    if isinstance(held, Formula):
        if held.operator == "sqrt":
            yield held
        for operand in held.operands:
            yield from _roots(operand)
    elif isinstance(held, tuple):
        for part in held:
            yield from _roots(part)
    elif is_dataclass(held):
        for field in fields(held):
            yield from _roots(getattr(held, field.name))
