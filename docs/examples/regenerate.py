"""A satellite is weighed and has products of inertia: its scene changes, and all code with it."""

import tomllib

from matplotlib.figure import Figure

import derive

wanted = ["acceleration", "moment", "kinetic_energy", "step_rk4_unit", "step_rk4_unit_jacobian"]
drawn = tomllib.loads(derive.load("satellite").scene.text) | {"wanted": wanted}
products = {f"I_{ab}": {"unit": "kg m^2", "range": [-0.2, 0.2]} for ab in ("xy", "xz", "yz")}
tensor = {"kind": "general", "moments": drawn["body"]["moments"], "products": [*products]}
weighed = drawn | {"parameters": drawn["parameters"] | products, "body": tensor}

costs, before = {}, {}
for version, document in {"as drawn": drawn, "as weighed": weighed}.items():
    (made,) = derive.load(document, name="satellite").generate("firmware", samples=256).made
    costs[version] = {row.function: row.flops for row in made.costs}
    worst = max(row.errors[0][1] for row in made.costs)
    new = sum(before.get(file) != text for file, text in made.texts.items())
    before = made.texts
    print(f"{version}: {new} of {len(before)} files are new; errors of the floats: {worst:.1f} u")
for name in wanted:
    print(f"{name:24}", *(f"{each[name]:6}" for each in costs.values()))

figure = Figure(figsize=(6, 3), layout="constrained")
axes = figure.subplots()
for place, (version, each) in enumerate(costs.items()):
    bars = axes.barh([k + 0.4 * place for k in range(len(each))], each.values(), 0.4, label=version)
    axes.bar_label(bars, padding=3)
axes.set_yticks([k + 0.2 for k in range(len(wanted))], wanted)
axes.invert_yaxis()
axes.margins(x=0.15)
axes.set_xlabel("operations + - * / of a call")
axes.legend()
figure.savefig("regenerate.svg", metadata={"Date": None})
