# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures what every step of Quality leaves out, is off and costs, and writes
addon/core/analysis/step_errors.toml (about 20 minutes on two cores)."""

import argparse
import os
import sys
import time
import tomllib
from pathlib import Path

import bpy

from addon.core.analysis.step_errors import FILE
from tools.steps import bounces, costs, pictures

PARTS = ("left_out", "lost", "off", "costs")
ABOUT = f"""\
# SPDX-License-Identifier: GPL-3.0-or-later
# Made by `python -m tools.measure_steps`; not to be edited.
#
# left_out: a sphere whose facets absorb nothing, by the double-precision oracle; for each of
#     `alphas` what is missing after bounce 1, 2, ...: image L2 over that of all bounces, the most
#     of a sun and of a uniform world. Models are numbered as in the parameter Model; ior is 0
#     where there is none.
# lost: the same as energy, of the sphere's whole picture in a uniform world.
# off: the converged picture of such a sphere under a sun against the oracle's, image L2 and its
#     standard error together, by the larger alpha; Single against the oracle's first bounce.
# costs: processor time of a sample of a pixel that shows this material, for each of `cost_alphas`,
#     over that of metal of alpha 0.25 in Single; `background` is that of a pixel of the world
#     (median of {costs.ROUNDS} rounds).
"""


def main() -> None:
    """Measure the parts that are asked for, keep the others, and write the file."""
    parser = argparse.ArgumentParser(prog="python -m tools.measure_steps", description=__doc__)
    parser.add_argument("parts", nargs="*", help=f"what to measure: {', '.join(PARTS)} (all)")
    parser.add_argument("--output", type=Path, default=FILE, help="file to write (%(default)s)")
    arguments = parser.parse_args()
    for part in arguments.parts:
        if part not in PARTS:
            parser.error(f"{part!r} is no part: give {', '.join(PARTS)}")
    parts = arguments.parts or PARTS
    output = arguments.output
    data = tomllib.loads(output.read_text(encoding="utf-8")) if output.is_file() else {}
    begin = time.perf_counter()

    def tell(text: str) -> None:
        print(f"{time.perf_counter() - begin:5.0f} s  {text}", flush=True)

    if "left_out" in parts:
        data["left_out"] = list(bounces.rows(bounces.left_out))
        tell("pictures of bounces measured")
    if "lost" in parts:
        data["lost"] = list(bounces.rows(bounces.energy_lost))
        tell("energies of bounces measured")
    if "off" in parts:
        data["off"] = pictures.rows(tell)
    if "costs" in parts:
        data["costs"], data["background"] = costs.measure()
        tell("costs measured")
    output.write_text(toml(data), encoding="utf-8")
    tell(f"wrote {output}")


def toml(data: dict) -> str:
    """Return the file's text, with the parts that `data` has."""
    head = {
        "seed": bounces.SEED,
        "walks": bounces.WALKS,
        "blender": bpy.app.version_string,
        "alphas": bounces.ALPHAS,
        "cost_alphas": costs.ALPHAS,
        "background": data.get("background", 0.0),
    }
    lines = [ABOUT, *(f"{key} = {_value(value)}" for key, value in head.items())]
    for part in PARTS:
        for row in data.get(part, []):
            lines += ["", f"[[{part}]]", *(f"{key} = {_value(row[key])}" for key in row)]
    return "\n".join(lines) + "\n"


def _value(value: object) -> str:
    if isinstance(value, str):
        return f'"{value}"'
    if not isinstance(value, (list, tuple)):
        return f"{round(value, 4):g}"
    if value and isinstance(value[0], (list, tuple)):
        return "[\n" + "".join(f"  {_value(item)},\n" for item in value) + "]"
    return "[" + ", ".join(map(_value, value)) + "]"


if __name__ == "__main__":
    main()
    # bpy 4.5 was seen to hang while it takes itself down.
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(0)
