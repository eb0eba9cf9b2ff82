"""What a scene would have to say for an answer that it does not give: advice that can be followed.

An answer that no such scene can give is said to be none, with the reason.
"""

import tomllib

from derive.scene import Scene, SceneError, document_text, parse_scene

OF_MACHINES = {"linearised", "steady"}
"""What the short form of a scene has no word for."""


def advice_on(scene: Scene, function: str, what: str) -> str:
    """Return the sentence on a scene that does not want ``function``, which ``what`` needs."""
    document = tomllib.loads(scene.text)
    says = f"scene '{scene.name}': {what}"
    if not {"bodies", "frames"} & document.keys():
        if function in OF_MACHINES:
            mend = "`derive new machine` starts a scene with frames and bodies"
            return f"{says} is of machines, and this scene is not written as one; {mend}"
        return _refusal(scene, document, function) or _wanted(says, function)
    if not any(m.free for m in (*scene.coordinates, *scene.speeds)) and function != "steady":
        return f"{says} needs a free coordinate or speed, and here none is"
    return f"{says} needs [steady]" if function == "steady" else _wanted(says, function)


def _wanted(says: str, function: str) -> str:
    return f'{says} needs wanted = [..., "{function}"]'


def _refusal(scene: Scene, document: dict[str, object], function: str) -> str:
    """Return why a scene cannot want a function, "" if it can."""
    try:
        parse_scene(document_text(document | {"wanted": [function]}, scene.name), scene.name)
    except SceneError as error:
        return str(error)
    return ""
