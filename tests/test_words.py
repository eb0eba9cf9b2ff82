"""One word, one thing: no name of the package is defined twice for different things."""

import ast
import re
from collections import defaultdict
from collections.abc import Iterable, Mapping
from pathlib import Path

from derive.scene.short_form.quantities import QUANTITIES

ROOT = Path(__file__).parent.parent / "derive"
PAGES = {
    str(page.relative_to(ROOT).with_suffix("")): ast.parse(page.read_text(encoding="utf-8"))
    for page in sorted(ROOT.rglob("*.py"))
}


WAITING = ("block", "entry", "kind", "row", "term")
"""Still two things each."""


def test_no_two_modules_define_types_of_one_name() -> None:
    assert len(types(PAGES)) > 150
    assert sorted(shared(PAGES)) == sorted(WAITING)


def test_a_second_type_of_a_name_is_found_whether_class_or_alias_or_plural() -> None:
    first = {"a": ast.parse("class Block: pass")}
    assert shared({**first, "b": ast.parse("Blocks = list[int]")}) == {
        "block": ["a.Block", "b.Blocks"]
    }
    assert shared({**first, "b": ast.parse("class Bloc: pass")}) == {}
    assert shared({**first, "b": ast.parse("from x import Block\nclass Blocks: pass")}) == {}


def test_no_name_of_a_scenes_quantity_decides_anything() -> None:
    found = {page: read for page in PAGES if (read := named(PAGES[page])) and within(page)}
    assert found == {page: {*names} for page, (names, _) in SPOKEN.items()}
    assert named(ast.parse("x = q.name == 'omega_dot'")) == {"omega_dot"}
    assert named(ast.parse("x = {'omega': 1}['omega']")) == set()


ROOMS = ("program", "mechanics", "lower", "motion", "library", "verify")
SPOKEN = {
    "program/program": (["attitude"], "a role"),
    "mechanics/words": (["attitude"], "a role"),
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
    keys = {id(k) for node in ast.walk(tree) if isinstance(node, ast.Dict) for k in node.keys}
    keys |= {id(node.slice) for node in ast.walk(tree) if isinstance(node, ast.Subscript)}
    texts = (n.value for n in ast.walk(tree) if isinstance(n, ast.Constant) and id(n) not in keys)
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
