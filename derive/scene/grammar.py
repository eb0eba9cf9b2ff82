"""The strict grammar of formulas: text in, an exact tree or one clear sentence out.

    sum      := product (("+" | "-") product)*
    product  := signed (("*" | "/") signed)*
    signed   := ["-"] power
    power    := atom [("^" | "**") ["-"] integer]
    atom     := number | symbol | ("sin" | "cos" | "tan" | "sqrt") "(" sum ")" | "(" sum ")"

Numbers are read exactly as fractions (``0.1`` is 1/10). Length, nesting and size are bounded, so
that no text, however hostile, exhausts time or the stack.
"""

import re
from dataclasses import dataclass, replace
from fractions import Fraction

from derive.scene.escape import brief
from derive.scene.formula import ZERO, Formula, FormulaError, apply, number, symbol
from derive.scene.functions import FUNCTIONS

LONGEST_TEXT = 1000
DEEPEST_NESTING = 30
TALLEST_TREE = 100
LARGEST_DECIMAL_EXPONENT = 300

_TOKEN = re.compile(
    r"(?P<number>(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)"
    r"|(?P<symbol>[A-Za-z][A-Za-z0-9_]*)|(?P<sign>\*\*|[-+*/^()])|(?P<space>[ \t\n]+)"
)


@dataclass(frozen=True)
class Token:
    """One word of a formula: its kind (number, symbol, sign or end), text and place from 1.

    ahead : the whole formula from here on
    """

    kind: str
    text: str
    place: int
    ahead: str


Tokens = list[Token]


def parse(text: str) -> Formula:
    """Return the formula that a text spells by the grammar above.

    Raises FormulaError with the place (from 1) and what was expected there.

    >>> str(parse("0.5*m*v**2"))
    '1/2*m*v^2'
    """
    if len(text) > LONGEST_TEXT:
        raise FormulaError(f"is {len(text)} characters long; {LONGEST_TEXT} is the most")
    tokens = _tokens(text)
    tokens.reverse()
    formula = _sum(tokens, 0)
    if tokens[-1].kind != "end":
        raise _expected("an operator or the end", tokens[-1])
    if height(formula) > TALLEST_TREE:
        raise FormulaError(f"joins more than {TALLEST_TREE} terms in one chain; use parentheses")
    return formula


def _tokens(text: str) -> Tokens:
    tokens, place = [], 0
    while place < len(text):
        match = _TOKEN.match(text, place)
        if match is None:
            raise FormulaError(f"at {place + 1}: {text[place]!r} is no part of a formula")
        if match.lastgroup != "space":
            tokens.append(Token(str(match.lastgroup), match.group(), place + 1, text[place:]))
        place = match.end()
    return [*tokens, Token("end", "", len(text) + 1, "")]


def _expected(what: str, found: Token) -> FormulaError:
    shown = f"'{brief(found.text)}'" if found.text else "the end"
    return FormulaError(f"at {found.place}: expected {what}, found {shown}")


def height(formula: Formula) -> int:
    """Return the height of a tree, level by level, so that a tall tree cannot exhaust the stack."""
    level, levels = [formula], 0
    while level:
        level, levels = [part for node in level for part in node.operands], levels + 1
    return levels


def _as_written(formula: Formula, start: Token, tokens: Tokens) -> Formula:
    """Return what was read since ``start`` with its text in one line."""
    text = start.ahead[: len(start.ahead) - len(tokens[-1].ahead)]
    return replace(formula, written=" ".join(text.split()))


def _sum(tokens: Tokens, depth: int) -> Formula:
    start = tokens[-1]
    formula = _product(tokens, depth)
    while tokens[-1].text in ("+", "-"):
        sign = tokens.pop().text
        term = _product(tokens, depth)
        made = formula + term if sign == "+" else formula - term
        formula = _as_written(made, start, tokens)
    return formula


def _product(tokens: Tokens, depth: int) -> Formula:
    start = tokens[-1]
    formula = _signed(tokens, depth)
    while tokens[-1].text in ("*", "/"):
        sign = tokens.pop()
        factor = _signed(tokens, depth)
        if sign.text == "/" and factor == ZERO:
            raise FormulaError(f"at {sign.place}: divides by zero")
        made = formula * factor if sign.text == "*" else formula / factor
        formula = _as_written(made, start, tokens)
    return formula


def _signed(tokens: Tokens, depth: int) -> Formula:
    start = tokens[-1]
    if start.text != "-":
        return _power(tokens, depth)
    tokens.pop()
    if tokens[-1].text == "-":
        raise _expected("one sign", tokens[-1])
    return _as_written(-_power(tokens, depth), start, tokens)


def _power(tokens: Tokens, depth: int) -> Formula:
    start = tokens[-1]
    base = _atom(tokens, depth)
    base = base if start.text == "(" else _as_written(base, start, tokens)
    if tokens[-1].text not in ("^", "**"):
        return base
    tokens.pop()
    sign = -1 if tokens[-1].text == "-" else 1
    if sign < 0:
        tokens.pop()
    exponent = tokens.pop()
    if not exponent.text.isdigit():
        raise _expected("a whole number as exponent", exponent)
    if tokens[-1].text in ("^", "**"):
        raise _expected("one power at a time (use parentheses)", tokens[-1])
    return _as_written(base ** (sign * int(exponent.text)), start, tokens)


def _atom(tokens: Tokens, depth: int) -> Formula:
    token = tokens.pop()
    if token.kind == "number":
        return number(_exact(token))
    if token.kind == "symbol" and tokens[-1].text == "(":
        if token.text not in FUNCTIONS:
            raise _expected(f"one of {', '.join(FUNCTIONS)} before '('", token)
        return apply(token.text, _group(tokens, depth))
    if token.kind == "symbol" and token.text not in FUNCTIONS:
        return symbol(token.text)
    if token.text != "(":
        raise _expected("a number, a symbol or '('", token)
    tokens.append(token)
    return _group(tokens, depth)


def _group(tokens: Tokens, depth: int) -> Formula:
    opening = tokens.pop()
    if depth >= DEEPEST_NESTING:
        raise FormulaError(f"at {opening.place}: nested deeper than {DEEPEST_NESTING}")
    formula = _sum(tokens, depth + 1)
    closing = tokens.pop()
    if closing.text != ")":
        raise _expected("')'", closing)
    return formula


def _exact(token: Token) -> Fraction:
    exponent = re.split("[eE]", token.text)[1:]
    if exponent and abs(int(exponent[0])) > LARGEST_DECIMAL_EXPONENT:
        raise FormulaError(f"at {token.place}: exponent beyond {LARGEST_DECIMAL_EXPONENT}")
    return Fraction(token.text)
