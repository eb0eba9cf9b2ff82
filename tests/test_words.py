"""One word, one thing: no name of the package is defined twice for different things."""

import ast
import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from pathlib import Path

import pytest

from derive.scene.short_form.quantities import QUANTITIES
from tests.source import nodes_of, parsed

ROOT = Path(__file__).parent.parent / "derive"


@cache
def pages() -> Mapping[str, ast.Module]:
    """Return all modules of the package."""
    return {
        str(page.relative_to(ROOT).with_suffix("")): parsed(page.read_text(encoding="utf-8"))
        for page in sorted(ROOT.rglob("*.py"))
    }


BOTH = {"entry": "of a scene file, and of a matrix: both are terms of the field"}
"""Names of two types, and why."""


def test_no_two_modules_define_types_of_one_name() -> None:
    assert len(types(pages())) > 150
    assert shared(pages()).keys() == BOTH.keys()


def test_a_second_type_of_a_name_is_found_whether_class_or_alias_or_plural() -> None:
    first = {"a": ast.parse("class Block: pass")}
    assert shared({**first, "b": ast.parse("Blocks = list[int]")}) == {
        "block": ["a.Block", "b.Blocks"]
    }
    assert shared({**first, "b": ast.parse("class Bloc: pass")}) == {}
    assert shared({**first, "b": ast.parse("from x import Block\nclass Blocks: pass")}) == {}


WORDS = {
    "motion": ("how bodies go in time", "check", "emit", "library", "mechanics", "motion", "report",
               "scene", "solve", "verify"),
    "moved": ("nothing",),
    "moving": ("a scalar that changes in time, axes that turn", "lecture", "scene"),
    "rate": ("a derivative by time", "check", "control", "lecture", "library", "lower", "mechanics",
             "motion", "report", "scene", "verify"),
    "stage": ("of a Runge-Kutta method", "motion"),
    "draft": ("nothing",),
    "table": ("of a scene file", "scene"),
    "point": ("a place in space", "mechanics", "scene"),
    "frame": ("axes", "mechanics", "scene"),
    "block": ("of a matrix", "emit", "library", "lower", "motion", "verify"),
    "known": ("what the scene states of a body's motion and loads", "scene"),
    "traced": ("nothing",),
    "series": ("of powers of time", "motion", "verify"),
}  # fmt: skip
"""What each of these words names, and the rooms in which definitions are so called."""


def test_no_two_modules_give_others_functions_or_constants_of_one_name() -> None:
    assert len(given_to_others(pages())) > 400
    functions, constants = apart(given_to_others(pages()))
    assert sorted(several(functions)) == sorted(ALIKE)
    assert sorted(several(constants)) == sorted(SAME)


def test_a_second_function_of_a_name_is_found_once_another_module_reads_it() -> None:
    pages = {name: ast.parse("def drawn(): pass") for name in ("a", "b")}
    both = {**pages, "c": ast.parse("from derive.a import drawn\nfrom derive import b\nb.drawn()")}
    assert several(given_to_others(pages)) == {}
    assert several(given_to_others(both)) == {"drawn": ["a.drawn", "b.drawn"]}


ALIKE = {
    **dict.fromkeys(
        ("added", "conjugate", "number", "product", "symbol", "time", "trace", "turn", "zero"),
        "the same operation on another kind of numbers",
    ),
    **dict.fromkeys(("from_quaternion", "to_quaternion"), "the way to other parameters"),
    **dict.fromkeys(("after", "by_error", "increment", "step_slope"), "of a Runge-Kutta method"),
    "load": "a scene: what it declares, and with it what can be done",
    "option": "of a command",
    "potential_energy": "by loads and, beside them, by particles",
    "renamed": "in a formula and in a program",
    "splitter": "as a number and as a recorded one",
    "unit": "of a quantity, and the unit vector: both are terms of the field",
}
"""Functions that are called alike because they are alike, and what they are."""
SAME = {
    **dict.fromkeys(("any", "axe", "half", "identity", "one", "zero"), "one value, of many kinds"),
    "bit": "of the arithmetic at hand",
    "body": "its entries in a scene file, and those at which errors are looked for",
    "sign": "how a language writes operators",
    "step": "of a chapter",
    "time_step": "the quantity, and its entry in a scene file",
    "unit": "the number 1, and the units of scenes",
}
"""Constants that are called alike because they are alike, and what they are."""


@pytest.mark.parametrize("word", WORDS)
def test_a_word_that_named_several_things_is_met_where_it_names_one(word: str) -> None:
    found = (page for page, tree in pages().items() if word in words_of(page, tree))
    rooms = {page.partition("/")[0] for page in found}
    assert rooms == {*WORDS[word][1:]}


def test_no_name_of_a_scenes_quantity_decides_anything() -> None:
    found = {page: read for page, tree in pages().items() if (read := named(tree)) and within(page)}
    assert found == {page: {*names} for page, (names, _) in SPOKEN.items()}
    assert named(ast.parse("x = q.name == 'omega_dot'")) == {"omega_dot"}
    assert named(ast.parse("x = {'omega': 1}['omega']")) == set()


ROOMS = ("program", "mechanics", "lower", "motion", "library", "verify")
SPOKEN = {
    "program/program": (["attitude"], "a role"),
    "mechanics/words": (["attitude"], "a role"),
    "mechanics/balance": (["force", "moment"], "kinds of balances"),
    "mechanics/balances": (["force", "moment"], "kinds of balances"),
    "mechanics/answers": (["angular_momentum", "rate_in_axes"], "answers and lecture steps"),
    "mechanics/bodies": (["angular_momentum"], "a lecture step"),
    "motion/attitude/functions": (["attitude"], "what the package itself calls an argument"),
    "motion/exact/orbit": (["moment"], "a constant that set-up makes"),
    "motion/moser_veselov/__init__": (["moment"], "a constant that set-up makes"),
    "library/setting": (["moment"], "what the program of a moment returns, read by place"),
    "verify/cloud/solution": (["angular_momentum", "rate_absolute"], "answers"),
}
"""Where names of quantities stand in text, and what they are there, if not a scene's quantities."""


def within(page: str) -> bool:
    """Tell whether a module is of the rooms from a problem to its program and its proof."""
    return page.partition("/")[0] in ROOMS


def named(tree: ast.Module) -> set[str]:
    """Return the vectors of scenes whose names stand in a module's text.

    Keys are none: what a dictionary of the module's own calls its values decides nothing.
    """
    keys = {id(k) for node in nodes_of(tree) if isinstance(node, ast.Dict) for k in node.keys}
    keys |= {id(node.slice) for node in nodes_of(tree) if isinstance(node, ast.Subscript)}
    texts = (n.value for n in nodes_of(tree) if isinstance(n, ast.Constant) and id(n) not in keys)
    plain = (re.sub("(_[wxyz]?)?$", "", text) for text in texts if isinstance(text, str))
    return {*plain} & QUANTITIES.keys()


def stem(name: str) -> str:
    """Return a name in the singular and without regard to letters' size."""
    plain = name.strip("_").lower()
    return plain[:-3] + "y" if plain.endswith("ies") else plain.removesuffix("s")


def types(pages: Mapping[str, ast.Module]) -> list[tuple[str, str]]:
    """Return each class, type alias and type variable: the module, the name.

    A plural that holds the singular, which its module imports, is the same word for the same thing.
    """
    return [
        (page, name)
        for page, tree in pages.items()
        for name in defined(tree)
        if name.strip("_")[:1].isupper() and not name.isupper()
        if not holds(name, tree)
    ]


def defined(tree: ast.Module) -> list[str]:
    """Return the names that a module defines at its top level."""
    found: list[str] = []
    for node in tree.body:
        match node:
            case ast.ClassDef(name) | ast.FunctionDef(name):
                found.append(name)
            case ast.Assign(targets):
                found += [t.id for t in targets if isinstance(t, ast.Name)]
            case ast.AnnAssign(ast.Name(name)):
                found.append(name)
    return found


def holds(name: str, tree: ast.Module) -> bool:
    """Tell whether a name is the plural of one that its module imports."""
    imported = (a.name for n in tree.body if isinstance(n, ast.ImportFrom) for a in n.names)
    return name in {f"{own}s" for own in imported}


def shared(pages: Mapping[str, ast.Module]) -> dict[str, list[str]]:
    """Return the names that types of several modules have, with where they stand."""
    return several(types(pages))


def words_of(page: str, tree: ast.Module) -> set[str]:
    """Return the words that the names of a module, and of what it defines, are made of."""
    own = page.removesuffix("/__init__").rpartition("/")[2]
    names = (own, *defined(tree))
    parts = (part for name in names for part in re.findall("[A-Z]+(?![a-z])|[A-Z]?[a-z0-9]+", name))
    return {w for part in parts for w in (part.lower(), part.lower().removesuffix("s"))}


def given_to_others(pages: Mapping[str, ast.Module]) -> list[tuple[str, str]]:
    """Return each function and constant that another module reads: its module, its name."""
    read = {place for tree in pages.values() for place in reads(tree)}
    return [
        (page, name)
        for page, tree in pages.items()
        for name in defined(tree)
        if (page.removesuffix("/__init__"), name) in read
        if name.isupper() or name.islower()
        if not holds(name, tree)
    ]


def apart(names: Iterable[tuple[str, str]]) -> tuple[list[tuple[str, str]], ...]:
    """Return functions and constants, each (module, name), apart."""
    each = list(names)
    return [n for n in each if n[1].islower()], [n for n in each if n[1].isupper()]


def reads(tree: ast.Module) -> Iterator[tuple[str, str]]:
    """Yield what a module reads of others: their page, the name."""
    modules: dict[str, str] = {}
    for node in nodes_of(tree):
        if isinstance(node, ast.ImportFrom):
            page = (node.module or "").removeprefix("derive").strip(".").replace(".", "/")
            yield from ((page, each.name) for each in node.names)
            modules |= {n.asname or n.name: f"{page}/{n.name}".strip("/") for n in node.names}
    for node in nodes_of(tree):
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            yield modules.get(node.value.id, ""), node.attr


def several(names: Iterable[tuple[str, str]]) -> dict[str, list[str]]:
    """Return, of (module, name), the stems that several modules define."""
    found: defaultdict[str, dict[str, list[str]]] = defaultdict(lambda: defaultdict(list))
    for page, name in names:
        found[stem(name)][page].append(f"{page}.{name}")
    return {
        word: [one for each in pages.values() for one in each]
        for word, pages in found.items()
        if len(pages) > 1
    }
