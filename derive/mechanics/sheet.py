"""The working sheet of a machine: named quantities in order, and how each changes in time.

What moves has a rate; the rate of a named quantity follows from its definition by the chain rule.
Accelerations that are to be found, and reactions, enter every expression linearly.
"""

from collections.abc import Iterable, Mapping
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, field

from sympy import Add, Expr, Integer, Matrix, Mul, Symbol

from derive.scene import SceneError

AXES = "xyz"
Split = tuple[Expr, Mapping[Symbol, Expr]]  # what is left without unknowns, their coefficients


@dataclass
class Sheet:
    """Symbols by name, definitions in order, rates of what moves, and the unknowns.

    because : the lecture steps that named quantities follow by
    """

    symbols: dict[str, Symbol]
    rates: dict[Symbol, Expr]
    unknowns: frozenset[Symbol]
    rateless: Mapping[Symbol, str]
    definitions: dict[Symbol, Expr] = field(default_factory=dict)
    labels: dict[Expr, Symbol] = field(default_factory=dict)
    parts: dict[Expr, Split] = field(default_factory=dict)
    because: dict[Symbol, list[str]] = field(default_factory=dict)

    def symbol(self, name: str) -> Symbol:
        """Return the symbol of a name, a new one if there is none yet."""
        if name not in self.symbols:
            self.symbols[name] = Symbol(f"s{len(self.symbols):04d}")
        return self.symbols[name]

    def named(self, label: str, value: Expr, step: str = "") -> Expr:
        """Return a symbol for ``value``, unless it is plain already or holds an unknown.

        step : of the lecture, by which it is so
        """
        if _plain(value) or value.free_symbols & self.unknowns:
            return value
        if value not in self.labels:
            name, place = label, 1
            while name in self.symbols:
                name, place = f"{label}#{place + 1}", place + 1
            self.labels[value] = self.symbol(name)
            self.definitions[self.labels[value]] = value
        self.because.setdefault(self.labels[value], []).extend([step] if step else [])
        return self.labels[value]

    def linear(self, label: str, value: Expr, step: str = "") -> Expr:
        """Return ``value`` with its rest and every coefficient of an unknown named."""
        rest, slopes = self.split(value)
        total = self.named(label, rest, step)
        for unknown, slope in slopes.items():
            total += self.named(f"{label}.by.{self.label(unknown)}", slope, step) * unknown
        return total

    def column(self, label: str, values: Matrix, step: str = "") -> Matrix:
        """Return a column with every component named, unknowns kept outside."""
        each = zip(AXES, values, strict=True)
        return Matrix([self.linear(f"{label}.{a}", v, step) for a, v in each])

    def steps(self, values: Iterable[Expr]) -> tuple[str, ...]:
        """Return the lecture steps that the named quantities below ``values`` follow by."""
        below = self.needed(values)
        return tuple(dict.fromkeys(s for named in below for s in self.because.get(named, ())))

    def label(self, symbol: Symbol) -> str:
        """Return the name of a symbol."""
        return next(name for name, own in self.symbols.items() if own == symbol)

    def split(self, value: Expr) -> Split:
        """Return the part of ``value`` without unknowns, and each unknown's coefficient."""
        if value not in self.parts:
            own = split(value, self.unknowns)
            if any(slope.free_symbols & self.unknowns for slope in own[1].values()):
                found = sorted(value.free_symbols & self.unknowns, key=str)
                names = ", ".join(map(self.label, found))
                raise SceneError(f"unknowns must enter a load linearly, but {names} are multiplied")
            self.parts[value] = own
        return self.parts[value]

    def rate(self, value: Expr) -> Expr:
        """Return the time derivative of ``value`` by the chain rule."""
        total: Expr = Integer(0)
        for symbol in sorted(value.free_symbols, key=str):
            dot = self._rate_of(symbol)
            if dot != 0:
                total += value.diff(symbol) * dot
        return total

    def rate_of_column(self, values: Matrix) -> Matrix:
        """Return the rates of a column's components."""
        return values.applyfunc(self.rate)

    def _rate_of(self, symbol: Symbol) -> Expr:
        if symbol in self.rateless:
            raise SceneError(f"{self.rateless[symbol]}, so it cannot say how anything moves")
        if symbol not in self.rates:
            own = self.definitions.get(symbol)
            label = f"{self.label(symbol)}.dot" if own is not None else ""
            self.rates[symbol] = Integer(0) if own is None else self.linear(label, self.rate(own))
        return self.rates[symbol]

    def needed(self, values: Iterable[Expr]) -> dict[Symbol, Expr]:
        """Return the definitions that ``values`` stand on, each after those it is made of."""
        return below(self.definitions, values)


def below(definitions: Mapping[Symbol, Expr], values: Iterable[Expr]) -> dict[Symbol, Expr]:
    """Return those of ``definitions`` that ``values`` stand on, in their order."""
    wanted: set[Symbol] = set()
    waiting = [s for value in values for s in value.free_symbols]
    while waiting:
        symbol = waiting.pop()
        if symbol in definitions and symbol not in wanted:
            wanted.add(symbol)
            waiting += definitions[symbol].free_symbols
    return {s: value for s, value in definitions.items() if s in wanted}


def _plain(value: Expr) -> bool:
    return bool(value.is_Symbol or value.is_Number or (-value).is_Symbol)


def split(value: Expr, unknowns: AbstractSet[Symbol]) -> Split:
    """Return the part of ``value`` without unknowns, and the coefficients that are not zero."""
    found = sorted(value.free_symbols & unknowns, key=str)
    if not found:
        return value, {}
    slopes = _slopes(value, frozenset(found))
    rest = value.xreplace(dict.fromkeys(found, Integer(0)))
    return rest, {u: slopes[u] for u in found if slopes.get(u, 0) != 0}


def _slopes(value: Expr, unknowns: AbstractSet[Symbol]) -> dict[Symbol, Expr]:
    """Return the slope of a value by each of the unknowns, of sums and products part by part."""
    held = value.free_symbols & unknowns
    if value.is_Add:
        parts = [_slopes(a, held) for a in value.args if a.free_symbols & held]
        return {u: Add(*(own[u] for own in parts if u in own)) for u in held}
    varying = [a for a in value.args if a.free_symbols & held]
    if value.is_Mul and len(varying) == 1:
        others = Mul(*(a for a in value.args if a is not varying[0]))
        return {u: others * slope for u, slope in _slopes(varying[0], held).items()}
    return {u: value.diff(u) for u in held}
