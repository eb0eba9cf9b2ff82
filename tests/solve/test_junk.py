"""Whatever is given to whatever argument of the interface: it is taken, or refused in one sentence.

The methods are found by their names and their arguments by their signatures, so a new one is tried
as soon as it is there; it needs a row of good values in ``GOOD``.
"""

import inspect
from collections.abc import Callable, Mapping
from datetime import UTC, datetime
from decimal import Decimal
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import derive

BALL = {"wanted": ["moment"], "body": {"kind": "spherical", "moment": 0.4}}


class Hostile:
    """What no array can be made of and no text shows."""

    def __array__(self, *_: Any) -> Any:
        raise RuntimeError

    def __repr__(self) -> str:
        raise RuntimeError


ROUND: list[Any] = []
ROUND += [ROUND]
JUNK: Mapping[str, Any] = {
    "none": None, "text": "1", "unit": "1ms", "empty": "", "bytes": b"1", "nan": float("nan"),
    "inf": float("inf"), "minus": -1, "zero": 0, "true": True, "complex": 1j, "huge": 10**400,
    "more digits": 10**5000, "decimal": Decimal(1), "now": datetime.now(UTC), "list": [],
    "texts": ["1"], "itself": ROUND, "many digits": (10**5000,), "dict": {}, "numbered": {1: 2},
    "odd": {"m": object()}, "digits": {"m": 10**5000}, "set": {1}, "range": range(3),
    "object": object(), "hostile": Hostile(), "type": Hostile, "function": np.sin,
    "masked": np.ma.array([1.0, 2.0, 3.0], mask=[0, 1, 0]), "a mask": np.ma.masked,
    "masked in a list": [np.ma.array(1.0, mask=True), 2.0, 3.0], "matrix": np.zeros((2, 2)),
    "objects": np.array([None, 1]), "fields": np.zeros(2, [("a", float)]),
    "whole": np.int64(3), "no number": np.array(np.nan), "date": np.datetime64("2020"),
    "zero byte": "a\0b", "half a pair": "\ud800", "long": "x" * 5000,
}  # fmt: skip
PATHS = {"text", "unit"}
NUMBERS = {"nan", "inf", "minus", "zero", "whole", "no number"}
TAKEN: Mapping[str, set[str]] = {
    "source": set(), "scenes": {"list"}, "folder": PATHS, "plot": PATHS | {"none"},
    "samples": {"whole"}, "until": NUMBERS | {"none"}, "step": {"whole"},
    "told": {"function", "type"}, "parameters": {"none", "dict"}, "values": {"dict"},
    "tensor": set(), "omega": {"no number"}, "omega_dot": {"no number"}, "guess": {"none"},
    "stop": {"none"},
}  # fmt: skip
"""What makes sense as an argument of a name, or whose range other tests try."""


def methods() -> dict[str, Callable[..., Any]]:
    """Return every function of the interface and every method of a scene and of its function."""
    ball = derive.load(BALL, "ball")
    moment = ball.function("moment")
    own = [n for n in vars(derive.Handle) if n[0] != "_" and callable(getattr(ball, n, None))]
    found = {n: getattr(derive, n) for n in derive.__all__ if n[0].islower()}
    found |= {n if n != "generate" else "scene.generate": getattr(ball, n) for n in own}
    return found | {"call": lambda omega, omega_dot: moment(omega=omega, omega_dot=omega_dot)}


def good(folder: Path) -> dict[str, Any]:
    """Return for each name of an argument what makes sense."""
    return {
        "source": BALL, "name": "ball", "scenes": [derive.load(BALL, "ball")], "folder": folder,
        "samples": 4, "figures": "kept", "tell": "costs", "parts": "usual", "told": lambda _: None,
        "tensor": np.eye(3), "parameters": {}, "precision": "double", "by": "any",
        "values": {}, "until": 0.01, "step": 1e-3, "plot": None, "form": "text", "stop": None,
        "steady": "steady", "vary": {"m": "uniform(1, 2)"}, "keep": ["omega_x"], "error": None,
        "seed": 0, "instants": 20, "pairs": 0, "workers": 1, "scheduler": None, "chunk": None,
        "near": None,
        "omega": [1, 2, 3], "omega_dot": [1, 2, 3],
        "scene": derive.load(BALL, "ball"), "turn": "z 1", "end": {}, "limits": {}, "avoid": (),
        "cost": {"time": 1}, "steps": 10, "starts": 1, "method": "shooting", "solver": "ipopt",
        "guess": None,
    }  # fmt: skip


CASES = [
    (method, argument)
    for method, call in methods().items()
    for argument in inspect.signature(call).parameters
]


def test_all_methods_are_tried() -> None:
    assert len({method for method, _ in CASES}) >= 16
    assert {argument for _, argument in CASES} == {*good(Path())}


@pytest.mark.long
def test_whatever_an_argument_is_given_is_taken_or_refused_in_one_sentence(tmp_path: Path) -> None:
    every = methods()
    for method, argument in CASES:
        told = {n: x for n, x in good(tmp_path).items() if (method, n) in CASES}
        told |= {"by": "step_rk4"} if method == "simulate" else {}
        for kind in JUNK.keys() - TAKEN.get(argument, set()):
            with pytest.raises(derive.DeriveError) as refused:
                every[method](**told | {argument: JUNK[kind]})
            sentence = str(refused.value)
            assert len(sentence) < 250, (method, argument, kind, sentence)
            assert "\n" not in sentence
            assert " object at " not in sentence
    assert list(tmp_path.iterdir()) == []
