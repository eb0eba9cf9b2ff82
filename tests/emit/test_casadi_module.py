"""A printed CasADi file is imported as it is, whatever was imported under its name before."""

import sys
from pathlib import Path

import pytest

from derive.emit.casadi_module import imported


def test_two_files_of_one_name_and_length_are_two_modules(tmp_path: Path) -> None:
    one, two = (imported("top_casadi", f"SPIN = {spin}\n", tmp_path) for spin in (1, 2))
    assert (one.SPIN, two.SPIN) == (1, 2)
    assert one.__name__ == two.__name__ == "top_casadi"


def test_an_imported_file_is_found_by_nobody_else(tmp_path: Path) -> None:
    imported("top_casadi", "", tmp_path)
    assert "top_casadi" not in sys.modules


def test_a_file_that_is_no_python_is_refused(tmp_path: Path) -> None:
    with pytest.raises(SyntaxError, match="top_casadi"):
        imported("top_casadi", "def\n", tmp_path)
