"""From a rate to its Taylor step: the state's terms up to an order, their sum, the next step."""

from collections.abc import Sequence
from fractions import Fraction

from derive.motion.runge_kutta.system import TIME_STEP, next_of
from derive.motion.taylor.proposal import PROPOSED, next_length
from derive.motion.taylor.recurrences import Recurrences, record
from derive.motion.taylor.series import TaylorStep
from derive.program.program import Op, Operand, Program, Quantity


def taylor_step(
    rate: Program,
    states: tuple[Quantity, ...],
    inputs: tuple[Quantity, ...],
    order: int,
    time_step: Quantity = TIME_STEP,
) -> TaylorStep:
    """Return the step of ``order`` terms of a state whose rate is ``rate``.

    rate : its outputs' components are the rates of the states' components, in their order
    inputs : what else the rate may read; it is held while the step lasts
    Raises ValueError for an operation that has no recurrence here.
    """
    names = [c for q in states for c in q.components]
    rates = {x: r for x, r in zip(names, rate.results, strict=True) if r != 0}
    recurrences = _recurrences(rate, set(rates))
    varying = {
        x: (r, recurrences.term(r) if recurrences.varies(r) else Fraction(0))
        for x, r in rates.items()
    }
    close, proposed = _close(order, states, tuple(varying))
    step = TaylorStep(
        name="step_taylor" if order == 20 else f"step_taylor{order}",
        says=f"One step by a Taylor series of order {order}.",
        inputs=(*_read(rate, states, inputs), time_step),
        outputs=(*map(next_of, states), PROPOSED),
        order=order,
        start=tuple(recurrences.start),
        products=tuple(recurrences.products),
        squares=tuple(recurrences.squares),
        each=tuple(recurrences.each),
        kept=tuple(recurrences.kept),
        rates=varying,
        close=close,
        results=(*(_after(x) if x in varying else x for x in names), proposed),
    )
    _refuse_clashes(step)
    return step


def _recurrences(rate: Program, varying: set[str]) -> Recurrences:
    """Return the terms of every operation of a rate, of which these components move."""
    recurrences = Recurrences(varying, _joining(rate))
    for op in rate.ops:
        if not isinstance(op, Op):
            raise ValueError(f"'{rate.name}' has a loop, of which there is no Taylor series")
        record(recurrences, op, rate.ops)
    return recurrences


def _read(
    rate: Program, states: tuple[Quantity, ...], inputs: tuple[Quantity, ...]
) -> tuple[Quantity, ...]:
    """Return what a step reads: the constants, the state, and the inputs that its rate reads."""
    constants = [q for q in rate.inputs if q.role == "constants"]
    return (*constants, *states, *(q for q in inputs if q in rate.inputs))


def _close(
    order: int, states: tuple[Quantity, ...], varying: Sequence[str]
) -> tuple[tuple[Op, ...], str]:
    """Return the operations that add the terms and propose a step, and the proposal's name."""
    sums = [Op(_after(x), "add", (x, f"{x}_sum")) for x in varying]
    ops, proposed = next_length(order, [[c for c in q.components if c in varying] for q in states])
    return (*sums, *ops), proposed


def _after(component: str) -> str:
    return f"{component}_after"


def _joining(rate: Program) -> frozenset[str]:
    """Return the values that one operation alone reads, and that operation adds or divides."""
    readers: dict[Operand, list[str]] = {result: ["result"] for result in rate.results}
    for op in rate.ops:
        if isinstance(op, Op):
            for place, operand in enumerate(op.operands):
                divides = op.operator == "div" and place == 0
                kind = "add" if divides or op.operator in ("add", "sub", "neg") else op.operator
                readers.setdefault(operand, []).append(kind)
    return frozenset(str(value) for value, kinds in readers.items() if kinds == ["add"])


def _refuse_clashes(step: TaylorStep) -> None:
    """Refuse a state or an input that is called as something of ours is."""
    given = {c for q in step.inputs for c in q.components}
    ours = [op.result for op in (*step.start, *step.each, *step.close)]
    ours += [c.result for c in (*step.products, *step.squares)]
    twice = given.intersection(ours) | {name for name in ours if ours.count(name) > 1}
    if twice:
        raise ValueError(f"'{min(twice)}' is also the name of a value of the Taylor step")
