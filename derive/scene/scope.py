"""Formulas of a scene file, read strictly: in symbols that may stand there, of the right unit.

Names of ``[formulas]`` are written out where they stand: what comes after never meets them.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from derive.scene.declaration import SceneError, Triple
from derive.scene.escape import brief
from derive.scene.formula import Formula, FormulaError, number, substitute, symbols
from derive.scene.grammar import TALLEST_TREE, height, parse
from derive.scene.table import nearest, rational, shown
from derive.scene.unit import Dimension, UnitError, dimension_of, spelled

LARGEST_SIZE = 2000
"""Operations and operands of a formula that is written out; one text has some hundred."""


@dataclass(frozen=True)
class Scope:
    """The symbols that a formula may use, and the scene's others with what they are.

    meanings : what those of them stand for that are names of formulas
    """

    dimensions: Mapping[str, Dimension]
    others: Mapping[str, str]
    rule: str
    meanings: Mapping[str, Formula] = field(default_factory=dict)


def formula(value: object, label: str, scope: Scope, expected: Dimension) -> Formula:
    """Return a formula in known symbols and of the expected dimension.

    A plain number stands for itself in the SI unit of the quantity.
    """
    read, found = _measured(value, label, scope)
    if found is not None and found != expected and read.operator != "number":
        raise SceneError(
            f"{label} = '{brief(read)}' is in {spelled(found)}, not {spelled(expected)}"
        )
    return without_names(read, label, scope.meanings)


def measured(value: object, label: str, scope: Scope) -> tuple[Formula, Dimension | None]:
    """Return a formula in known symbols and its dimension, None where it is 0 in any unit."""
    read, found = _measured(value, label, scope)
    return without_names(read, label, scope.meanings), found


def _measured(value: object, label: str, scope: Scope) -> tuple[Formula, Dimension | None]:
    read = as_formula(value, label)
    check_symbols(read, label, scope)
    try:
        return read, dimension_of(read, scope.dimensions)
    except UnitError as error:
        raise SceneError(f"{label}: {error}") from None


def as_formula(value: object, label: str) -> Formula:
    """Return a formula as it is written, whatever its symbols are."""
    try:
        if isinstance(value, str):
            return parse(value)
        return replace(number(rational(value, label)), written=str(value))
    except FormulaError as error:
        raise SceneError(f"{label} = {shown(value)}: {error}") from None


def check_symbols(read: Formula, label: str, scope: Scope) -> None:
    """Refuse a formula with a symbol that may not stand there, or that nothing declares."""
    for name in symbols(read):
        if name in scope.others:
            raise SceneError(f"{label} uses '{name}', {scope.others[name]}; {scope.rule}")
        if name not in scope.dimensions:
            rule = f"which the scene does not declare{nearest(name, scope.dimensions)}"
            raise SceneError(f"{label} uses '{brief(name)}', {rule}")


def without_names(read: Formula, label: str, meanings: Mapping[str, Formula]) -> Formula:
    """Return a formula with names of formulas replaced by what they stand for.

    Raises SceneError for one that would be too large, or that then has no value.
    """
    if meanings.keys().isdisjoint(symbols(read)):
        return read
    sizes = {name: size(own) for name, own in meanings.items()}
    if (large := size(read, sizes)) > LARGEST_SIZE:
        says = f"written out it has {large:.3g} operations and operands; {LARGEST_SIZE} is the most"
        raise SceneError(f"{label} = '{brief(read)}': {says}")
    try:
        made = substitute(read, meanings)
    except FormulaError as error:
        raise SceneError(f"{label} = '{brief(read)}': written out it {error}") from None
    if height(made) > TALLEST_TREE:
        says = f"written out it joins more than {TALLEST_TREE} terms in one chain"
        raise SceneError(f"{label} = '{brief(read)}': {says}")
    return replace(made, written=read.as_written)


def size(read: Formula, sizes: Mapping[str, int] | None = None) -> int:
    """Return how many operations and operands a formula has; symbols of ``sizes`` have theirs."""
    found = sizes.get(read.name, 1) if sizes and read.operator == "symbol" else 1
    for part in read.operands:
        found += size(part, sizes)
    return found


def triple(value: object, label: str, scope: Scope, expected: Dimension) -> Triple:
    """Return three formulas along x, y and z."""
    x, y, z = formulas(value, label, "xyz", scope, expected)
    return x, y, z


def formulas(
    value: object, label: str, names: Sequence[str], scope: Scope, expected: Dimension
) -> tuple[Formula, ...]:
    """Return a formula for each of some names, such as x, y and z."""
    if not isinstance(value, list) or len(value) != len(names):
        which = f" ({', '.join(names)})" if len(names[0]) > 1 else ""
        raise SceneError(f"{label} must be a list of {len(names)}{which}, not {shown(value)}")
    return tuple(
        formula(part, f"{label}.{name}", scope, expected)
        for part, name in zip(value, names, strict=True)
    )
