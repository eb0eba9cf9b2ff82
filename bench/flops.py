"""Floating-point operations counted in the text of a C or C++ function.

Every tool is counted by the same eye: the binary ``+ - * /`` that stand in its emitted text, with
the multiplications inside ``pow(x, 2)`` and ``casadi_sq(x)``. Signs are free; so are indices.
"""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields

TOKEN = re.compile(
    r"""(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?[fFlLuU]*|0[xX][0-9a-fA-F.]+[pP][+-]?\d+)
    |(?P<word>(?:std::)?[A-Za-z_]\w*)
    |(?P<sign>->|\+\+|--|<<|>>|[<>=!+\-*/]=|&&|\|\||[-+*/%=<>!&|^~?:;,.(){}\[\]])""",
    re.VERBOSE,
)
COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*|^\s*#[^\n]*", re.DOTALL | re.MULTILINE)
TYPES = {"double", "float", "int", "long", "void", "char", "const", "Scalar", "casadi_real"}
LOOPS = {"for", "while", "do", "goto"}
BINARY = {"+": "add", "-": "sub", "*": "mul", "/": "div"}
COMPARISONS = {"==", "!=", "<=", ">="}
FUNCTIONS = {"sin", "cos", "tan", "sqrt"}


@dataclass(frozen=True)
class Flops:
    """How many operations of each kind stand in a text; ``pow`` counts calls left to libm."""

    add: int = 0
    sub: int = 0
    mul: int = 0
    div: int = 0
    sqrt: int = 0
    sin: int = 0
    cos: int = 0
    tan: int = 0
    pow: int = 0

    @property
    def total(self) -> int:
        """Return the number of ``+ - * /``.

        >>> Flops(add=2, mul=3, sin=1).total
        5
        """
        return self.add + self.sub + self.mul + self.div

    def __add__(self, other: "Flops") -> "Flops":
        names = (field.name for field in fields(self))
        return Flops(**{name: getattr(self, name) + getattr(other, name) for name in names})


def count(text: str, functions: Sequence[str]) -> Flops:
    """Return the operations in the bodies of the named functions of a source text.

    Raises ValueError if a function is missing or holds a loop, whose cost no text tells.

    >>> count("void f(const double *x, double *y) { y[0] = -x[1] * x[2] + 1.0e-3; }", ["f"])
    Flops(add=1, sub=0, mul=1, div=0, sqrt=0, sin=0, cos=0, tan=0, pow=0)
    """
    tokens = tuple(_tokens(text))
    return sum((_body_flops(body(tokens, name), name) for name in functions), Flops())


def _tokens(text: str) -> Iterator[str]:
    code = COMMENT.sub(" ", text)
    for match in TOKEN.finditer(code):
        yield match.group().removeprefix("std::")


def body(tokens: Sequence[str], name: str) -> Sequence[str]:
    """Return the tokens between the braces of a function's definition."""
    for start, token in enumerate(tokens[:-1]):
        if token == name and tokens[start + 1] == "(":
            after = _closing(tokens, start + 1) + 1
            if after < len(tokens) and tokens[after] == "{":
                return tokens[after + 1 : _closing(tokens, after)]
    raise ValueError(f"no definition of '{name}' in the text")


def _closing(tokens: Sequence[str], start: int) -> int:
    """Return the place of the bracket that closes the one at ``start``."""
    closes = {"(": ")", "{": "}", "[": "]"}[tokens[start]]
    depth = 0
    for place in range(start, len(tokens)):
        depth += (tokens[place] == tokens[start]) - (tokens[place] == closes)
        if depth == 0:
            return place
    raise ValueError(f"'{tokens[start]}' is never closed")


def _body_flops(tokens: Sequence[str], name: str) -> Flops:
    if loops := LOOPS & set(tokens):
        raise ValueError(f"function '{name}' has a loop ('{min(loops)}'): its text tells no count")
    flops = Flops()
    place = 0
    while place < len(tokens):
        if tokens[place] == "[":
            place = _closing(tokens, place)
        flops += _token_flops(tokens, place)
        place += 1
    return flops


def _token_flops(tokens: Sequence[str], place: int) -> Flops:
    token = tokens[place]
    if token in BINARY and place and _ends_operand(tokens, place) and _in_value(tokens, place):
        return Flops(**{BINARY[token]: 1})
    if token[0] in BINARY and token[1:] == "=":
        return Flops(**{BINARY[token[0]]: 1})
    if token in FUNCTIONS:
        return Flops(**{token: 1})
    if token == "casadi_sq":
        return Flops(mul=1)
    return _power_flops(tokens, place) if token == "pow" else Flops()


def _in_value(tokens: Sequence[str], place: int) -> bool:
    """Tell whether a place is after ``=``, ``return`` or a call's bracket in its statement."""
    while place and tokens[place - 1] not in {";", "{", "}"}:
        place -= 1
        token = tokens[place]
        called = token == "(" and re.match(r"[A-Za-z_]", tokens[place - 1])
        if called or token == "return" or (token[-1] == "=" and token not in COMPARISONS):
            return True
    return False


def _ends_operand(tokens: Sequence[str], place: int) -> bool:
    """Tell whether the token before an operator can be its left operand, or is a cast."""
    before = tokens[place - 1]
    if before == ")":
        return not (tokens[place - 2] in TYPES and tokens[place - 3] == "(")
    return before == "]" or (bool(re.match(r"[\w.]", before)) and before not in TYPES | {"return"})


def _power_flops(tokens: Sequence[str], place: int) -> Flops:
    """Count an integer power as the products it stands for; leave any other to ``pow``."""
    inside = list(tokens[place + 2 : _closing(tokens, place + 1)])
    exponent = "".join(inside[_last_comma(inside) + 1 :]).removeprefix("Scalar")
    number = re.fullmatch(r"\(?(-?)(\d+)(?:\.0*)?\)?", exponent)
    if not number:
        return Flops(pow=1)
    sign, size = number.groups()
    return Flops(mul=max(int(size) - 1, 0), div=1 if sign else 0)


def _last_comma(tokens: Sequence[str]) -> int:
    depth = 0
    for place in range(len(tokens) - 1, -1, -1):
        depth += (tokens[place] in ")]") - (tokens[place] in "([")
        if tokens[place] == "," and depth == 0:
            return place
    raise ValueError("pow needs two arguments")
