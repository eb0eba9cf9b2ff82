"""The bench: every function beside the best hand-written form and what other tools emit."""
