"""Firmware: a scene as C in float, with the loop of loop.c around it; built, run and drawn."""

import os
import shlex
import subprocess
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import derive

here, name = Path(__file__).parent, "satellite_on_wheels"
derive.load(here / "firmware" / f"{name}.toml").generate("generated", samples=256)
folder = Path("generated") / name
files = [f"-I{folder}", here / "loop.c", folder / f"{name}_f32.c", "-lm", "-o", "loop"]
subprocess.run([*shlex.split(os.environ.get("CC", "cc")), "-std=c99", "-O2", *files], check=True)
said = subprocess.run("./loop", capture_output=True, check=True, text=True).stdout
rows = np.array([line.split() for line in said.splitlines()], dtype=float)
times, turns, torques = rows[:, 0], np.degrees(2 * np.arcsin(rows[:, 1:4])), rows[:, 4:]
for time in (0, 5, 10, 20):
    print(f"{time:2} s: {np.abs(turns[10 * time]).max():7.3f} degrees off")
full = (np.abs(torques).max(axis=1) > 0.1999).sum() / 10
print(f"a motor at its limit for {full:.1f} s")

axes = (figure := Figure(figsize=(6, 4), layout="constrained")).subplots(2, sharex=True)
for own, lines, label in zip(axes, (turns, torques), ("degrees off", "motors, N m"), strict=True):
    own.plot(times, lines, label=["x", "y", "z"])
    own.set_ylabel(label)
axes[0].legend()
axes[1].set_xlabel("s")
figure.savefig("loop.svg", metadata={"Date": None})
