"""``python -m bench.control``: a horizon's derivatives and predictive control, timed in one run."""

import sys

from bench import horizon, nmpc


def main() -> int:
    """Print the tables of both; return the exit code."""
    return horizon.main() or nmpc.main()


if __name__ == "__main__":
    sys.exit(main())
