"""All programs of a scene: one set-up, and for every wanted function its hot part."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from sys import float_info

from mpmath import mpf, nstr

from derive.library.admission import tried_rules
from derive.library.function import Graphed, arranged, function, graphed
from derive.library.setting import Setting, applied_moment, held
from derive.library.singular import with_singular
from derive.library.steps import motions, needs
from derive.lower.setup import SetupPart, in_pairs, setup, with_low_parts
from derive.lower.wording import meaning
from derive.mechanics.mechanism import Mechanism, mechanism
from derive.mechanics.problem import Problem
from derive.mechanics.vocabulary import LARGEST_FLOAT, Vocabulary, require_floats
from derive.program.program import Program, Quantity, component_names, fixed_numbers, read_by
from derive.program.tape import Tape, free_prefix
from derive.scene import Scene, SceneError
from derive.scene.wanted import ATTITUDES, IN_PAIRS, moves, without_ending


@dataclass(frozen=True)
class Library:
    """What a scene's files are printed from.

    functions : what the lecture states; each satisfies one of the ``problems``
    constants : what each constant is made by, in the order of the struct
    rates     : further such functions that ``motions`` rest on and nobody wanted for themselves
    motions   : what moves the state in time, and formulas for attitudes
    fixed     : the values of parameters for which C has a table in the place of set-up
    ways      : of functions, the operations of each way to arrange them, the way taken first
    """

    mechanism: Mechanism
    setup: Program
    functions: tuple[Program, ...]
    constants: Mapping[str, str]
    problems: Mapping[str, Problem]
    rates: tuple[Program, ...] = ()
    motions: tuple[Program, ...] = ()
    fixed: Mapping[str, float] = field(default_factory=dict)
    ways: Mapping[str, Mapping[str, int]] = field(default_factory=dict)

    def __getitem__(self, name: str) -> Program:
        return next(p for p in (self.setup, *self.printed(), *self.rates) if p.name == name)

    @property
    def scene(self) -> Scene:
        """Return the scene as it was read."""
        return self.mechanism.scene

    @property
    def vocabulary(self) -> Vocabulary:
        """Return what the scene's quantities are called."""
        return self.mechanism.vocabulary

    def printed(self) -> tuple[Program, ...]:
        """Return the functions that are emitted: the lecture's, then those that move the state."""
        return self.functions + self.motions

    def emitted(self) -> tuple[Program, ...]:
        """Return what is printed with set-up before it, if there are constants to make."""
        return (*([self.setup] if self.constants else []), *self.printed())

    def in_c(self) -> tuple[Program, ...]:
        """Return the functions that C has: no set-up where parameters are fixed."""
        return self.printed() if self.fixed else self.emitted()


def library(scene: Scene) -> Library:
    """Return the programs that ``scene`` asks for.

    Raises SceneError, with one sentence that names the scene, if there can be none.
    """
    try:
        found = _library(scene)
        require_floats(q for p in found.printed() for q in p.inputs)
    except SceneError as error:
        raise SceneError(f"scene '{scene.name}': {error}") from None
    return found


def _library(scene: Scene) -> Library:
    terms = graphed(mechanism(scene))
    asked, hidden = _asked(scene)
    bases = dict.fromkeys(map(without_ending, (*asked, *hidden)))
    wanted = {base: arranged(terms, base) for base in bases}
    every = {n: function(terms, wanted[without_ending(n)], n) for n in (*asked, *hidden)}
    motions_, part, meanings = _of_motion(terms, every)
    made = _set_up(terms, part)
    if scene.form == "accurate" and made.outputs:
        made = with_low_parts(made)
    functions = _in_parameters(made, tuple(every.values()))
    moving = _in_parameters(made, motions_)
    if scene.form == "accurate":
        names = {*terms.constants.names.values(), *part.names.values()}
        functions = tuple(in_pairs(f, names) for f in functions)
        moving = tuple(in_pairs(f, names) if f.name in IN_PAIRS else f for f in moving)
    _require_numbers((*functions, *moving), "f32", LARGEST_FLOAT)
    _require_numbers((made,), "f64", float_info.max)
    functions = with_singular(functions, made)
    moving = with_singular(moving, made)
    return Library(
        terms.mechanism,
        made,
        functions[: len(asked)],
        _constants(made, {**_meanings(terms), **meanings}),
        {base: one.problem for base, one in wanted.items()},
        rates=functions[len(asked) :],
        motions=moving,
        ways={base: one.ways for base, one in wanted.items()},
    )


def posed_again(known: Library, scene: Scene) -> Library:
    """Return a library with the machine of another scene, for who asks for equations alone."""
    return replace(known, mechanism=mechanism(scene))


def _asked(scene: Scene) -> tuple[list[str], list[str]]:
    """Return the functions that satisfy equations, and those that only motions rest on."""
    asked = [name for name in scene.wanted if not moves(name) and name not in ATTITUDES]
    return asked, [name for name in needs(scene) if name not in asked]


def _require_numbers(programs: Sequence[Program], precision: str, most: float) -> None:
    """Refuse a number that stands in a program and is beyond a float type."""
    for program in programs:
        for number in fixed_numbers(program)[:1]:
            if abs(number) > most:
                size = nstr(mpf(number.numerator) / number.denominator, 3)
                rule = f"must be made of numbers within {precision}, up to {most:.2g}"
                raise SceneError(f"'{program.name}' {rule}, but holds {size}")


def _of_motion(
    terms: Graphed, rates: Mapping[str, Program]
) -> tuple[tuple[Program, ...], SetupPart, dict[str, str]]:
    """Return what moves the state, its part of set-up, and what is said of its own constants."""
    moment = applied_moment(terms)
    tape = Tape(free_prefix("p", set(terms.taken())), held=held(terms))
    setting = Setting(terms, rates, moment, tape)
    programs = motions(setting)
    read = {name for program in programs for name in read_by(program)}
    own = {o: each for o, each in tape.names.items() if each[0] in read - tape.held.keys()}
    part = SetupPart(
        tuple(tape.ops), dict(setting.given), {o: name for o, (name, _) in own.items()}
    )
    return programs, part, dict(own.values())


def _set_up(terms: Graphed, part: SetupPart) -> Program:
    """Return the program of set-up, which also tries whether its parameters are admissible."""
    parameters = terms.vocabulary.parameters
    bare = setup(terms.graph, terms.constants, parameters, [part])
    used = {c for q in bare.inputs for c in q.components}
    return setup(terms.graph, terms.constants, parameters, [part, tried_rules(terms, used)])


def _constants(made: Program, meanings: Mapping[str, str]) -> dict[str, str]:
    """Return what set-up gives, each with its meaning; a low part is what rounding left."""
    lows = {f"{name}_low": f"what rounding {name} left" for name in meanings}
    every = lows | dict(meanings)
    return {c: every[c] for c in component_names(made)}


def _meanings(terms: Graphed) -> dict[str, str]:
    """Return the formula of every constant that the lecture's functions asked for."""
    return {name: meaning(terms.graph, value) for value, name in terms.constants.names.items()}


def _in_parameters(made: Program, functions: Sequence[Program]) -> tuple[Program, ...]:
    """Return the functions, each with the constants as its first input if it uses any."""
    names = {c for q in made.outputs for c in q.components}
    return tuple(_with_inputs(f, made.outputs) if _reads(f, names) else f for f in functions)


def _with_inputs(program: Program, more: tuple[Quantity, ...]) -> Program:
    """Return a program that is given ``more`` before its other inputs."""
    unrolled = None if program.unrolled is None else _with_inputs(program.unrolled, more)
    return replace(program, inputs=(*more, *program.inputs), unrolled=unrolled)


def _reads(program: Program, names: set[str]) -> bool:
    return bool(read_by(program) & names)
