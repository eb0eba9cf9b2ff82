"""Arguments in, files, tables and an exit code out: a command a file."""
