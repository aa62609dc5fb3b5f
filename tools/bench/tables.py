# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the benchmark's numbers as CSV and JSON."""

import csv
import io
import json
import math
import statistics
from collections.abc import Mapping, Sequence

from .curves import Curve
from .findings import SceneFindings
from .targets import Target


def curves(found: Mapping[str, SceneFindings]) -> str:
    """The text of curves.csv: squared error, over the reference's mean square, by time."""
    header = (
        "scene", "variant", "samples", "processor_seconds", "squared_error", "lowest", "highest"
    )  # fmt: skip
    rows = [
        (scene, curve.variant, count, *(_number(value) for value in values))
        for scene, one in found.items()
        for curve in one.curves.values()
        if curve.known
        for count, *values in zip(
            curve.samples, curve.seconds, curve.squared, curve.lowest, curve.highest, strict=True
        )
    ]
    return _csv(header, rows)


def costs(found: Mapping[str, SceneFindings]) -> str:
    """The text of costs.csv: seconds of a sample, as medians and range of the rounds, and bias."""
    header = (
        "scene", "variant", "rounds", "processor_seconds", "lowest", "highest", "wall_seconds",
        "first_render_seconds", "squared_bias", "squared_bias_error",
    )  # fmt: skip
    rows = [
        (scene, curve.variant, len(curve.cpu), *(_number(value) for value in _costs(curve)))
        for scene, one in found.items()
        for curve in one.curves.values()
    ]
    return _csv(header, rows)


def results(found: Mapping[str, SceneFindings], aims: Sequence[Target]) -> str:
    """The text of results.json: everything, with the machine. Unknown values are null."""
    first = next(iter(found.values()))
    content = {
        "command": "make bench",
        "machine": first.machine.as_dict(),
        "targets": [_known(aim.as_dict()) for aim in aims],
        "scenes": {
            name: {
                "title": one.scene.title,
                "reference": one.scene.reference,
                "reference_samples": one.scene.reference_samples,
                "pixels": one.pixels,
                "squared_resolution": _finite(one.resolution),
                "variants": {
                    curve.variant: {
                        "samples": curve.samples,
                        "squared_error": [_finite(value) for value in curve.squared],
                        "processor_seconds_by_round": [_finite(value) for value in curve.cpu],
                        "wall_seconds_by_round": [_finite(value) for value in curve.wall],
                        "first_render_seconds_by_round": [_finite(v) for v in curve.start],
                        "squared_bias": _finite(_bias(curve)[0]),
                        "squared_bias_error": _finite(_bias(curve)[1]),
                    }
                    for curve in one.curves.values()
                },
            }
            for name, one in found.items()
        },
    }
    return json.dumps(content, indent=1, allow_nan=False) + "\n"


def _costs(curve: Curve) -> tuple[float, ...]:
    wall, start = (statistics.median(times) for times in (curve.wall, curve.start))
    return (curve.a_sample, *curve.spread, wall, start, *_bias(curve))


def _bias(curve: Curve) -> tuple[float, float]:
    bias = curve.bias
    return (math.nan, math.nan) if bias is None else (bias.bias_square, bias.bias_square_se)


def _known(values: dict[str, object]) -> dict[str, object]:
    return {key: _finite(v) if isinstance(v, float) else v for key, v in values.items()}


def _finite(value: float) -> float | None:
    return float(f"{value:.6g}") if math.isfinite(value) else None


def _number(value: float) -> str:
    return f"{value:.6g}" if math.isfinite(value) else ""


def _csv(header: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(header)
    writer.writerows(rows)
    return text.getvalue()
