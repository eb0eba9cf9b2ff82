"""Programs for all cases, made before anything is timed: scenes compiled, peers' passes counted."""

import math
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise
from pathlib import Path

from bench.build import BuildError
from bench.motion.ours import Emission, emission, ours
from bench.motion.peer_count import counted
from bench.motion.peers import Peer
from bench.motion.runner import Mover
from bench.report.case_run import ANY, PRECISIONS, Workshop
from bench.report.point import Limits
from bench.report.settings import tolerances
from derive.scene import SceneError

COUNTED_CASE, SHORT_CASE = "asym_ii_generic", "const_body_torque"
SLOW = ("scipy", "mujoco")  # under callgrind; a short case does for them
WORKERS = 2


def workshop(
    scenes: Sequence[str], peers: Sequence[Peer], limits: Limits, folder: Path
) -> Workshop:
    """Return everything that cases of these scenes are run with, passes of ``peers`` counted."""
    with ThreadPoolExecutor(WORKERS) as pool:
        counting = [pool.submit(per_pass, peer, limits, folder) for peer in peers]
        ready = list(pool.map(_programs, scenes, [folder] * len(scenes)))
        counts = {key: count for found in counting for key, count in found.result().items()}
    emissions = {scene: made for scene, (made, _) in zip(scenes, ready, strict=True) if made}
    movers = {
        (scene, precision): mover
        for scene, (_, built) in zip(scenes, ready, strict=True)
        for precision, mover in built.items()
    }
    return Workshop(emissions, movers, folder, limits, counts)


def _programs(scene: str, folder: Path) -> tuple[Emission | None, Mapping[str, Mover | str]]:
    """Return the emission of a scene and its program in each precision, or why there is none."""
    try:
        made = emission(scene)
    except SceneError as reason:
        return None, dict.fromkeys(PRECISIONS, str(reason))
    built: dict[str, Mover | str] = {}
    for precision in PRECISIONS:
        try:
            built[precision] = ours(made, precision, folder / f"{scene}_{precision}")
        except BuildError as reason:
            built[precision] = str(reason)
    return made, built


def per_pass(peer: Peer, limits: Limits, folder: Path) -> dict[tuple[str, float], float]:
    """Return the instructions of a peer's pass at each of its settings, by callgrind.

    A tolerance changes the pass of a Taylor series only, whose order is linear in its logarithm, so
    three tolerances tell those between; a step changes none.
    """
    settings = tolerances("package", limits.ratio**6.6)
    places = (0, len(settings) // 2, -1) if peer.package == "heyoka" else (2,)
    asked = [settings[n] for n in places] if peer.setting == "tolerance" else [2.0**-6]
    case = SHORT_CASE if peer.package in SLOW else COUNTED_CASE
    jobs = [(case, value) for value in (asked[0], *asked)]  # the first one warms up
    try:
        found = counted(peer, jobs, folder / peer.package)
    except (FileNotFoundError, BuildError):
        return {}
    counts = [found[case, value] for value in asked]
    if len(asked) == 1:
        return {(peer.name, ANY): counts[0]}
    return {(peer.name, v): between(v, asked, counts) for v in settings}


def between(value: float, asked: Sequence[float], counts: Sequence[float]) -> float:
    """Return a count between those that are known, by straight lines over the logarithm.

    >>> between(1e-4, [1e-2, 1e-6], [100.0, 200.0])
    150.0
    """
    pairs = list(zip(asked, counts, strict=True))
    for (a, m), (b, n) in pairwise(pairs):
        if b <= value <= a:
            return m + (n - m) * math.log(a / value) / math.log(a / b)
    return counts[-1]
