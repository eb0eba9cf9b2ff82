"""Which pages a page leads to: the scenes beside it in the catalogue."""

from derive.scene import Scene, argument, catalogue


def neighbours(scene: Scene) -> dict[str, str]:
    """Return the scenes before and after one of the catalogue, by relation; of others, none."""
    names = catalogue()
    if argument(scene) not in names:
        return {}
    place = names.index(scene.name)
    each = {"prev": place - 1, "next": place + 1}
    return {relation: names[k] for relation, k in each.items() if 0 <= k < len(names)}
