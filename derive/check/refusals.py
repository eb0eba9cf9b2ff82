"""What the compiled set-up and CasADi's say of hostile parameters: one status for all."""

from collections.abc import Mapping, Sequence
from math import isfinite, isnan
from random import Random
from typing import Any

import casadi

from derive.check.admission import extremes_of, fault, hostile, replayed_statuses
from derive.check.emitted import Emitted, verdict
from derive.check.verdict import JUDGED, Verdict
from derive.program.status import RIGHT
from derive.verify.sample import Sample

HOSTILE = 40  # draws of parameters that no body may have, beside one bad parameter at a time


def refuses_alike(emitted: Emitted, each: Sequence[Sample]) -> Verdict:
    """Return whether set-up refuses what the scene's declaration refuses, by the same rule."""
    setup, check_ = emitted.library.setup, "refuses what is no body"
    if not emitted.library.constants:
        return verdict(emitted, "setup", check_, "skipped", "there is no set-up to refuse anything")
    bad = [f"sample {s.number}" for s in each if emitted.constants(s)["status"] != [RIGHT]]
    drawn = _hostile(emitted)
    found = [_status(emitted, values) for values in drawn]
    for values, status, same in zip(
        drawn, found, replayed_statuses(setup, drawn, emitted.precision), strict=True
    ):
        finite = all(map(isfinite, _made(emitted, values)["constants"]))
        ends = extremes_of(values, emitted.precision, finite=finite)
        says = fault(emitted.library.scene, values, emitted.precision, status, ends)
        says = says or ("" if same == status else f"{status}, by the program {same}")
        bad += [f"{says} at {values}"] if says else []
    refused = sum(status != RIGHT for status in found)
    says = f"{len(each)} bodies taken, {refused} of {len(drawn)} hostile ones refused"
    says = f"{len(bad)} wrong, first {bad[0]}" if bad else says
    return verdict(emitted, "setup", check_, JUDGED[not bad], says)


def _hostile(emitted: Emitted) -> list[dict[str, float]]:
    """Return hostile parameters for the scene's set-up, the same at every run."""
    seed = f"derive: {emitted.library.scene.name} {emitted.precision.name} hostile"
    return hostile(emitted.library.setup, emitted.precision, HOSTILE, Random(seed))  # noqa: S311


def _made(emitted: Emitted, values: Mapping[str, float]) -> dict[str, list[float]]:
    return emitted.functions["setup"]({name: [x] for name, x in values.items()})


def _status(emitted: Emitted, values: Mapping[str, float]) -> int:
    return int(_made(emitted, values)["status"][0])


def casadi_status(emitted: Emitted, module: Any) -> Verdict:
    """Return whether CasADi gives the status of C, and no constants where C refuses."""
    makes, tries, bad = module.setup(), module.setup_status(), 0
    drawn = _hostile(emitted)
    for values in drawn:
        given = casadi.DM([values[name] for name in module.PARAMETERS])
        status = _status(emitted, values)
        silent = status != RIGHT and any(not isnan(x) for x in makes(given).nonzeros())
        bad += int(tries(given)) != status or silent
    says = f"{bad} of {len(drawn)} differ" if bad else f"{len(drawn)} hostile parameters"
    return verdict(emitted, "setup", "CasADi's status", JUDGED[not bad], says)
