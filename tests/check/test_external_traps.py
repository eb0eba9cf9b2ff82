"""What goes wrong where C is compiled and loaded says so in a sentence, or cannot happen."""

import shutil
import subprocess
import sys
import textwrap
from pathlib import Path
from types import ModuleType

import casadi as ca
import numpy as np
import pytest


def stub(folder: Path, name: str, does: str) -> str:
    """Return a command that stands for a compiler; it writes what follows -o."""
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / name
    says = 'while [ "$1" != -o ]; do shift; done'
    file.write_text(f"#!/bin/sh\n{says}\n{does}\n", encoding="utf-8")
    file.chmod(0o755)
    return str(file)


def test_a_library_without_a_pattern_is_refused(
    module: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made_ = subprocess.run(
        ["cc", "-shared", "-x", "c", "-", "-o", str(tmp_path / "empty.so")],
        input=b"int craft_steps(void) { return 0; }", check=True,
    )  # fmt: skip
    assert made_.returncode == 0
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setenv("CC", stub(tmp_path, "cc", f'cp {tmp_path}/empty.so "$2"'))
    with pytest.raises(RuntimeError, match="lacks 'craft_steps_n_in': delete it"):
        module.external(2)


def test_what_is_no_library_is_refused(
    module: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setenv("CC", stub(tmp_path, "cc", 'echo no >"$2"'))
    with pytest.raises(RuntimeError, match="cannot be loaded here, delete it"):
        module.external(2)


def test_a_compiler_that_fails_is_quoted_and_leaves_nothing(
    module: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "kept"))
    monkeypatch.setenv("CC", stub(tmp_path, "cc", "echo out of order >&2; exit 1"))
    with pytest.raises(RuntimeError, match="made no library and said: out of order"):
        module.external(2)
    assert not list((tmp_path / "kept" / "derive").iterdir())


def test_no_compiler_is_one_sentence(module: ModuleType, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shutil, "which", lambda _: None)
    monkeypatch.setattr("importlib.util.find_spec", lambda _: None)
    with pytest.raises(RuntimeError, match="no C compiler: set CC"):
        module.external(2)


def test_a_cache_that_cannot_be_written_is_one_sentence(
    module: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "derive").write_text("no folder", encoding="utf-8")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    with pytest.raises(RuntimeError, match=r"the cache folder .* must be writable"):
        module.external(2)


@pytest.mark.parametrize("steps", [0, -1, 1.5, True, "3", np.float64(3)])
def test_a_number_of_steps_that_is_none_is_refused(module: ModuleType, steps: object) -> None:
    with pytest.raises(ValueError, match="steps must be a whole number"):
        module.external(steps)


@pytest.mark.long
def test_a_number_of_steps_of_numpys_is_one(
    module: ModuleType, cache_of_three: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(cache_of_three))
    before = sorted((cache_of_three / "derive").glob("*.so"))
    assert module.external(np.int64(3)).size_in(0) == (7, 3)
    assert sorted((cache_of_three / "derive").glob("*.so")) == before


@pytest.mark.long
def test_two_processes_that_build_at_once_both_have_it(
    module: ModuleType, cache_of_three: Path, tmp_path: Path
) -> None:
    (library_,) = (cache_of_three / "derive").glob("*.so")
    slow = stub(tmp_path, "cc", f'head -c 2000 {library_} >"$2"; sleep 0.5; cp {library_} "$2"')
    says = f"""
        import sys; sys.path.insert(0, {str(Path(str(module.__file__)).parent)!r})
        import craft_casadi
        print(craft_casadi.external(3)(1, 0, 0.1, [1.4, 1.6, 1.8])[0, 0] > 0)
        """
    command = [sys.executable, "-c", textwrap.dedent(says)]
    own = {"CC": slow, "XDG_CACHE_HOME": str(tmp_path / "kept"), "PATH": "/usr/bin:/bin"}
    both = [
        subprocess.Popen(command, env=own, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        for _ in range(2)
    ]
    found = [one.communicate() for one in both]
    assert [out.strip() for out, _ in found] == [b"1", b"1"], found
    assert [p.suffix for p in (tmp_path / "kept" / "derive").iterdir()] == [".so"]


@pytest.mark.long
def test_a_library_of_other_contents_is_another_under_the_same_name(
    module: ModuleType, cache_of_three: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What is found is what the files beside the module are now, not what was built before."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(cache_of_three))
    before = module.external(3)(1, 0, 0.1, [1.4, 1.6, 1.8])
    source = Path(str(module.__file__)).parent / "craft_external.c"
    text = source.read_text(encoding="utf-8")
    source.write_text(text.replace("double h = made->h;", "double h = 2 * made->h;"), "utf-8")
    try:
        after = module.external(3)(1, 0, 0.05, [1.4, 1.6, 1.8])
    finally:
        source.write_text(text, encoding="utf-8")
    assert float(ca.norm_inf(before - after)) == 0
    assert float(ca.norm_inf(module.external(3)(1, 0, 0.05, [1.4, 1.6, 1.8]) - before)) > 0
