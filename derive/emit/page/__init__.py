"""A lecture or a library in, HTML for people out."""
