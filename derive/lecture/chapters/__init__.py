"""The lecture, one chapter a file, in reading order."""

from dataclasses import dataclass

from derive.lecture.chapters import (
    attitude,
    general_form,
    gyrostat,
    machines,
    momentum,
    moving_axes,
    particles,
    rigid_body,
    symmetry,
)
from derive.lecture.step import Derivation, Step


@dataclass(frozen=True)
class Chapter:
    """A title, what the chapter is about, and its steps."""

    title: str
    says: str
    steps: tuple[Step, ...]


CHAPTERS = (
    Chapter("Particles", particles.__doc__ or "", particles.STEPS),
    Chapter("Angular momentum", momentum.__doc__ or "", momentum.STEPS),
    Chapter("The rigid body", rigid_body.__doc__ or "", rigid_body.STEPS),
    Chapter("Symmetry", symmetry.__doc__ or "", symmetry.STEPS),
    Chapter("Moving axes", moving_axes.__doc__ or "", moving_axes.STEPS),
    Chapter("The general form", general_form.__doc__ or "", general_form.STEPS),
    Chapter("The gyrostat", gyrostat.__doc__ or "", gyrostat.STEPS),
    Chapter("Attitude", attitude.__doc__ or "", attitude.STEPS),
    Chapter("Machines", machines.__doc__ or "", machines.STEPS),
)
LECTURE = Derivation(
    "From the sum over particles to Euler's equations",
    tuple(step for chapter in CHAPTERS for step in chapter.steps),
)
