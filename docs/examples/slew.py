"""The fastest half turn of a satellite: three moments that switch between their limits."""

import numpy as np
from matplotlib.figure import Figure

import derive

inertia = {"I_xx": 1.4, "I_yy": 1.6, "I_zz": 1.8}
satellite = derive.load("satellite")
found = derive.steer(satellite, inertia, "z 180deg", limits={"moment": 0.4}, starts=2)
print(f"{found.until:.6f} s, and where it is flown the end is missed by less than 1e-9:", end=" ")
print(found.missed < 1e-9)
for cost, starts in found.minima:
    print(f"a local minimum, on 40 steps, from {starts} of 2 starts: {cost:.3f} s")
for time, name, now in found.switches:
    print(f"{time:8.4f} s {name} {now}")

figure = Figure(figsize=(6, 4), layout="constrained")
above, below = figure.subplots(2, sharex=True)
for name, values in found.states.items():
    if name.startswith("attitude"):
        above.plot(found.times, values, label=name)
times, inputs = found.inputs
for (name, values), slope in zip(inputs.items(), found.conditions.switching, strict=True):
    (line,) = below.plot(times, values, label=name)
    scaled = 0.4 * slope / np.abs(slope).max()
    below.plot(found.times[1:], scaled, "--", color=line.get_color(), linewidth=0.8)
below.set(xlabel="s", ylabel="N m; dashed, dH/du")
for axes in (above, below):
    axes.legend(loc="center left", bbox_to_anchor=(1, 0.5))
figure.savefig("slew.svg", metadata={"Date": None})
