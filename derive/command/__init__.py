"""What the command line does, a command a file: its options, and what runs it."""
