"""A problem in, a program out: its arrangement, its graph, the cheapest form, its operations."""
