"""Ways to make the files of a scene wrong: another scene, another program, another text.

A mutant changes what is emitted, or the programs before they are printed.
"""

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction

from derive.emit.c.source import c_files
from derive.emit.casadi_text import casadi_file
from derive.emit.manifest import manifest
from derive.library.library import Library, library
from derive.program.program import Op, Program
from derive.scene import parse_scene

Texts = dict[str, str]


def printed(made: Library) -> Texts:
    """Return the emitted files of a library that checks read."""
    name = made.scene.name
    return c_files(made, ()) | {
        f"{name}_casadi.py": casadi_file(made),
        f"{name}.json": manifest(made, ()),
    }


def other_scene(*changes: tuple[str, str]) -> Callable[[Library], Texts]:
    """Return a mutant that was generated from a scene other than the one meant."""

    def mutant(made: Library) -> Texts:
        text = made.scene.text
        for old, new in changes:
            text = replaced(text, old, new)
        return printed(library(parse_scene(text, made.scene.name)))

    return mutant


def other_program(name: str, change: Callable[[Program], Program]) -> Callable[[Library], Texts]:
    """Return a mutant with one program changed before it is printed."""

    def mutant(made: Library) -> Texts:
        functions = tuple(change(f) if f.name == name else f for f in made.functions)
        assert functions != made.functions
        described = f"{made.scene.name}.json"
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


def without_gyroscopic_term(op: Op) -> Op:
    """Return 0 times a speed for every product of two speeds."""
    speeds = {"omega_x", "omega_y", "omega_z"}
    return replace(op, operands=(op.operands[0], Fraction(0))) if set(op.operands) <= speeds else op


def without_products(op: Op) -> Op:
    """Return the operation with every product of inertia 0."""
    products = {"I_xy", "I_xz", "I_yz"}
    return replace(op, operands=tuple(Fraction(0) if o in products else o for o in op.operands))


def first_sign_flipped(program: Program) -> Program:
    """Return the program with its first sum a difference, or the other way round."""
    flipped = {"add": "sub", "sub": "add"}
    place = next(n for n, op in enumerate(program.ops) if op.operator in flipped)
    ops = list(program.ops)
    ops[place] = replace(ops[place], operator=flipped[ops[place].operator])
    return replace(program, ops=tuple(ops))


def transposed(program: Program) -> Program:
    """Return the program with its Jacobian's nonzeros stored row by row."""
    (pattern,) = (program.sparsity or {}).values()
    first = len(program.results) - len(pattern.row)
    places = pattern.places()
    order = sorted(range(len(places)), key=lambda k: places[k])
    stored = [program.results[first + k] for k in order]
    return replace(program, results=(*program.results[:first], *stored))


def scalar_last(program: Program) -> Program:
    """Return the program that reads its quaternion's scalar part last."""
    inputs = tuple(
        replace(q, components=(*q.components[1:], q.components[0])) if q.is_quaternion else q
        for q in program.inputs
    )
    return replace(program, inputs=inputs)


def half_forgotten(op: Op) -> Op:
    """Return the operation with 1 for every half."""
    half = Fraction(1, 2)
    one = tuple(Fraction(1) if o == half else o for o in op.operands)
    return replace(op, operands=one)


def turns_swapped(op: Op) -> Op:
    """Return the operation with theta and phi in each other's place."""
    other = {"theta": "phi", "phi": "theta"}
    return replace(op, operands=tuple(other.get(str(o), o) for o in op.operands))


def omega_for_Omega(program: Program) -> Program:
    """Return W_x (A - C) + p A for W_x (A - C) - p C: Omega and omega in each other's place."""
    (spin,) = (op for op in program.ops if set(op.operands) == {"p", "C"})
    ops = list(program.ops)
    ops[ops.index(spin)] = replace(spin, operands=("p", "A"))
    (joint,) = (op for op in program.ops if spin.result in op.operands)
    assert joint.operator == "sub"
    ops[ops.index(joint)] = replace(joint, operator="add")
    return replace(program, ops=tuple(ops))
