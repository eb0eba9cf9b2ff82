"""A compiler is found or its lack explained; a warning is an error; the JSON suffices to call."""

import json
from pathlib import Path

import pytest

from derive.check.call import c_functions
from derive.check.compiler import Compiler, CompilerError, compiled, find_compiler
from derive.program.precision import F64

HEADER = "double twice(double x);\n"
SOURCE = '#include "t.h"\ndouble twice(double x) { return 2.0 * x; }\n'


def test_the_compiler_named_by_cc_comes_first(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CC", "cat -v")
    assert find_compiler() == Compiler(("cat", "-v"))


def test_without_any_compiler_one_sentence_says_how_to_get_one(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("CC", "")
    monkeypatch.setenv("PATH", "")
    monkeypatch.setattr("derive.check.compiler.find_spec", lambda _: None)
    with pytest.raises(CompilerError, match=r"set CC, .* `python -m pip install ziglang`"):
        find_compiler()


def test_the_wheel_of_zig_is_the_last_resort(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CC", "")
    monkeypatch.setenv("PATH", "")
    monkeypatch.setattr("derive.check.compiler.find_spec", lambda name: name == "ziglang" or None)
    assert find_compiler().name == "python -m ziglang cc"


def test_the_same_texts_are_compiled_once(tmp_path: Path) -> None:
    first = compiled({"t.h": HEADER, "t.c": SOURCE}, "t.c", tmp_path, find_compiler())
    made = first.stat().st_mtime_ns
    assert compiled({"t.h": HEADER, "t.c": SOURCE}, "t.c", tmp_path, find_compiler()) == first
    assert first.stat().st_mtime_ns == made


def test_a_warning_is_refused_with_the_compilers_words(tmp_path: Path) -> None:
    narrow = SOURCE.replace("2.0 * x", "2.0 * (float)x")
    with pytest.raises(CompilerError, match="double-promotion"):
        compiled({"t.h": HEADER, "t.c": narrow}, "t.c", tmp_path, find_compiler())


def test_a_compiler_that_fails_without_a_word_is_said_to(tmp_path: Path) -> None:
    with pytest.raises(CompilerError, match="said: nothing, and ended with code 1"):
        compiled({"t.c": SOURCE}, "t.c", tmp_path, Compiler(("false",)))


MANIFEST = """{"functions": [{"name": "sum", "returns": "int: 0", "symbols": {"f64": "sum_f64"},
 "arguments": [
  {"name": "k", "direction": "in", "type": "scalar", "shape": [], "components": ["k"]},
  {"name": "v", "direction": "in", "type": "array", "shape": [2], "components": ["x", "y"]},
  {"name": "w", "direction": "out", "type": "array", "shape": [2], "components": []},
  {"name": "s", "direction": "out", "type": "pointer", "shape": [], "components": ["s"]}]}]}"""
SUM = """int sum_f64(double k, const double v[2], double w[2], double *s);
int sum_f64(double k, const double v[2], double w[2], double *s)
{
    w[0] = k * v[0];
    w[1] = k * v[1];
    *s = v[0] + v[1];
    return 0;
}
"""


def test_a_function_is_called_by_its_description(tmp_path: Path) -> None:
    library = compiled({"s.c": SUM}, "s.c", tmp_path, find_compiler())
    called = c_functions(json.loads(MANIFEST), library, F64.name)["sum"]
    given = {"k": [2.0], "v": [3.0, 4.0]}
    assert called(given) == {"w": [6.0, 8.0], "s": [7.0], "status": [0.0]}
    assert called.over(given, "w", "v")["s"] == [14.0]  # this C does not allow it
