"""Known defects of rotational code: story, mutant, and the checks that kill it.

Thread numbers are GitHub's. A mutant changes what is emitted, or the programs before they are
printed; the checks compare it with the scene as it should be.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction

from derive.casadi_text import casadi_file
from derive.check.emitted import Files
from derive.emit import c_files
from derive.library import Library, library
from derive.manifest import manifest
from derive.program import Op, Program
from derive.scene import load, parse_scene

Texts = dict[str, str]


@dataclass(frozen=True)
class Defect:
    """One way to be wrong: on which scene, made how, and which checks must see it."""

    name: str
    story: str
    scene: str
    mutant: Callable[[Library], Texts]
    killed_by: tuple[str, ...]


def printed(made: Library) -> Texts:
    """Return the emitted files of a library that checks read."""
    name = made.known.scene.name
    return c_files(made, ()) | {
        f"{name}_casadi.py": casadi_file(made),
        f"{name}.json": manifest(made, ()),
    }


def files(texts: Texts) -> Files:
    """Return texts as the files of a scene."""
    return Files(texts, "made in memory")


def other_scene(*changes: tuple[str, str]) -> Callable[[Library], Texts]:
    """Return a mutant that was generated from a scene other than the one meant."""

    def mutant(made: Library) -> Texts:
        text = made.known.scene.text
        for old, new in changes:
            text = replaced(text, old, new)
        return printed(library(parse_scene(text, made.known.scene.name)))

    return mutant


def other_program(name: str, change: Callable[[Program], Program]) -> Callable[[Library], Texts]:
    """Return a mutant with one program changed before it is printed."""

    def mutant(made: Library) -> Texts:
        functions = tuple(change(f) if f.name == name else f for f in made.functions)
        assert functions != made.functions
        described = f"{made.known.scene.name}.json"
        return printed(replace(made, functions=functions)) | {described: manifest(made, ())}

    return mutant


def other_text(ending: str, *changes: tuple[str, str]) -> Callable[[Library], Texts]:
    """Return a mutant with a printed file edited by hand."""

    def mutant(made: Library) -> Texts:
        texts = printed(made)
        (file,) = (name for name in texts if name.endswith(ending))
        for old, new in changes:
            texts[file] = replaced(texts[file], old, new)
        return texts

    return mutant


def replaced(text: str, old: str, new: str) -> str:
    """Return ``text`` with the first ``old`` replaced; it must be there."""
    assert old in text, f"nothing to mutate: {old!r}"
    return text.replace(old, new, 1)


def ops_changed(change: Callable[[Op], Op]) -> Callable[[Program], Program]:
    """Return a change of a program that acts on every operation."""
    return lambda program: replace(program, ops=tuple(change(op) for op in program.ops))


def _without_gyroscopic_term(op: Op) -> Op:
    speeds = {"omega_x", "omega_y", "omega_z"}
    return replace(op, operands=(op.operands[0], Fraction(0))) if set(op.operands) <= speeds else op


def _without_products(op: Op) -> Op:
    products = {"I_xy", "I_xz", "I_yz"}
    return replace(op, operands=tuple(Fraction(0) if o in products else o for o in op.operands))


def _first_sign_flipped(program: Program) -> Program:
    flipped = {"add": "sub", "sub": "add"}
    place = next(n for n, op in enumerate(program.ops) if op.operator in flipped)
    ops = list(program.ops)
    ops[place] = replace(ops[place], operator=flipped[ops[place].operator])
    return replace(program, ops=tuple(ops))


def _transposed(program: Program) -> Program:
    """Return the program with its Jacobian's nonzeros stored row by row."""
    (pattern,) = (program.sparsity or {}).values()
    first = len(program.results) - len(pattern.row)
    places = pattern.places()
    order = sorted(range(len(places)), key=lambda k: places[k])
    stored = [program.results[first + k] for k in order]
    return replace(program, results=(*program.results[:first], *stored))


def _scalar_last(program: Program) -> Program:
    """Return the program that reads its quaternion's scalar part last."""
    inputs = tuple(
        replace(q, components=(*q.components[1:], q.components[0])) if q.name == "attitude" else q
        for q in program.inputs
    )
    return replace(program, inputs=inputs)


def _half_forgotten(op: Op) -> Op:
    half = Fraction(1, 2)
    one = tuple(Fraction(1) if o == half else o for o in op.operands)
    return replace(op, operands=one)


def _turns_swapped(op: Op) -> Op:
    other = {"theta": "phi", "phi": "theta"}
    return replace(op, operands=tuple(other.get(str(o), o) for o in op.operands))


def _omega_for_Omega(program: Program) -> Program:
    """Return W_x (A - C) + p A for W_x (A - C) - p C: Omega and omega in each other's place."""
    (spin,) = (op for op in program.ops if set(op.operands) == {"p", "C"})
    ops = list(program.ops)
    ops[ops.index(spin)] = replace(spin, operands=("p", "A"))
    (joint,) = (op for op in program.ops if spin.result in op.operands)
    assert joint.operator == "sub"
    ops[ops.index(joint)] = replace(joint, operator="add")
    return replace(program, ops=tuple(ops))


DEFECTS = (
    Defect(
        "gyroscopic term dropped",
        "omega x I omega was forgotten (ardupilot 26972, avian 420 ff.); energy never shows it",
        "free_body_principal",
        other_program("acceleration", ops_changed(_without_gyroscopic_term)),
        ("error", "bits of the program"),
    ),
    Defect(
        "wrong sign",
        "a sign of the gyroscopic moment, and the reference had it too (crazyflow 86)",
        "free_body_principal",
        other_program("acceleration", _first_sign_flipped),
        ("error", "cyclic relabelling", "power balance"),
    ),
    Defect(
        "wheel inertia counted twice",
        "the tensor of the whole, wheels locked, had the wheels added once more",
        "gyrostat",
        other_scene(('moments  = ["I_xx",', 'moments  = ["I_xx + C_1",')),
        ("error",),
    ),
    Defect(
        "only the diagonal used",
        "the products of inertia were read and never used (avian 420 ff.)",
        "free_body",
        other_program("moment", ops_changed(_without_products)),
        ("error", "rotation of axes"),
    ),
    Defect(
        "frame order",
        "yaw, pitch, roll turned in another order than the one declared",
        "gyrostat",
        other_program("state_rate", ops_changed(_turns_swapped)),
        ("error",),
    ),
    Defect(
        "quaternion order",
        "the scalar part was read last where it is written first",
        "rigid_body",
        other_program("state_rate", _scalar_last),
        ("error", "power balance"),
    ),
    Defect(
        "half of the quaternion rate forgotten",
        "q' = q omega instead of q omega / 2",
        "rigid_body",
        other_program("state_rate", ops_changed(_half_forgotten)),
        ("error",),
    ),
    Defect(
        "Omega and omega swapped",
        "an Omega x term with the wrong Omega, and the reference had it too (JSBSim 1034)",
        "rotor_on_turning_axes",
        other_program("moment", _omega_for_Omega),
        ("error",),
    ),
    Defect(
        "product sign",
        "I_xy read as the tensor's entry where +sum x y dm is meant",
        "free_body",
        other_scene(('["I_xy", "I_xz", "I_yz"]', '["-I_xy", "-I_xz", "-I_yz"]')),
        ("error",),
    ),
    Defect(
        "transposed Jacobian",
        "nonzeros stored by rows under a pattern by columns",
        "free_body",
        other_program("acceleration_jacobian", _transposed),
        ("error", "bits of the program"),
    ),
    Defect(
        "whole matrix by rows",
        "a dense Jacobian filled by rows where columns are promised",
        "free_body_principal",
        other_text("_f64.c", ("jacobian[places[entry]]", "jacobian[places[entry] / 2]")),
        ("whole matrix",),
    ),
    Defect(
        "stale set-up constant",
        "a constant of an earlier body was left standing",
        "free_body_principal",
        other_text("_f64.c", ("constants->I_yy_minus_I_zz = s3.high", "(void)s3")),
        ("error", "bits of the program", "CasADi's bits"),
    ),
    Defect(
        "set-up in working precision",
        "the inverse loses what its condition takes (PyDy on a rod: 9e4 u)",
        "free_body",
        other_text("_f64.c", ("constants->J_xx = ", "constants->J_xx = (double)(float)")),
        ("error", "CasADi's bits"),
    ),
    Defect(
        "double literal in a float file",
        "float code that computes in double, 6.6 times slower (sympy 14063, zephyr 38958)",
        "free_body_principal",
        other_text("_f32.c", ("omega[1] * omega[2]", "omega[1] * 1.0 * omega[2]")),
        ("compiles without warnings",),
    ),
    Defect(
        "float literal in a double file",
        "0.1F where 0.1 is meant: nine digits lost without a warning",
        "rigid_body",
        other_text("_f64.c", ("* 0.5;", "* 0.500000003F;")),
        ("compiles without warnings",),
    ),
    Defect(
        "stored before all is computed",
        "omega_dot written over omega gave a wrong result without a word (C made by CasADi)",
        "free_body_principal",
        other_text(
            "_f64.c",
            ("    const double t4 =", "    omega_dot[0] = t3;\n    const double t4 ="),
        ),
        ("outputs over inputs",),
    ),
    Defect(
        "cancellation near a sphere",
        "I_zz w_z w_y - I_yy w_y w_z as two products: nothing is left of two nearly equal moments",
        "free_body_principal",
        other_text(
            "_f64.c",
            (
                "t0 * constants->I_yy_minus_I_zz;",
                "omega[2] * constants->I_yy * omega[1] - omega[1] * constants->I_zz * omega[2];",
            ),
            ("    const double t0 = omega[1] * omega[2];\n", ""),
        ),
        ("error",),
    ),
    Defect(
        "CasADi's file edited by hand",
        "generator and flown code drifted apart (ardupilot 27862, 31949)",
        "free_body_principal",
        other_text("_casadi.py", ("omega[1] * omega[2]", "omega[2] * omega[2]")),
        ("CasADi's bits",),
    ),
    Defect(
        "wrong sparsity",
        "a pattern that is not the one of the numbers gives a silently wrong Jacobian",
        "free_body_principal",
        other_text("_casadi.py", ("[1, 2, 0, 2, 0, 1, 0, 1, 2]", "[0, 2, 0, 2, 0, 1, 0, 1, 2]")),
        ("sparsity",),
    ),
    Defect(
        "files of another scene",
        "what is called is not what was declared (PX4-Autopilot 20333: copied by hand)",
        "free_body",
        other_scene(('["I_xy", "I_xz", "I_yz"]', "[0, 0, 0]")),
        ("describes the scene's functions",),
    ),
    Defect(
        "a body that is none",
        "set-up that accepts a tensor which is not positive definite",
        "free_body_principal",
        other_text("_f64.c", ("? 0 : 1", "? 0 : 0")),
        ("refuses what is no body",),
    ),
)


def scene_library(name: str) -> Library:
    """Return the library of a scene as it should be."""
    return library(load(name))
