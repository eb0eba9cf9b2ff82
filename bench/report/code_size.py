"""The code that a step takes on a Cortex-M4F, as the cross-compiler makes it."""

import shutil
from pathlib import Path

from bench.build import BuildError, run
from bench.motion.ours import Emission

ARM = ("arm-none-eabi-gcc", "-mcpu=cortex-m4", "-mthumb", "-mfpu=fpv4-sp-d16",
       "-mfloat-abi=hard", "-Os", "-std=c99")  # fmt: skip


def code_size(made: Emission, folder: Path) -> int | None:
    """Return the bytes of code of ``step_rk4_jacobian`` in float on a Cortex-M4F."""
    functions = {f["name"]: f for f in made.manifest["functions"]}
    if not shutil.which(ARM[0]) or "step_rk4_jacobian" not in functions:
        return None
    place = folder / "arm"
    place.mkdir(parents=True, exist_ok=True)
    for name, text in made.texts.items():
        (place / name).write_text(text, encoding="utf-8")
    source = place / made.manifest["files"]["f32"]["source"]
    try:
        run((*ARM, "-ffunction-sections", "-c", str(source), "-o", str(place / "step.o")))
        said = run(("arm-none-eabi-size", "-A", str(place / "step.o"))).decode()
    except BuildError:
        return None
    symbol = functions["step_rk4_jacobian"]["symbols"]["f32"]
    rows = [line.split() for line in said.splitlines() if line.startswith((".text", ".rodata"))]
    return sum(int(r[1]) for r in rows if r[0] == ".text" + f".{symbol}" or "rodata" in r[0])
