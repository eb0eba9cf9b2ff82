"""Formulas over numbers become operations: folded where exact, recorded once, never re-ordered."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from derive.emit.c.text import float_body
from derive.emit.casadi_text import plain_lines
from derive.program.arithmetic import working
from derive.program.indexed import Assign, Index, Loop
from derive.program.operations import at_most, less, select
from derive.program.precision import F32, F64
from derive.program.program import Line, Op, Program, Quantity
from derive.program.recorded import called, needed, repeat
from derive.program.run import run
from derive.program.tape import Number, Tape, named, number, operation

X = Quantity("x", ("x_0", "x_1"), (2,), "1", "", None, None, "two numbers")
Y = Quantity("y", ("y",), (), "1", "", None, None, "what comes out")


def tapes() -> tuple[Tape, Tape]:
    setup = Tape("p")
    return setup, Tape("t", below=setup)


def program(tape: Tape, result: Number) -> Program:
    ops = needed(tape.ops, (result.operand,))
    return Program("f", "says", (X,), (Y,), ops, (result.operand,))


def root_by_newton(tape: Tape, passes: int) -> Program:
    """Return the square root of x_0^2 + x_1^2 by Newton's method, from above, in a loop."""
    a, b = (tape.input(c) for c in X.components)
    square = a * a + b * b

    def one_pass(carried: list[Number]) -> tuple[list[Number], Number]:
        (root,) = carried
        new = (root + square / root) / 2
        return [new], at_most(root, new)

    (root,) = repeat(tape, passes, [square + 1], one_pass)
    return program(tape, root)


def test_exact_numbers_fold_and_leave_no_operation() -> None:
    _, tape = tapes()
    x = tape.input("x_0")
    assert (x * 1 + 0) - 0 == x
    assert (x * 0 + Fraction(1, 2) * 4).exact == 2
    assert (0 / x).exact == 0
    assert tape.ops == []


def test_an_operation_is_recorded_once_whatever_the_order_of_a_sum() -> None:
    _, tape = tapes()
    a, b = tape.input("x_0"), tape.input("x_1")
    assert a + b == b + a
    assert (a - b) != (b - a)
    assert len(tape.ops) == 3


def test_a_rounding_error_is_not_folded_away() -> None:
    _, tape = tapes()
    a, b = tape.input("x_0"), tape.input("x_1")
    lost = b - ((a + b) - a)
    (found,) = run(program(tape, lost), working(np.float64), [1.0, 2.0**-60])
    assert found == 2.0**-60


def test_what_rests_on_parameters_goes_to_set_up_under_its_name() -> None:
    setup, tape = tapes()
    I = setup.input("I")  # noqa: E741
    half = named("half_I", I / 2, "half of I")
    result = half * tape.input("x_0") + I
    assert [op.operator for op in setup.ops if isinstance(op, Op)] == ["div"]
    assert setup.names == {"p0": ("half_I", "half of I"), "I": ("I", "")}
    assert tape.ops[0] == Op("t0", "mul", ("half_I", "x_0"))
    assert result.operand == "t1"


def test_two_constants_do_not_share_a_name() -> None:
    setup, _ = tapes()
    I = setup.input("I")  # noqa: E741
    named("k", I * 2, "")
    named("k", I * 3, "")
    assert [name for name, _ in setup.names.values()] == ["k", "k2"]


def test_a_value_of_another_function_is_refused() -> None:
    _, tape = tapes()
    _, other = tapes()
    with pytest.raises(ValueError, match="'x_0' belongs to another function"):
        operation("add", tape.input("x_0"), other.input("x_0"))


@pytest.mark.parametrize("precision", [F32, F64])
def test_a_loop_ends_when_it_is_done_and_means_the_same_unrolled(precision) -> None:
    _, tape = tapes()
    made = root_by_newton(tape, 60)
    given = [np.array([3.0, 1e3, 0.5], precision.dtype), np.array([4.0, 1.0, 0.0], precision.dtype)]
    found = run(made, working(precision.dtype), given)[0]
    assert np.allclose(found, np.hypot(*given), rtol=4 * precision.unit_roundoff)
    longer = replace(made, ops=tuple(_longer(line) for line in made.ops))
    assert np.array_equal(run(longer, working(precision.dtype), given)[0], found)


def _longer(line: Line) -> Line:
    return replace(line, last=Index(plus=2 * line.last.plus)) if isinstance(line, Loop) else line


def test_a_loop_that_ends_early_changes_only_what_it_carries() -> None:
    change = Assign("total", "x", "add")
    with pytest.raises(ValueError, match="must carry what it changes"):
        Loop(
            "",
            Index(),
            Index(plus=3),
            (change,),
            carried=("x",),
            start=("y",),
            then=("x",),
            done="z",
        )


def test_a_loop_counts_all_its_passes() -> None:
    _, tape = tapes()
    assert root_by_newton(tape, 60).flops() == 3 + 1 + 60 * 3


def test_the_same_loop_is_recorded_once_and_another_is_not() -> None:
    _, tape = tapes()
    x = tape.input("x_0")

    def halved(by: int):
        return repeat(tape, 5, [x], lambda c: ([c[0] / by], less(c[0], 1)))[0]

    assert halved(2) == halved(2)
    assert halved(2) != halved(3)
    assert len([line for line in tape.ops if isinstance(line, Loop)]) == 2


def test_a_loop_is_printed_as_a_loop() -> None:
    _, tape = tapes()
    made = root_by_newton(tape, 60)
    text = "\n".join(float_body(made, "f", F64))
    assert "for (int pass_t" in text
    assert "< 60;" in text
    assert "break;" in text
    assert "for _ in range(60):" in "\n".join(plain_lines(made, {})[0])


def test_what_no_result_rests_on_is_left_out() -> None:
    _, tape = tapes()
    a, b = tape.input("x_0"), tape.input("x_1")
    repeat(tape, 3, [a], lambda c: ([c[0] * b], None))
    assert len(needed(tape.ops, ((a + b).operand,))) == 1


def test_a_program_is_recorded_where_it_is_called() -> None:
    _, tape = tapes()
    a, b = tape.input("x_0"), tape.input("x_1")
    inner = program(tape, a * b)
    _, other = tapes()
    (result,) = called(other, inner, {"x_0": other.input("u"), "x_1": number(3)})
    assert other.ops == [Op("t0", "mul", ("u", Fraction(3)))]
    assert result.operand == "t0"


def test_equal_choices_are_no_choice() -> None:
    _, tape = tapes()
    a = tape.input("x_0")
    condition = less(a, 0)
    assert select(condition, a, a) == a
    found = run(program(tape, select(condition, -a, a)), working(np.float64), [np.array([-2.0]), 0])
    assert found[0] == 2.0
