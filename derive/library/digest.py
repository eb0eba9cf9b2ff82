"""A digest of what a scene computes, whatever its words: its report is of it while it is so."""

from hashlib import sha256
from typing import Any

from derive.library.library import Library
from derive.program.program import Program


def digest_of_programs(library: Library) -> str:
    """Return a digest of a scene's name, programs and ranges."""
    programs = map(_work, (library.setup, *library.printed(), *library.rates))
    ranges = [(q.name, q.components, q.low, q.high) for q in library.vocabulary.every()]
    return sha256(repr([library.scene.name, *programs, ranges]).encode()).hexdigest()


def _work(program: Program) -> tuple[Any, ...]:
    """Return what of a program its numbers depend on."""
    ends = [q.components for q in (*program.inputs, *program.outputs)]
    return (program.name, ends, program.ops, program.results, program.numbers, program.arithmetic)
