"""``derive schema``: what editors are told of a scene file."""

import argparse
import sys

from derive.scene.schema import schema_text


def options(command: argparse.ArgumentParser) -> None:
    """Declare ``derive schema``, which has no options."""
    command.set_defaults(run=print_schema)


def print_schema(_: argparse.Namespace) -> int:
    """Print the JSON Schema of a scene."""
    sys.stdout.write(schema_text())
    return 0
