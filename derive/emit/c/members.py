"""A function over many members as C: structures of arrays, which compilers turn into vectors.

A component of member k stands at ``[component * stride + k]``, k in C ``k_``, which no name of a
scene is. A member gets what the scene's own function gives, to the last bit: the same operations,
in loops without branches. Angles that our own sines do not serve, loops and ``atan2`` are left to
the scene's own function.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Literal

from derive.emit.c.members_layout import at_member, behind_first, braced, within_braces
from derive.emit.c.scope import declared_in_c, require_free
from derive.emit.c.signature import CNames, declaration
from derive.emit.c.sines import takes_sines
from derive.emit.c.text import function_body
from derive.emit.operators import literal
from derive.emit.sines import TOGETHER, together
from derive.program.own_sine import FITTED
from derive.program.precision import Precision
from derive.program.program import Op, Program, Quantity, read_by

IN_COMMON = ("time_step",)
"""What all members have in common: they move by steps of one length."""
MEMBERS_KEPT = 64
"""OverMembers whose inputs are kept until it is known that no angle was too large."""
Sets = Literal["shared", "each"]
"""Whether all members have one set of constants, or every member its own."""
SET_ENDINGS: Mapping[Sets, str] = {"shared": "batch", "each": "batch_each"}


@dataclass(frozen=True)
class OverMembers:
    """A function of a scene over many members in one precision.

    sets : "shared" constants are a struct, those of "each" member an array
    """

    program: Program
    scene: str
    precision: Precision
    sets: Sets = "shared"

    @property
    def symbol(self) -> str:
        """Return what C calls it."""
        return members_symbol(self.scene, self.program.name, self.precision, self.sets)

    @property
    def each(self) -> bool:
        """Tell whether every member has constants of its own."""
        return self.sets == "each"

    @property
    def lane(self) -> str:
        """Return what C calls the operations for one member."""
        return f"{self.scene}_{self.program.name}_lane_{self.precision.name}"

    @property
    def struct(self) -> str:
        """Return the type of the constants."""
        return f"{self.scene}_constants_{self.precision.name}"

    @property
    def read(self) -> dict[str, int]:
        """Return the constants that operations read, with their places in the struct."""
        used = read_by(self.program)
        every = [c for q in self.program.inputs if q.role == "constants" for c in q.components]
        return {c: place for place, c in enumerate(every) if c in used}

    @property
    def given(self) -> list[tuple[str, str]]:
        """Return each component that members have, and where the first member's stands."""
        own = [q for q in self.program.inputs if q.role != "constants" and q.name not in IN_COMMON]
        return [(c, _start(q, i)) for q in own for i, c in enumerate(q.components)]

    @property
    def asked(self) -> list[int]:
        """Return which of the given components operations read, by their numbers."""
        used = read_by(self.program)
        return [n for n, (c, _) in enumerate(self.given) if c in used]

    @property
    def found(self) -> list[str]:
        """Return where the first member's results stand."""
        return [_start(q, i) for q in self.program.outputs for i in range(len(q.components))]

    @property
    def common(self) -> list[str]:
        """Return what all members have in common."""
        return [q.name for q in self.program.inputs if q.name in IN_COMMON]

    @property
    def components(self) -> list[str]:
        """Return what the operations for one member are given."""
        return [*self.read, *(self.given[n][0] for n in self.asked), *self.common]

    @property
    def sines(self) -> bool:
        """Tell whether there are angles, which may be too large."""
        return is_in_vectors(self.program) and takes_sines(self.program)


def is_in_vectors(program: Program) -> bool:
    """Tell whether the operations of a function stand in a loop that may become vectors."""
    straight = all(isinstance(line, Op) for line in program.ops)
    return straight and program.arithmetic == "working" and "atan2" not in program.count


def members_symbol(scene: str, function: str, precision: Precision, sets: Sets = "shared") -> str:
    """Return what C calls a function over members."""
    return CNames(scene).symbol(f"{function}_{SET_ENDINGS[sets]}", precision)


def members_prototype(of: OverMembers) -> str:
    """Return the declaration of a function over members, without its semicolon."""
    scalar = of.precision.scalar
    arguments = ["ptrdiff_t members", "ptrdiff_t stride"]
    for q in of.program.inputs:
        if q.role == "constants":
            arguments.append(f"const {scalar if of.each else of.struct} *constants")
        else:
            arguments.append(f"{scalar} {q.name}" if q.name in IN_COMMON
                             else f"const {scalar} *{q.name}")  # fmt: skip
    arguments += [f"{scalar} *{q.name}" for q in of.program.outputs]
    return declaration(f"void {of.symbol}", arguments)


def lane(of: OverMembers) -> str:
    """Return the operations for one member: values in, values out; no branch, no array.

    It returns whether an angle is too large, which makes its results those of no angle.
    """
    scalar = of.precision.scalar
    inputs, outputs = of.components, [f"found_{j}" for j in range(len(of.found))]
    alone = replace(
        of.program,
        inputs=tuple(_alone(c) for c in inputs),
        outputs=tuple(_alone(c) for c in outputs),
    )
    lines = function_body(alone, f"{of.scene}_batch", of.precision)
    if of.sines:
        lines.append(f"return {' | '.join(_too_large(of))};")
    head = f"DERIVE_LANE {'int' if of.sines else 'void'} {of.lane}"
    arguments = [*(f"{scalar} {c}" for c in inputs), *(f"{scalar} *{c}" for c in outputs)]
    require_free(of.scene, of.program.name, inputs, (*outputs, *declared_in_c(lines)))
    return braced(declaration(head, arguments), lines)


def _too_large(of: OverMembers) -> Iterator[str]:
    """Yield what is true where an angle is larger than our own sines serve, or no number."""
    most = literal(Fraction(FITTED[of.precision.bits].largest), of.precision)
    angles = [line.operands[0] for line in together(of.program.ops)
              if isinstance(line, Op) and line.operator == TOGETHER]  # fmt: skip
    for angle in angles:
        text = angle if isinstance(angle, str) else literal(angle, of.precision)
        yield f"!({of.precision.functions['abs']}({text}) <= {most})"


def _alone(name: str) -> Quantity:
    return Quantity(name, (name,), (), "", "", None, None, "")


def members_definition(of: OverMembers) -> str:
    """Return the function over members."""
    scalar, read = of.precision.scalar, of.read
    vectors = is_in_vectors(of.program)
    pointed = of.asked if vectors and not of.sines else range(len(of.given))
    lines = [f"const {scalar} *const in_{n} = {of.given[n][1]};" for n in pointed]
    lines += [f"{scalar} *const out_{j} = {at};" for j, at in enumerate(of.found)]
    if vectors and of.each:
        lines += [f"const {scalar} *const made_{n} = constants{behind_first(at)};"
                  for n, at in enumerate(read.values())]  # fmt: skip
    elif vectors:
        lines += [f"const {scalar} made_{n} = constants->{c};" for n, c in enumerate(read)]
    lines.append("ptrdiff_t k_;")
    if not vectors:
        lines += [
            "for (k_ = 0; k_ < members; ++k_) {",
            *within_braces(_called(of, "in_{0}[k_]")),
            "}",
        ]
    else:
        lines += _kept(of) if of.sines else _looped(of)
    if not any("stride" in line for line in lines):
        lines.insert(lines.index("ptrdiff_t k_;") + 1, "(void)stride;")
    names = [q.name for q in (*of.program.inputs, *of.program.outputs)]
    require_free(of.scene, of.program.name, names, _own(of))
    return braced(members_prototype(of), lines)


def _own(of: OverMembers) -> Iterator[str]:
    """Yield the names of what a function over members declares itself."""
    yield from ("members", "stride", "k_", "start", "end", "far", "any", "own")
    for name, many in (("in", of.given), ("out", of.found), ("made", of.read), ("kept", of.given)):
        yield from (f"{name}_{n}" for n in range(len(many)))
    yield from (f"found_{n}" for n in range(len(of.found)))
    yield from (f"{q.name}_own" for q in (*of.program.inputs, *of.program.outputs))


def _looped(of: OverMembers) -> list[str]:
    return [
        "DERIVE_MEMBERS",
        "for (k_ = 0; k_ < members; ++k_) {",
        *within_braces([*_laned(of, ""), *_stored(of)]),
        "}",
    ]


def _kept(of: OverMembers) -> list[str]:
    """Return a loop by parts: inputs are kept, as results may lie over them, for larger angles."""
    many = MEMBERS_KEPT
    kept = [f"{of.precision.scalar} kept_{n}[{many}];" for n in range(len(of.given))]
    keep = [f"kept_{n}[k_ - start] = in_{n}[k_];" for n in range(len(of.given))]
    again = _called(of, "kept_{0}[k_ - start]")
    work = [*keep, *_laned(of, "far[k_ - start] = "), *_stored(of)]
    return [
        *kept,
        f"int far[{many}];",
        "ptrdiff_t start;",
        f"for (start = 0; start < members; start += {many}) {{",
        f"    const ptrdiff_t end = members - start < {many} ? members : start + {many};",
        "    int any = 0;",
        "    DERIVE_MEMBERS",
        "    for (k_ = start; k_ < end; ++k_) {",
        *within_braces(within_braces(work)),
        "    }",
        "    for (k_ = start; k_ < end; ++k_) {",
        "        any |= far[k_ - start];",
        "    }",
        "    for (k_ = start; any != 0 && k_ < end; ++k_) {",
        "        if (far[k_ - start] != 0) {",
        *within_braces(within_braces(within_braces(again))),
        "        }",
        "    }",
        "}",
    ]


def _laned(of: OverMembers, into: str) -> list[str]:
    """Return the call of the operations for one member."""
    many = range(len(of.found))
    made = [f"made_{n}[k_]" if of.each else f"made_{n}" for n in range(len(of.read))]
    given = [f"in_{n}[k_]" for n in of.asked]
    arguments = [*made, *given, *of.common, *(f"&found_{j}" for j in many)]
    names = ", ".join(f"found_{j}" for j in many)
    call = declaration(f"{into}{of.lane}", arguments)
    return [f"{of.precision.scalar} {names};", *f"{call};".split("\n")]


def _stored(of: OverMembers) -> list[str]:
    return [f"out_{j}[k_] = found_{j};" for j in range(len(of.found))]


def _called(of: OverMembers, read: str) -> list[str]:
    """Return the call of the scene's own function for member k; ``read`` gives inputs."""
    scalar, lines, arguments, n = of.precision.scalar, list[str](), list[str](), 0
    for q in of.program.inputs:
        if q.role == "constants":
            arguments.append("&own" if of.each else "constants")
            lines += _struct(of, q) if of.each else []
        elif q.name in IN_COMMON:
            arguments.append(q.name)
        else:
            values = [read.format(n + i) for i in range(len(q.components))]
            n += len(values)
            if q.shape:
                listed = ", ".join(values)
                lines.append(f"const {scalar} {q.name}_own[{len(values)}] = {{{listed}}};")
            arguments.append(f"{q.name}_own" if q.shape else values[0])
    results = list[str]()
    for q in of.program.outputs:
        lines.append(f"{scalar} {q.name}_own{f'[{len(q.components)}]' if q.shape else ''};")
        arguments.append(f"{'' if q.shape else '&'}{q.name}_own")
        many = range(len(q.components))
        results += [f"{q.name}_own[{i}]" for i in many] if q.shape else [f"{q.name}_own"]
    call = declaration(CNames(of.scene).symbol(of.program.name, of.precision), arguments)
    stores = [f"out_{j}[k_] = {result};" for j, result in enumerate(results)]
    return [*lines, *f"{call};".split("\n"), *stores]


def _struct(of: OverMembers, q: Quantity) -> list[str]:
    lines = [f"own.{c} = constants[{at_member(i)}];" for i, c in enumerate(q.components)]
    return [f"{of.struct} own;", *lines]


def _start(q: Quantity, place: int) -> str:
    return f"{q.name}{behind_first(place)}"
