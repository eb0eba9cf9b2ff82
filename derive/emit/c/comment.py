"""The comment block of a C function: given, returned, postcondition, error, cost, reasons."""

from collections.abc import Sequence
from textwrap import wrap

from derive.emit.notation import equation_text
from derive.emit.on_target import OPTIMISED, Cost
from derive.lecture.chapters import LECTURE
from derive.motion.runge_kutta.system import FLOW, NEXT
from derive.program.program import Bound, Measurement, Program, Quantity, Singular
from derive.program.status import possible
from derive.scene.escape import in_comment
from derive.scene.unit import behind

SETUP_ERROR = (
    "each constant is worked out in twice the working precision and rounded once: at most 1 ulp, "
    "unless the sum that it is cancels to less than 16 u of its largest product"
)
OF_ONE_BODY = ("F", "M", "T", "K", "l", "l_dot", "l_N_dot")
"""What stands on the left of equations of a body; the others are about axes and points."""
MOMENTS = {
    "general_form": "M about G, a point at rest, or one that accelerates along the line to G",
    "moving_point_form": "M about any point that the body carries",
    "any_point_form": "M about any point, M_G about G",
}
"""About which points the moments of equations are."""

BOUND_OF_WHAT = "absolute, by rounding alone, on the whole ranges"
"""What proved bounds are of: any component, parameters and inputs being floats."""
WITH_POTENTIAL = ("energy", "potential_energy")
WIDTH = 96


def comment(
    program: Program,
    figures: Sequence[Measurement],
    bodies: int,
    costs: Sequence[Cost] = (),
    potential: str = "",
    here: Sequence[str] = (),
) -> str:
    """Return the comment block of ``program`` of a scene of so many bodies, as C text.

    costs : what it costs on cores, as far as is known
    here : what it returns in this scene, equations in its arguments
    potential : how the scene counts the potential energy, "" if it has none
    """
    lines = [program.says, *_arguments(program), *_postconditions(program, bodies)]
    lines += [line for each in here for line in _labelled("In this scene:", each)]
    if potential and any(q.name in WITH_POTENTIAL for q in program.outputs):
        lines += _labelled("Energy:", potential)
    if program.makes("constants"):
        says = "; ".join(f"{number} {words}" for number, words in possible(program).items())
        lines += _labelled("Returns:", f"{says}.") + _labelled("Error:", f"{SETUP_ERROR}.")
        more = 2 * sum(rule.relation == "within" for rule in program.rules)
        compared = f", and {more} comparisons with the ends of ranges" if more else ""
        lines += _labelled("Cost:", f"once; {program.flops()} operations on pairs{compared}.")
        lines += _on_cores(costs)
    else:
        lines += _labelled("Error:", _error(program, figures))
        lines += [x for told in bound_clauses(program, figures) for x in _labelled("Bound:", told)]
        pairs = " (on pairs of floats)" if program.arithmetic == "pairs" else ""
        lines += [
            line
            for s in program.singular
            for line in _labelled("Singular:", f"{singular_clause(s)}.")
        ]
        lines += _labelled("Cost:", cost_line(program) + pairs + ".") + _on_cores(costs)
        if program.assumptions:
            lines += _labelled("Rests on:", ", ".join(program.assumptions) + ".")
    return _block(lines)


def dense_comment(entries: int, costs: Sequence[Cost]) -> str:
    """Return the comment of a function that fills the whole matrix."""
    says = f"The same, the whole matrix: {entries} entries."
    return _block([says, *_on_cores(costs)]) if costs else f"/* {says} */"


def _block(lines: Sequence[str]) -> str:
    text = "\n".join(f" * {in_comment(line)}".rstrip() for line in lines)
    return f"/*{text[2:]}\n */"


def _on_cores(costs: Sequence[Cost]) -> list[str]:
    return [
        line
        for cost in costs
        for line in _labelled(f"On {cost.title}, {OPTIMISED}:", f"{cost.says}.")
    ]


def wrapped(sentence: str) -> list[str]:
    """Return the lines of a sentence of a header's comment."""
    return wrap(sentence, WIDTH, subsequent_indent="  ", break_long_words=False)


def _labelled(label: str, text: str) -> list[str]:
    return wrap(f"{label} {text}", WIDTH, subsequent_indent=" " * 11, break_long_words=False)


def _arguments(program: Program) -> list[str]:
    given = [_line(q, _range(q)) for q in program.inputs]
    returned = [_line(q, "") for q in program.outputs]
    return [
        f"{label if place == 0 else '':11}{text}"
        for label, texts in (("Given:", given), ("Returned:", returned))
        for place, text in enumerate(texts)
    ]


def _line(q: Quantity, bounds: str) -> str:
    size = f"[{len(q.components)}]" if q.shape and q.role != "constants" else ""
    words = " " in q.frame  # such as "N from B"; what a frame is called has no space
    frame = f"along {q.frame}" if q.frame and not words else q.frame
    return "  ".join(part for part in (f"{q.name}{size}", q.unit, frame, bounds, q.meaning) if part)


def _range(q: Quantity) -> str:
    if q.low is None or q.high is None or q.is_quaternion:
        return ""
    return f"{float(q.low):g} .. {float(q.high):g}"


def _postconditions(program: Program, bodies: int) -> list[str]:
    lines: list[str] = []
    for name in program.steps:
        label, of = "Postcondition", holds(program, name, bodies)
        if of:
            label = f"{'Follows from' if bodies > 1 else label}, {of}"
        lines += _labelled(f"{label}:", f"{equation_text(LECTURE[name])}   [lecture step {name}]")
    return lines


def holds(program: Program, step: str, bodies: int) -> str:
    """Return for which bodies and points an equation holds, "" if for the answer as it stands.

    With wheels or further bodies loads, momenta and energies are those of one body at a time, and
    the answer is made of all. Moments about several points are told apart where they meet.
    """
    if equation_text(LECTURE[step]).split()[0] not in OF_ONE_BODY:
        return ""
    words = ["for each body"] if bodies > 1 else []
    if step in MOMENTS and len(MOMENTS.keys() & set(program.steps)) > 1:
        words.append(MOMENTS[step])
    return ", ".join(words)


def singular_clause(singular: Singular) -> str:
    """Return where a function has no value and what comes back, as a clause."""
    at = singular.where if singular.where.startswith("where ") else f"at {singular.where}"
    return f"{at}, {', '.join(singular.outputs)} infinite, no number or beyond all measure"


def _error(program: Program, figures: Sequence[Measurement]) -> str:
    own = [m for m in figures if m.function == program.name]
    if not own:
        return "not measured."
    most = max(own, key=lambda m: m.within)
    text = (
        f"median {max(m.median for m in own):.2g}, largest {most.within:.2g} u {of_what(program)}"
        f" (of {most.output}; {most.samples} samples of the ranges, {most.searched} searched from"
        f" the worst)"
    )
    return f"{text}{_at_hard_samples(most, max(own, key=lambda m: m.worst))}."


def _at_hard_samples(within: Measurement, worst: Measurement) -> str:
    """Return what is found beyond the ranges, at bodies and motions that are hard to compute."""
    if not worst.hard:
        return ""
    more = worst.worst > within.within
    found = f"{worst.worst:.2g} u (of {worst.output}, {worst.kind})" if more else "no more"
    return f"; at {worst.hard} hard samples {found}"


def bound_clauses(program: Program, figures: Sequence[Measurement]) -> list[str]:
    """Return what is proved of the outputs of a function in each precision, and what was seen."""
    own = [m.bound for m in figures if m.function == program.name and m.bound is not None]
    return [_bound_clause(program, [b for b in own if b.precision == name])
            for name in dict.fromkeys(b.precision for b in own)]  # fmt: skip


def _bound_clause(program: Program, own: Sequence[Bound]) -> str:
    unproved = dict.fromkeys(b.why for b in own if b.proved is None)
    if unproved:
        return f"not proved: {'; '.join(unproved)}."
    units = {q.name: behind(q.unit) for q in program.outputs}
    each = [f"{b.output} {b.proved:.2g}{units[b.output]} (seen {b.seen:.2g})" for b in own]
    assumed = dict.fromkeys(words for b in own for words in b.assumed)
    more = f"; assumed: {', '.join(assumed)}" if assumed else ""
    return f"proved, {BOUND_OF_WHAT}: {', '.join(each)}{more}."


def of_what(program: Program) -> str:
    """Return what errors are a part of: of the largest product, or of the largest component.

    Functions without a step of the lecture (motion, attitudes) are measured for rounding alone.
    """
    if program.name == FLOW:
        return (
            "of kappa times the largest component, by rounding alone (kappa: what changes of the "
            "inputs make of the result, relative to both, added up)"
        )
    if any(q.name.endswith(NEXT) for q in program.outputs):
        return (
            "of the largest component, before or after, or of the largest product of what the "
            "step adds, by rounding alone"
        )
    if program.steps:
        return "of the largest product or sum in the equation"
    return "of the largest component, by rounding alone"


def cost_line(program: Program) -> str:
    """Return the operations of a program in words."""
    counts = program.count
    order = ("add", "sub", "mul", "div", "neg", "sqrt", "sin", "cos")
    kinds = (*order, *(kind for kind in counts if kind not in order))
    listed = [f"{counts[kind]} {kind}" for kind in kinds if kind in counts]
    return ", ".join(listed) or "no operations"
