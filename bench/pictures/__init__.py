"""Pictures of the README, made of the project's own files by ``python -m bench.pictures``."""
