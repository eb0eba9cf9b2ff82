"""Other tools, each used in its own ordinary way; a tool that is absent is not run."""
