"""The grammar of formulas: exact, strict, and unable to fail but by its own sentence."""

from contextlib import suppress
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from derive.scene.formula import (
    FLOATS,
    FUNCTIONS,
    ONE,
    ZERO,
    Formula,
    FormulaError,
    apply,
    evaluate,
    number,
    substitute,
    symbol,
    symbols,
)
from derive.scene.grammar import parse

EXACT = {**FLOATS, "number": lambda value: value}
VALUES = {"a": Fraction(2, 3), "b": Fraction(-5, 7), "c": Fraction(11, 13)}


def combined(parts: st.SearchStrategy[Formula]) -> st.SearchStrategy[Formula]:
    """Return formulas one operator taller; those without a value are left out."""

    def joined(first: Formula, second: Formula, operator: str, exponent: int) -> Formula:
        try:
            match operator:
                case "add":
                    return first + second
                case "sub":
                    return first - second
                case "mul":
                    return first * second
                case "div":
                    return first / second
                case "neg":
                    return -first
                case "power":
                    return first**exponent
            return apply(operator, first)
        except FormulaError:
            return first

    operators = ("add", "sub", "mul", "div", "neg", "power", *FUNCTIONS)
    return st.builds(joined, parts, parts, st.sampled_from(operators), st.integers(-4, 4))


LEAVES = st.sampled_from(["a", "b", "c"]).map(symbol) | st.fractions(
    min_value=-20, max_value=20, max_denominator=20
).map(number)
FORMULAS = st.recursive(LEAVES, combined, max_leaves=12)
POLYNOMIALS = st.recursive(
    LEAVES,
    lambda parts: st.one_of(
        st.builds(lambda x, y: x + y, parts, parts),
        st.builds(lambda x, y: x - y, parts, parts),
        st.builds(lambda x, y: x * y, parts, parts),
        st.builds(lambda x: -x, parts),
    ),
    max_leaves=12,
)


@given(FORMULAS)
def test_a_formula_that_is_printed_and_read_again_is_the_same(formula: Formula) -> None:
    assert parse(str(formula)) == formula


@given(POLYNOMIALS)
def test_python_itself_reads_the_same_value_from_a_printed_polynomial(formula: Formula) -> None:
    """An independent reading: Python's own grammar, on text that only this test wrote."""
    one = "Fraction(1)"
    text = f"{one}*({formula})".replace("/", f"*{one}/")
    found = eval(text, {"Fraction": Fraction, **VALUES})  # noqa: S307
    assert evaluate(formula, VALUES, EXACT) == found


@pytest.mark.long
@given(st.text())
def test_any_text_is_a_formula_or_a_formula_error(text: str) -> None:
    with suppress(FormulaError):
        assert str(parse(text))


@given(st.text(alphabet="ab019.eE+-*/^() \tsincoqrtπ_,[]=", max_size=60))
def test_any_text_of_the_grammar_s_letters_is_a_formula_or_a_formula_error(text: str) -> None:
    with suppress(FormulaError):
        assert parse(str(parse(text))) == parse(text)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("0.1", Fraction(1, 10)),
        (".5", Fraction(1, 2)),
        ("1.25e-3", Fraction(1, 800)),
        ("1E3", Fraction(1000)),
        ("-2^2", Fraction(-4)),
        ("2**-3", Fraction(1, 8)),
        ("7 - 2 - 1", Fraction(4)),
        ("8/4/2", Fraction(1)),
        ("2*3 + 4*5", Fraction(26)),
        ("(1 + 2)*3", Fraction(9)),
        ("3 - -4", Fraction(7)),
        ("sqrt(9/4)", Fraction(3, 2)),
        ("cos(0)", Fraction(1)),
    ],
)
def test_numbers_are_exact_and_fold(text: str, value: Fraction) -> None:
    assert parse(text) == number(value)


@pytest.mark.parametrize(
    "text", ["0", "0*a", "a*0", "0/a", "a*(1 - 1)", "sin(0)", "tan(0)*a", "-0", "0.0e7", "0^3"]
)
def test_what_vanishes_is_the_number_zero(text: str) -> None:
    assert parse(text) == ZERO


@pytest.mark.parametrize("text", ["1*a", "a*1", "a/1", "a + 0", "0 + a", "a - 0", "a^1", "-(-a)"])
def test_what_changes_nothing_leaves_no_trace(text: str) -> None:
    assert parse(text) == symbol("a")


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "at 1: expected a number, a symbol or '(', found the end"),
        ("a b", "at 3: expected an operator or the end, found 'b'"),
        ("2a", "at 2: expected an operator or the end, found 'a'"),
        ("a +* b", "at 4: expected a number, a symbol or '(', found '*'"),
        ("(a", "at 3: expected ')', found the end"),
        ("a)", "at 2: expected an operator or the end, found ')'"),
        ("a^b", "at 3: expected a whole number as exponent, found 'b'"),
        ("a^0.5", "at 3: expected a whole number as exponent, found '0.5'"),
        ("a^2^3", "at 4: expected one power at a time (use parentheses), found '^'"),
        ("--a", "at 2: expected one sign, found '-'"),
        ("exp(a)", "at 1: expected one of sin, cos, tan, sqrt before '(', found 'exp'"),
        ("sin", "at 1: expected a number, a symbol or '(', found 'sin'"),
        ("a; b", "at 2: ';' is no part of a formula"),
        ("__import__('os')", "at 1: '_' is no part of a formula"),
        ("α", "at 1: 'α' is no part of a formula"),
        ("a/0", "at 2: divides by zero"),
        ("a/(1 - 1)", "at 2: divides by zero"),
        ("0^0", "0^0 has no value"),
        ("0^-1", "0^-1 has no value"),
        ("sqrt(-1)", "the square root of -1 has no value"),
        ("a^17", "exponent 17 is beyond 16"),
        ("1e301", "at 1: exponent beyond 300"),
        ("((9^16)^16)^16", "a number has more than 4096 bits"),
        ("a" * 1001, "is 1001 characters long; 1000 is the most"),
        ("(" * 100 + "a" + ")" * 100, "at 31: nested deeper than 30"),
        ("+".join("a" * 200), "joins more than 100 terms in one chain; use parentheses"),
    ],
)
def test_what_is_no_formula_is_refused_with_its_place(text: str, says: str) -> None:
    with pytest.raises(FormulaError) as refusal:
        parse(text)
    assert str(refusal.value) == says


def test_symbols_come_in_order_of_first_appearance() -> None:
    assert symbols(parse("c*a + sin(b)*a/c")) == ("c", "a", "b")


def test_a_substitution_folds_what_becomes_constant() -> None:
    formula = parse("a*b + cos(c)^2 - a/2")
    assert substitute(formula, {"a": ZERO, "c": ZERO}) == ONE
    assert substitute(formula, {}) == formula


def test_evaluation_uses_the_arithmetic_it_is_given() -> None:
    words = {name: lambda *parts, name=name: (name, *parts) for name in FLOATS}
    assert evaluate(parse("a^2/3"), {"a": "a"}, words) == (
        "div",
        ("power", "a", 2),
        ("number", Fraction(3)),
    )
