"""Scenes changed at random, from a seed: what was written in haste, or by a program that errs.

Entries are dropped, swapped, zeroed, negated, exchanged with those of other places, doubled,
renamed, moved, nested, given absurd values and units, and what is wanted is exchanged. Most of
what comes out is nonsense, which must be refused in words.
"""

import re
import signal
import tomllib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from copy import deepcopy
from decimal import Decimal
from pathlib import Path
from random import Random
from typing import Any

from derive.library.library import library
from derive.scene import CATALOGUE, SceneError, parse_scene
from derive.scene.results import MATRICES
from derive.scene.wanted import EQUATIONS, MOTIONS
from tests.scene.mutated import written

MOST, SECONDS = 300, 30
"""Characters of a sentence that is read at once; time that nobody minds to wait."""
ROOT = Path(__file__).parents[2]
FOLDERS = (CATALOGUE, ROOT / "tests" / "data" / "trials", ROOT / "tests" / "mechanics" / "scenes")
LONG_FORM = sorted((ROOT / "tests" / "data" / "long_form").glob("*.toml"))
"""Scenes of the catalogue, by the same names, written with frames, bodies and loads."""
LONG = "a" * 5000
NUMBERS = ("1e308", "-1", "0", "nan", "inf", "-inf", "1e-400", "1e400", "5e-324", "1e300", "0.1")
ODD: tuple[Any, ...] = (
    *(0, -1, 1, 10**400, "0", "", " ", "-1", "1/0", "pi", "q", "sqrt(-1)", "m)", "1e300"),
    *("(" * 300, "pi^2"),
    *(LONG, "é", "\N{KELVIN SIGN}", "１", "x\u202ey", "a\nb", "m.__class__", "z q", "?", "-?u"),
    *(True, [], [[]], {}, {"range": [0, 1]}, [0, 0, 0], ["0", "1"], [{}], [0, 1]),
    *map(Decimal, NUMBERS),
)
UNITS = ("", "1", "m", "kg", "rad", "N m", "m/s^2", "furlong", "kg^99", "m/", "é", 1, LONG)
NAMES = ("", " ", "é", "a b", "1a", "_", "int", "omega", "m_dot", "x" * 90, LONG, "range", "a.b")
ASKED = (*EQUATIONS, *MOTIONS, *MATRICES, "accelerations", "energy", "linearised", "steady")
TEXT = ("title", "source", "meaning", "unit", "wanted")
"""Entries for people, units, and what is wanted, which have changes of their own."""
Place = tuple[Any, Any]  # a table or list, and the key or index of one of its entries


def texts() -> dict[str, str]:
    """Return the scenes that are changed: of the catalogue, the trials, machines and the pages."""
    files = [p for folder in FOLDERS for p in sorted(folder.glob("*.toml"))]
    found = {p.stem: p.read_text(encoding="utf-8") for p in files}
    found |= {f"long_{p.stem}": p.read_text(encoding="utf-8") for p in LONG_FORM}
    for page in ("scenes", "motion"):
        text = (ROOT / "docs" / f"{page}.md").read_text(encoding="utf-8")
        blocks = re.findall(r"^```toml\n(.*?)^```$", text, re.M | re.S)
        found |= {f"{page}_{k}": block for k, block in enumerate(blocks)}
    return found


def changed(text: str, seed: str) -> str:
    """Return a scene with one to three of its entries changed at random."""
    dice, document = Random(seed), tomllib.loads(text, parse_float=Decimal)
    for _ in range(dice.choice((1, 1, 1, 2, 3))):
        if document:
            dice.choice(CHANGES)(dice, document)
    return written(document)


class TooLongError(BaseException):
    """The time for a scene is over; no handler of errors is to catch it."""


@contextmanager
def time_box(seconds: float) -> Iterator[None]:
    """Raise TooLongError after so many seconds of this process's own time."""

    def over(signum: int, frame: object) -> None:
        raise TooLongError

    before = signal.signal(signal.SIGVTALRM, over)
    signal.setitimer(signal.ITIMER_VIRTUAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        signal.signal(signal.SIGVTALRM, before)


def fault(text: str, name: str, then: Callable[[Any], Any] = library) -> str:
    """Return what is wrong with how a scene is taken, "" if it is read or refused in a sentence.

    then : what is made of a scene that is read
    """
    try:
        with time_box(SECONDS):
            then(parse_scene(text, name))
    except TooLongError:
        return f"not done within {SECONDS} s"
    except SceneError as error:
        says = str(error)
        plain = says.startswith(f"scene '{name}': ") and says.isprintable() and len(says) <= MOST
        return "" if plain else f"no sentence: {says!r}"
    except Exception as error:
        return f"{type(error).__name__}: {error}"
    return ""


def _places(value: Any) -> Iterator[Place]:
    """Yield the entries that are no text for people; a range is one entry."""
    for at in list(value) if isinstance(value, dict) else range(len(value)):
        if at in TEXT:
            continue
        yield value, at
        if isinstance(value[at], dict | list) and not str(at).endswith("range"):
            yield from _places(value[at])


def _kind(value: Any) -> str:
    """Return which values may stand for each other: a change of kind is refused at once."""
    if isinstance(value, str):
        return "turn" if value[1:2] == " " else "word" if value.isidentifier() else "formula"
    return f"list of {len(value)}" if isinstance(value, list) else type(value).__name__


def _one(dice: Random, document: Any) -> Place:
    return dice.choice(list(_places(document)) or [(document, next(iter(document)))])


def _leaf(dice: Random, document: Any) -> Place:
    plain = [(at, k) for at, k in _places(document) if not isinstance(at[k], dict)]
    return dice.choice(plain) if plain else _one(dice, document)


def _alike(dice: Random, document: Any) -> tuple[Place, Place]:
    """Return two entries of one kind."""
    at, key = first = _leaf(dice, document)
    kind = _kind(at[key])
    others = [(to, k) for to, k in _places(document) if _kind(to[k]) == kind]
    return first, dice.choice(others or [first])


def _drop(dice: Random, document: Any) -> None:
    at, key = _one(dice, document)
    del at[key]


def _swap(dice: Random, document: Any) -> None:
    (at, a), (to, b) = _alike(dice, document)
    at[a], to[b] = to[b], at[a]


def _copy(dice: Random, document: Any) -> None:
    (at, a), (of, b) = _alike(dice, document)
    at[a] = deepcopy(of[b])


def _odd(dice: Random, document: Any) -> None:
    at, key = _leaf(dice, document)
    at[key] = deepcopy(dice.choice(ODD))


def _negate(dice: Random, document: Any) -> None:
    at, key = _leaf(dice, document)
    value = at[key]
    if isinstance(value, str):
        at[key] = f"-({value})"
    elif isinstance(value, list):
        at[key] = [-x if isinstance(x, int | Decimal) else x for x in reversed(value)]
    elif isinstance(value, int | Decimal):
        at[key] = -value


def _range(dice: Random, document: Any) -> None:
    """Replace one number of a range or a list."""
    every = [v for at, k in _places(document) if isinstance(v := at[k], list) and v]
    if every:
        one = dice.choice(every)
        one[dice.randrange(len(one))] = dice.choice(ODD)


def _zero(dice: Random, document: Any) -> None:
    at, key = _leaf(dice, document)
    value = at[key]
    at[key] = [0, *value[1:]] if isinstance(value, list) else 0


def _inside(dice: Random, document: Any) -> None:
    """Change a formula: a name of it for another, or all of it taken off or divided by itself."""
    every = [(at, k) for at, k in _places(document) if _kind(at[k]) in ("formula", "word", "int")]
    if not every:
        return
    at, key = dice.choice(every)
    value = str(at[key])
    names = [n for part in ("parameters", "coordinates", "speeds") for n in document.get(part, {})]
    other = dice.choice(names or ["1"])
    at[key] = dice.choice((
        re.sub(r"[A-Za-z_]\w*", other, value, count=1), other, f"{value}*({other}/{other})",
        f"({value})/({other}-{other})*{other}", f"{value}*0", f"{value}*sin({other}/{other})",
        f"sqrt(({value})^2)", f"({value})^2/({value})", f"{value}*{other}/({other}+{other})",
        f"{value} - {value}", "0",
    ))  # fmt: skip


def _rename(dice: Random, document: Any) -> None:
    """Give an entry the name of another."""
    tables = [(at, k) for at, k in _places(document) if isinstance(at, dict)]
    at, key = dice.choice(tables or [(document, "wanted")])
    _, other = dice.choice(tables or [(document, "wanted")])
    at[other] = at.pop(key)


def _named(dice: Random, document: Any) -> None:
    """Give an entry a name that no list foresaw."""
    every = [(at, k) for at, k in _places(document) if isinstance(at, dict)]
    at, key = dice.choice(every or [(document, "wanted")])
    at[dice.choice(NAMES)] = at.pop(key)


def _moved(dice: Random, document: Any) -> None:
    """Put an entry into another table."""
    every = [at for at, _ in _places(document) if isinstance(at, dict)] or [document]
    at, to = dice.choice(every), dice.choice([document, *every])
    key = dice.choice(list(at))
    to[key] = at.pop(key)


def _unit(dice: Random, document: Any) -> None:
    every = [at[k] for at, k in _places(document) if isinstance(at[k], dict) and "unit" in at[k]]
    if every:
        dice.choice(every)["unit"] = dice.choice(UNITS)


def _spoken(dice: Random, document: Any) -> None:
    """Change a text for people, wherever one may stand."""
    tables = [document, *(at[k] for at, k in _places(document) if isinstance(at[k], dict))]
    dice.choice(tables)[dice.choice(("title", "source", "meaning"))] = dice.choice(ODD)


def _deep(dice: Random, document: Any) -> None:
    """Wrap an entry into many lists, tables, parentheses or signs."""
    at, key = _leaf(dice, document)
    value, depth = at[key], dice.choice((2, 30, 150))
    if dice.random() < 0.5:
        opened, closed = dice.choice((("(", ")"), ("-", ""), ("sin(", ")"), ("1/(1+", ")")))
        at[key] = opened * depth + str(value) + closed * depth
        return
    wrap = dice.choice((lambda x: [x], lambda x: {"x": x}))
    for _ in range(depth):
        value = wrap(value)
    at[key] = value


def _want(dice: Random, document: Any) -> None:
    names = [k for table in document.values() if isinstance(table, dict) for k in table]
    other = [name for name in (*ASKED, *names) if name not in document.get("wanted", [])]
    more = dice.sample(other, dice.choice((1, 2)))
    document["wanted"] = more if dice.random() < 0.5 else [*document.get("wanted", []), *more]


CHANGES = (
    *(_drop, _swap, _swap, _copy, _copy, _odd, _negate, _zero, _inside, _inside, _inside),
    *(_rename, _want, _want, _odd, _named, _moved, _unit, _spoken, _deep, _range),
)
