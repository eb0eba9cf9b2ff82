"""``derive equations``: the equations of a scene, for papers, terminals and SymPy."""

import argparse
import sys

import derive


def options(command: argparse.ArgumentParser) -> None:
    """Declare the options of ``derive equations``."""
    command.add_argument("scene", metavar="SCENE", help="catalogue name or path to a TOML file")
    forms = command.add_mutually_exclusive_group()
    for form, says in (
        ("text", "for a terminal, in Unicode or in ASCII as the terminal can (the default)"),
        ("latex", "a document that compiles, with amsmath"),
        ("sympy", "a module of Python that needs SymPy only"),
    ):
        forms.add_argument(f"--{form}", dest="form", action="store_const", const=form, help=says)
    command.set_defaults(run=print_equations, form="text")


def print_equations(given: argparse.Namespace) -> int:
    """Print the equations of a scene."""
    encoding = sys.stdout.encoding or "ascii"
    scene = derive.load(given.scene)
    told = scene.equations(given.form)
    try:
        told.encode(encoding)
    except UnicodeEncodeError:
        if given.form != "text":
            says = f"equations --{given.form} prints UTF-8, and {encoding} was asked for"
            raise derive.DeriveError(f"{says}; set PYTHONIOENCODING=utf-8") from None
        told = scene.equations("ascii")
    sys.stdout.write(told)
    return 0
