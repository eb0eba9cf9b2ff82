"""Set-up over many members as C: the scene's own, member after member, in pairs of floats."""

from derive.emit.c.members import members_symbol
from derive.emit.c.members_layout import at_member, braced, within_braces
from derive.emit.c.scope import require_free
from derive.emit.c.signature import CNames, declaration
from derive.emit.c.text import places
from derive.program.precision import Precision
from derive.program.program import Program


def setup_prototype(program: Program, scene: str, precision: Precision) -> str:
    """Return the declaration of set-up over members, without its semicolon."""
    given = [f"const {precision.scalar} *{q.name}" for q in program.inputs]
    symbol = members_symbol(scene, "setup", precision)
    made = [f"{precision.scalar} *constants", "int *status"]
    return declaration(f"ptrdiff_t {symbol}", ["ptrdiff_t members", "ptrdiff_t stride",
                                               *given, *made])  # fmt: skip


def setup_definition(program: Program, scene: str, precision: Precision) -> str:
    """Return set-up over members: the scene's own, member after member."""
    own = places(program.outputs)
    values = [f"{q.name}[k_]" for q in program.inputs]
    if any(q.shape for q in program.inputs):
        raise ValueError("parameters are numbers")
    call = declaration(CNames(scene).symbol("setup", precision), [*values, "&own"])
    loop = [
        f"const int said = {call};",
        *(f"constants[{at_member(i)}] = own.{c};" for i, c in enumerate(own)),
        "if (status) {",
        "    status[k_] = said;",
        "}",
        "refused += said != 0;",
    ]
    lines = [
        f"{scene}_constants_{precision.name} own;",
        "ptrdiff_t k_, refused = 0;",
        *([] if any("stride" in line for line in loop) else ["(void)stride;"]),
        "for (k_ = 0; k_ < members; ++k_) {",
        *within_braces(loop),
        "}",
        "return refused;",
    ]
    names = [q.name for q in program.inputs]
    taken = ("members", "stride", "own", "k_", "refused", "said", "constants", "status")
    require_free(scene, "setup", names, taken)
    return braced(setup_prototype(program, scene, precision), lines)
