"""The counter of operations: right on what each tool writes, and alert to a wrong count."""

import pytest

from bench.contest import operations
from bench.flops import Flops, count
from bench.handwritten import candidate
from bench.problem import PROBLEMS

SNIPPETS = {
    "signs are free": ("y[0] = -x[0]; y[1] = -(-x[1]); y[2] = (-x[0]) * -x[1];", Flops(mul=1)),
    "indices are free": ("y[2 * 3 + 1] = x[i - 1] + x[i + 1];", Flops(add=1)),
    "exponents are no signs": ("y[0] = 1.0e-3 * x[0] - 2.5E+2;", Flops(sub=1, mul=1)),
    "pointers are no products": ("const double *p = x; double **q; y[0] = *p * *x;", Flops(mul=1)),
    "casts are no operands": ("y[0] = (double)-x[0] + (double)+x[1];", Flops(add=1)),
    "assignments that operate": ("y[0] += x[0]; y[0] *= x[1]; y[0] /= 3.0;", Flops(1, 0, 1, 1)),
    "steps are free": ("int i = 0; i++; --i; p->x = x[0];", Flops()),
    "a square is a product": ("y[0] = pow(x[0] + x[1], 2);", Flops(add=1, mul=1)),
    "a cube is two products": ("y[0] = std::pow(x[0], Scalar(3));", Flops(mul=2)),
    "a negative power divides": ("y[0] = pow(x[0], -2);", Flops(mul=1, div=1)),
    "a real power stays": ("y[0] = pow(x[0], 0.5);", Flops(pow=1)),
    "casadi_sq is a product": ("a0=casadi_sq(a1); a2=(a0-a1);", Flops(sub=1, mul=1)),
    "functions": ("y[0] = sin(x[0]) * cos(x[1]);", Flops(mul=1, sin=1, cos=1)),
    "functions of C++": ("y[0] = std::sqrt(x[2]) + std::tan(1.0);", Flops(add=1, sqrt=1, tan=1)),
    "comments hold no code": ("/* a + b */ y[0] = x[0]; // c * d", Flops()),
    "nothing asked": ("a0=arg[0]? arg[0][1] : 0; if (res[0]!=0) res[0][0]=a0;", Flops()),
    "a call's arguments": ("f(x[0] * x[1], &y[3 + 4]);", Flops(mul=1)),
}
TARGETS = {
    "free_body": 40,
    "free_body_principal": 12,
    "heavy_top": 9,
    "gyrostat": 64,
    "rigid_body": 96,
    "rigid_body_jacobian": 172,
    "rigid_body_jacobian_dense": 172,
}


@pytest.mark.parametrize(("text", "flops"), SNIPPETS.values(), ids=SNIPPETS)
def test_a_snippet_is_counted_right(text: str, flops: Flops) -> None:
    assert count(f"void f(const double *x, double *y)\n{{\n{text}\n}}\n", ["f"]) == flops


def test_only_the_named_functions_are_counted() -> None:
    text = "double g(double a) { return a * a; }\nvoid f(double *y) { y[0] = g(y[1]) + 1; }"
    assert count(text, ["f"]) == Flops(add=1)
    assert count(text, ["f", "g"]) == Flops(add=1, mul=1)


def test_a_declaration_is_not_the_function() -> None:
    assert count("double f(double a);\ndouble f(double a) { return a / 3; }", ["f"]).div == 1


def test_one_more_operation_is_noticed() -> None:
    one = candidate(PROBLEMS[0])
    functions = one.counted[1]
    text = one.sources[0].text
    assert count(text.replace("M[0] -", "M[0] + M[0] -"), functions).total == 41
    assert count(text.replace("k->k_xx * b_x", "b_x"), functions).total == 39


def test_a_loop_is_refused() -> None:
    with pytest.raises(ValueError, match="'f' has a loop"):
        count("void f(double *y) { for (int i = 0; i < 3; i++) { y[i] = y[i] * 2; } }", ["f"])


def test_a_missing_function_is_refused() -> None:
    with pytest.raises(ValueError, match="no definition of 'g'"):
        count("void f(void) {}", ["g"])


@pytest.mark.parametrize("problem", PROBLEMS, ids=lambda p: p.name)
def test_the_handwritten_minimum_reaches_the_known_count(problem) -> None:
    flops = operations(candidate(problem))
    assert flops.total <= TARGETS[problem.name]
    assert flops.div == (1 if problem.name in {"heavy_top", "gyrostat"} else 0)
