"""Run the command line, as ``derive`` or ``python -m derive``."""

import sys
from importlib import import_module

STOPPED = 130  # what a shell expects after an interrupt


def run() -> int:
    """Return the exit code of the command line; it may be stopped while it is still imported."""
    try:
        code: int = import_module("derive.cli").main()
    except KeyboardInterrupt:
        sys.stderr.write("derive: stopped before it began\n")
        return STOPPED
    return code


if __name__ == "__main__":
    sys.exit(run())
