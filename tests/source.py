"""What source texts are made of: each is parsed and walked once, whoever asks."""

import ast
from functools import cache


@cache
def parsed(text: str) -> ast.Module:
    """Return the tree of a source text."""
    return ast.parse(text)


@cache
def nodes_of(tree: ast.AST) -> tuple[ast.AST, ...]:
    """Return all that a tree is made of."""
    return tuple(ast.walk(tree))
