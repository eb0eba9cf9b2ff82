"""A scene and how its numbers scatter in, ends and courses of very many motions out."""

from derive.solve.sweep.ensemble import Ensemble, ToldOfSweep, unheard
from derive.solve.sweep.request import Request
from derive.solve.sweep.shown import swept_and_shown

__all__ = ["Ensemble", "Request", "ToldOfSweep", "swept_and_shown", "unheard"]
